// SPDX-License-Identifier: BSD-3-Clause
// Files beside a scenario, each with one mistake.
#include "tests/checks_can_fail/mistaken_files.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <functional>

#include "tests/checks_can_fail/scenario_mistakes.h"
#include "tests/scenario/water_column.h"
#include "tests/support/grey_png.h"

namespace ergocast::test {
namespace {

namespace fs = std::filesystem;

/// A good grid, and one for each mistake.
void write_grids(const fs::path& folder) {
  write_file(folder / "text.nc", "x,y\n1,2\n");
  NetcdfWriter(folder / "grid.nc", {{"time", 2}, {"z", 1}, {"y", 2}, {"x", 2}, {"ends", 2}},
               {{"x", {"x"}, {10, 30}, {{"units", "m"}}},
                {"y", {"y"}, {10, 30}, {{"units", "m"}}},
                {"z", {"z"}, {10}, {{"units", "m"}, {"bounds", "floor"}}},
                {"floor", {"z", "ends"}, {0, 20}, {}},
                {"v", {"time", "z", "y", "x"}, {1, 2, 3, 4, 5, 6, 7, 8}, {}}});
  const auto grid = [&](const char* name, const std::function<void(WaterColumn&)>& change) {
    WaterColumn column;
    change(column);
    column.write(folder / name);
  };
  const auto scale = [](NetcdfVariable& variable, double factor, double offset) {
    for (double& value : variable.values) value = value * factor + offset;
  };
  grid("good.nc", [](WaterColumn&) {});
  grid("sour.nc", [](WaterColumn& c) { c.at("chl").values[300] = -1; });
  grid("salt.nc", [](WaterColumn& c) { c.at("chl").name = "salt"; });
  grid("words.nc", [](WaterColumn& c) { c.at("chl").type = NetcdfType::kText; });
  grid("text_range.nc",
       [](WaterColumn& c) { c.at("chl").attributes.emplace_back("valid_range", "0 9"); });
  grid("member.nc", [](WaterColumn& c) { c.rename("depth", "member"); });
  grid("flat.nc", [](WaterColumn& c) { c.at("chl").dimensions = {"time", "y", "x"}; });
  grid("plane.nc", [](WaterColumn& c) { c.at("chl").dimensions = {"time", "depth", "x"}; });
  grid("billion.nc", [](WaterColumn& c) { c.grow(1000); });
  grid("long.nc", [](WaterColumn& c) { c.grow(9000); });
  grid("uneven.nc", [](WaterColumn& c) { c.at("x").values[3] += 0.02; });
  grid("bare.nc", [](WaterColumn& c) { c.at("x").name = "east"; });
  grid("degrees.nc", [](WaterColumn& c) { c.at("x").attributes[1].second = "degrees_east"; });
  grid("unitless.nc", [](WaterColumn& c) { c.at("x").attributes.pop_back(); });
  grid("single.nc", [](WaterColumn& c) {
    c.dimensions[1].second = 1;
    c.at("depth").attributes.pop_back();
  });
  grid("shape.nc", [](WaterColumn& c) { c.at("depth").attributes[2].second = "nothing"; });
  grid("nan.nc", [](WaterColumn& c) { c.at("x").values[2] = std::nan(""); });
  grid("tangled.nc", [](WaterColumn& c) { std::swap(c.at("y").values[1], c.at("y").values[3]); });
  grid("zero.nc", [&](WaterColumn& c) { scale(c.at("chl"), 0, 0); });
  grid("away.nc", [&](WaterColumn& c) { scale(c.at("y"), 1, 10000); });
}

/// Occupancy maps of 100 m by 50 m: a good one, room.yaml, and one for each mistake.
void write_rooms(const fs::path& folder) {
  const std::string row = repeated(6, "254 ") + "0 " + repeated(13, "254 ");
  write_file(folder / "room.pgm",
             "P2 20 10 255\n" + repeated(20, "254 ") + row + repeated(160, "254 "));
  const auto room = [&](const char* name, const std::string& from, const std::string& to) {
    std::string about =
        "image: room.pgm\nresolution: 5\norigin: [0, 0, 0]\nnegate: 0\n"
        "occupied_thresh: 0.65\nfree_thresh: 0.196\n";
    if (!from.empty()) about.replace(about.find(from), from.size(), to);
    write_file(folder / name, about);
  };
  const auto picture = [&](const std::string& name, const std::string& content) {
    write_file(folder / (name + ".pgm"), content);
    room((name + ".yaml").c_str(), "room.pgm", name + ".pgm");
  };
  room("room.yaml", "", "");
  room("wrong.yaml", "0.196", "0.7");
  room("percent.yaml", "0.65", "65");
  room("fancy.yaml", "negate: 0", "negate: 0\nmode: fancy");
  room("other.yaml", "negate: 0", "negate: 0\nfoo: 1");
  room("again.yaml", "negate: 0", "negate: 0\nnegate: 0");
  room("grey.yaml", "negate: 0", "negate: 2");
  room("bare.yaml", "negate: 0", "negate:");
  room("lacks.yaml", "negate: 0\n", "");
  room("indented.yaml", "negate: 0", "  - 0");
  room("nameless.yaml", "room.pgm", "''");
  room("gone.yaml", "room.pgm", "gone.pgm");
  room("point.yaml", "resolution: 5", "resolution: 0");
  room("words.yaml", "resolution: 5", "resolution: five");
  room("pair.yaml", "[0, 0, 0]", "[0, 0]");
  room("apart.yaml", "[0, 0, 0]", "[1000, 0, 0]");
  room("turned.yaml", "[0, 0, 0]", "[0, 0, 0.5]");
  const std::string side = repeated(20, "0 "), hall = "0 " + repeated(18, "254 ") + "0 ";
  picture("hall", "P2 20 10 255 " + side + repeated(8, hall) + side);
  const std::string halves = "0 " + repeated(9, "254 ") + "0 " + repeated(8, "254 ") + "0 ";
  picture("rooms", "P2 20 10 255 " + side + repeated(6, halves) + repeated(2, hall) + side);
  const std::string dark = repeated(5, "205 ") + repeated(15, "254 ");
  picture("dark", "P2 20 10 255 " + repeated(10, dark));
  // The start is in a closed room of one cell, which is too small.
  picture("nook", "P2 20 10 255 " + repeated(5, repeated(6, "0 ") + repeated(14, "254 ")) +
                      "0 0 254 0 0 0 " + repeated(14, "254 ") +
                      repeated(4, repeated(6, "0 ") + repeated(14, "254 ")));
  picture("solid", "P2 2 1 255 0 0");
  picture("white", "P2 20 10 255 " + repeated(200, "254 "));
  picture("cut", "P2 20 10 255 254");
  picture("more", "P2 1 1 255 254 0");
  picture("colour", "P3 1 1 255 1 1 1");
  picture("shape", "P2 x 1 255 1");
  picture("bits", "P2 1 1 65536 1");
  picture("bright", "P2 1 1 255 256");
  picture("letters", "P2 1 1 255 a");
  write_png(folder / "lace.png", 4, 4, {.interlace = PNG_INTERLACE_ADAM7},
            [](int, int, int) { return 0; });
  room("lace.yaml", "room.pgm", "lace.png");
  const auto dots = [](int columns, int rows) {
    std::string bytes = "P5 " + std::to_string(columns) + ' ' + std::to_string(rows) + " 255\n";
    for (int i = 0; i < columns * rows; ++i)
      bytes += i % 2 == 1 && i / columns % 2 == 1 ? '\0' : '\xfe';
    return bytes;
  };
  write_file(folder / "dots.pgm", dots(200, 100));
  write_file(folder / "noise.pgm", dots(2100, 2100));
  const std::string place =
      "\norigin: [0, 0, 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n";
  write_file(folder / "dots.yaml", "image: dots.pgm\nresolution: 0.5" + place);
  write_file(folder / "noise.yaml", "image: noise.pgm\nresolution: 0.02" + place);
}

/// A file that root cannot open for reading either.
fs::path unreadable_file() {
  for (const auto& bus : fs::directory_iterator("/sys/bus")) {
    const fs::path file = bus.path() / "drivers_probe";
    if (fs::exists(file) && !std::ifstream(file).is_open()) return file;
  }
  ADD_FAILURE() << "no file on this machine that cannot be read";
  return "/dev/null";
}

}  // namespace

void write_file(const fs::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
}

void write_mistaken_files(const fs::path& folder) {
  const auto write = [&](const char* name, const std::string& text) {
    write_file(folder / name, text);
  };
  write_grids(folder);
  write_rooms(folder);
  const std::string header = "ncols 2\nnrows 1\nxllcorner 0\nyllcorner 0\ncellsize 50\n";
  write("good.asc", header + "1 2\n");
  write("even.csv", "1,2\n3,4\n");
  write("pier.geojson", R"({"type":"Polygon","coordinates":[[[9.2005,47.5001],[9.2006,47.5001],)"
                        R"([9.2006,47.5002],[9.2005,47.5001]]]})");
  std::string positions;
  for (int i = 0; i < 4100; ++i) positions += "[9.2" + std::to_string(1000 + i) + ",47.5],";
  write("many.geojson", R"({"type":"Polygon","coordinates":[[)" + positions + "[9.21000,47.5]]]}");
  write("line.geojson", R"({"type":"LineString","coordinates":[]})");
  write("square.svg", "<svg viewBox='0 0 1 1'><rect width='1' height='1'/></svg>");
  write("many.svg",
        "<svg viewBox='0 0 2 1'><path d='M0 0" + repeated(2100, "h.1v.1") + "'/></svg>");
  const std::string page = "<svg viewBox='0 0 2 1'>";
  write("dot.svg", page + "<rect x='1.9' y='.9' width='.01' height='.01' fill='white'/></svg>");
  write("bright.svg", page +
                          "<path fill='#fff' d='M0 0h2v1h-2z'/><circle r='.1'/><path "
                          "stroke='yellow' stroke-width='.0005' d='M.5 .5003h1'/></svg>");
  // Each group is a picture of its own.
  write("deep.svg", "<svg viewBox='0 0 1 1'>" + repeated(60, "<g opacity='.9'>") +
                        "<circle r='.1'/>" + repeated(60, "</g>") + "</svg>");
  write("crossing.svg", page + "<path d='M0 0H2V1H0V.5H2V.6H0z'/></svg>");
  write("overlap.svg",
        page + "<rect width='1' height='1'/><rect x='.9' width='2' height='1'/></svg>");
  write("outside.svg", page + "<circle cx='9' r='1'/></svg>");
  write("marked.csv",
        "\xef\xbb\xbf"
        "1,2\n");
  write("wide_words.csv", std::string("\xff\xfe"
                                      "1\0",
                                      4));
  write("semicolons.csv", "1;2\n");
  write("commas.csv", "1,2,\n");
  write("tabs.csv", "1\t2\n");
  write("blank.csv", "\n\n");
  write("many.csv", repeated(30, "1,a\n"));
  write("picture.csv", "\x89PNG");
  write("tiff.csv", "II*");
  write("photo.csv", "\xff\xd8\xff");
  write("sheet.csv", "PK\3\4");
  write("grid.csv", "CDF");
  write("page.csv", "<html>");
  write("nowhere.geojson",
        R"({"type":"FeatureCollection","features":[{"type":"Feature","geometry":null},)"
        R"({"type":"Feature","geometry":null},)"
        R"({"type":"Feature","geometry":{"type":"Polygon","coordinates":[[[9.2005,47.5001],)"
        R"([9.2006,47.5001],[9.2006,47.5002],[9.2005,47.5001]]]}}]})");
  write("oblong.asc", "ncols 2\nnrows 1\nxllcorner 0\nyllcorner 0\ndx 5\ndy 6\n1 2\n");
  fs::create_directory(folder / "folder.csv");
  fs::create_symlink(unreadable_file(), folder / "locked.csv");
  write("empty.csv", "");
  write("wide.csv", repeated(9000, "1,") + "1\n");
  write("long.csv", std::string(2 << 20, ' ') + "1\n");
  write("ragged.csv", "1,2\n3\n");
  write("zero.csv", "0,0\n");
  write("words.csv", "1,two\n");
  write("negative.csv", "1,-2\n");
  write("huge.csv", "1,1e31\n");
  write("nan.csv", "1,nan\n");
  write("key.asc", "columns 2\n" + header + "1 2\n");
  write("twice.asc", "ncols 2\n" + header + "1 2\n");
  write("bare.asc", "ncols\nnrows\n1 2\n");
  write("lacks.asc", "ncols 2\nnrows 1\n1 2\n");
  write("both.asc", "ncols 2\nnrows 1\ncellsize 1\nxllcorner 0\nxllcenter 0\nyllcorner 0\n1 2\n");
  write("half.asc", "ncols 2.5\nnrows 1\nxllcorner 0\nyllcorner 0\ncellsize 50\n1 2\n");
  write("flat.asc", "ncols 2\nnrows 1\nxllcorner 0\nyllcorner 0\ncellsize 0\n1 2\n");
  write("short.asc", header + "1\n");
  write("more.asc", header + "1 2 3\n");
  write("text.png", "P5 3 2 255 abcdef");
  const auto grey = [](int x, int y, int) { return (x + y) % 2; };
  write_png(folder / "cut.png", 20, 20, {}, grey);
  fs::resize_file(folder / "cut.png", 60);
  write_png(folder / "palette.png", 4, 4, {.color = PNG_COLOR_TYPE_PALETTE}, grey);
  write_png(folder / "colour.png", 4, 4, {.color = PNG_COLOR_TYPE_RGB}, grey);
  write_png(folder / "bits.png", 4, 4, {.bits = 1}, grey);
  write_png(folder / "laced.png", 4, 4, {.interlace = PNG_INTERLACE_ADAM7}, grey);
}

}  // namespace ergocast::test
