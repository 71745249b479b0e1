// SPDX-License-Identifier: BSD-3-Clause
// Occupancy maps: the cells that nav2 would read, and a problem with file, line and remedy for
// everything else.
#include "target/maps/occupancy_map.h"

#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/grey_png.h"
#include "tests/support/temp_folder.h"

namespace ergocast {
namespace {

using namespace test;

const std::string kAbout =
    "image: map.pgm\nresolution: 0.050000\norigin: [-5.0, 3, 0.5]\nnegate: 0\n"
    "occupied_thresh: 0.65\nfree_thresh: 0.196\n";

std::string with(const std::string& from, const std::string& to) {
  std::string text = kAbout;
  return text.replace(text.find(from), from.size(), to);
}

class OccupancyMapFiles : public ::testing::Test {
 protected:
  void write(const std::string& name, const std::string& content) {
    std::ofstream(folder_.path() / name, std::ios::binary) << content;
  }
  /// The cells from the north: '.', '#' and '?', or the problem.
  std::string read(const std::string& about) {
    write("map.yaml", about);
    auto map = OccupancyMap::open(folder_.path() / "map.yaml");
    if (!map) return map.error().what + " (" + map.error().remedy + ")";
    std::string text;
    std::vector<std::uint8_t> row(static_cast<std::size_t>(map->columns()));
    for (int y = 0; y < map->rows(); ++y) {
      if (const auto problem = map->next_row(row))
        return problem->what + " (" + problem->remedy + ")";
      for (const std::uint8_t cell : row) text += ".#?"[cell];
      text += '|';
    }
    return text;
  }
  std::string read_pgm(const std::string& pgm, const std::string& about = kAbout) {
    write("map.pgm", pgm);
    return read(about);
  }
  void expect_problem(const std::string& result, const std::string& what) {
    EXPECT_NE(result.find(what), std::string::npos) << result;
    EXPECT_TRUE(result.starts_with(folder_.path().string())) << result;
    EXPECT_NE(result.find(" ("), std::string::npos) << result;
  }

  TempFolder folder_;
};

TEST_F(OccupancyMapFiles, ReadsWhatMapSaverWrites) {
  const auto map = parse_map_yaml(kAbout + "\n", "map.yaml");
  ASSERT_TRUE(map);
  EXPECT_EQ(map->image, "map.pgm");
  EXPECT_EQ(map->resolution_m, 0.05);
  EXPECT_EQ(map->origin_m, Eigen::Vector2d(-5, 3));
  EXPECT_EQ(map->yaw_rad, 0.5);
  EXPECT_FALSE(map->negate);
  EXPECT_EQ(map->mode, OccupancyMode::kTrinary);
}

TEST_F(OccupancyMapFiles, ReadsCommentsQuotesAndModes) {
  const auto map = parse_map_yaml(
      "--- \n# a map\r\nmode: \"scale\"  # graded\nimage: 'my # map.png'\nresolution: 1e-1\n"
      "origin: [ -1,2 , 0 ]\nnegate: true\noccupied_thresh: .65\nfree_thresh: 0.65\n",
      "map.yaml");
  ASSERT_TRUE(map) << map.error().what;
  EXPECT_EQ(map->image, "my # map.png");
  EXPECT_TRUE(map->negate);
  EXPECT_EQ(map->mode, OccupancyMode::kScale);
}

TEST_F(OccupancyMapFiles, ReadsPgmAsTextAndBytesOfEightAndSixteenBits) {
  EXPECT_EQ(
      read_pgm("P5\n# CREATOR: map_saver 0.050 m/pix\n3 1\n255\n\xfe\xcd" + std::string(1, '\0')),
      ".?#|");
  EXPECT_EQ(read_pgm("P2 # text\n3 #width\n2\n255\n254 205 0 # north\n0 0\n# south\n254\n#end"),
            ".?#|##.|");
  EXPECT_EQ(read_pgm(std::string("P5 2 1 65535\n\xff\xfe\x00\xff", 17)), ".#|");
  EXPECT_EQ(read_pgm("P2 2 1 1\n1 0\n"), ".#|");
}

TEST_F(OccupancyMapFiles, ComparesWithThresholdsInEachMode) {
  const std::string shades = "P2 6 1 255\n0 80 120 204 206 255\n";
  EXPECT_EQ(read_pgm(shades), "##??..|");
  EXPECT_EQ(read_pgm(shades, with("negate: 0", "negate: 1")), ".??###|");
  EXPECT_EQ(read_pgm(shades, kAbout + "mode: scale\n"), "##??..|");
  EXPECT_EQ(read_pgm("P2 6 1 255\n0 19 20 65 66 100\n", kAbout + "mode: raw\n"), "..??##|");
  EXPECT_EQ(read_pgm("P2 2 1 255\n101 255\n", kAbout + "mode: raw\n"), "??|");
}

TEST_F(OccupancyMapFiles, ReadsPngOfGreyAndOfColoursWithOpacity) {
  const auto about = with("map.pgm", "map.png");
  const auto file = folder_.path() / "map.png";
  write_png(file, 3, 1, {8, PNG_COLOR_TYPE_GRAY},
            [](int x, int, int) { return x == 0 ? 254 : 205 * (x % 2); });
  EXPECT_EQ(read(about), ".?#|");
  write_png(file, 2, 1, {16, PNG_COLOR_TYPE_GRAY}, [](int x, int, int) { return 65535 * x; });
  EXPECT_EQ(read(about), "#.|");
  write_png(file, 3, 1, {8, PNG_COLOR_TYPE_RGB_ALPHA}, [](int x, int, int channel) {
    if (channel == 3) return x == 2 ? 0 : 255;
    return x == 0 ? 0 : 255;
  });
  EXPECT_EQ(read(about + "mode: scale\n"), "#.?|");
}

TEST_F(OccupancyMapFiles, NamesTheLineOfAMistake) {
  const std::pair<std::string, std::string> mistakes[] = {
      {with("free_thresh: 0.196", "free_thresh: 0.7"),
       "map.yaml, line 6: free_thresh 0.7 is above occupied_thresh 0.65 (write the smaller"},
      {kAbout + "mode: fancy\n", "map.yaml, line 7: mode fancy is unknown (write trinary"},
      {kAbout + "free: 1\n", "map.yaml, line 7: free is no key of an occupancy map (keep image"},
      {kAbout + "negate: 1\n", "map.yaml, line 7: negate is there for the second time"},
      {with("negate: 0", "negate: 2"), "map.yaml, line 4: negate is 2, neither 0 nor 1"},
      {with("negate: 0", "negate:"), "map.yaml, line 4: negate has no value on its line"},
      {with("negate: 0\n", ""), "map.yaml: has no negate (add the line that map_saver writes"},
      {with("0.050000", "0"), "map.yaml, line 2: resolution 0 is outside its limits"},
      {with("0.050000", "5 cm"), "map.yaml, line 2: resolution 5 cm is no number"},
      {with("3, 0.5]", "3]"), "map.yaml, line 3: origin [-5.0, 3] is no list of three numbers"},
      {with("3, 0.5]", "3, 0.5, 1]"), "line 3: origin [-5.0, 3, 0.5, 1] is no list"},
      {with("[-5.0, 3, 0.5]", "\n- 5\n- 3"), "line 3: origin has no value on its line"},
      {with("negate", " negate"), "line 4: is no line \"key: value\""},
      {with("map.pgm", "none.pgm"), "none.pgm is missing (copy the picture there"},
      {"", "map.yaml is empty (write the map again)"},
  };
  write("map.pgm", "P2 1 1 255 254");
  for (const auto& [about, what] : mistakes) expect_problem(read(about), what);
}

TEST_F(OccupancyMapFiles, RefusesPicturesThatAreNone) {
  expect_problem(read_pgm("P6 1 1 255\nabc"), "map.pgm is neither PGM (P2 or P5) nor PNG (save");
  expect_problem(read_pgm("P5 10000 10000 255\n"), "has 10000 columns and 10000 rows; the limits");
  expect_problem(read_pgm("P5 3 2 255\nabcd"),
                 "map.pgm ends in row 2 of 2 (copy or write it again");
  expect_problem(read_pgm("P2 3 2 255\n1 2 3 4"), "map.pgm ends in row 2 of 2 (copy or write it");
  expect_problem(read_pgm("P5 1 1 255\nab"), "map.pgm goes on after its last pixel (correct the");
  expect_problem(read_pgm("P2 x 1 255\n"), "line 1: its header has no whole number here");
  expect_problem(read_pgm("P2 1 1\n65536\n1"), "line 2: its greatest grey value is 65536");
  expect_problem(read_pgm("P2 2 1 9\n1\n-1"), "line 3: a pixel is no whole number");
  expect_problem(read_pgm("P2 2 1 9\n1\n10"), "line 3: pixel 10 is above the greatest grey value");
}

}  // namespace
}  // namespace ergocast
