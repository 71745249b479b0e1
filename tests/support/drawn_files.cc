// SPDX-License-Identifier: BSD-3-Clause
// The maps, grids and polygons of the drawn scenarios.
#include <fstream>

#include "tests/support/drawn_scenario.h"
#include "tests/support/grey_png.h"
#include "tests/support/netcdf_writer.h"

namespace ergocast::test {
namespace {

/// Cells of 20 m from (0, 0, 0) on, at two times.
void write_grid(const std::filesystem::path& file) {
  std::vector<NetcdfVariable> variables;
  const auto axis = [&](const std::string& name, int count) {
    NetcdfVariable one{name, {name}, {}, {{"units", "m"}}};
    for (int i = 0; i < count; ++i) one.values.push_back(10 + 20 * i);
    variables.push_back(one);
  };
  axis("x", 4);
  axis("y", 2);
  axis("z", 3);
  NetcdfVariable values{"v", {"time", "z", "y", "x"}, {}, {}};
  for (int i = 0; i < 48; ++i) values.values.push_back(1 + i % 7);
  variables.push_back(values);
  NetcdfWriter(file, {{"time", 2}, {"z", 3}, {"y", 2}, {"x", 4}}, variables);
}

}  // namespace

void write_files(const std::filesystem::path& folder) {
  std::ofstream(folder / "a.csv") << "0,1,2,9\n3,0,1,4\n";
  std::ofstream(folder / "a.asc")
      << "ncols 4\nnrows 2\nxllcorner 5\nyllcorner 5\ncellsize 20\n0 1 2 9\n3 0 1 4\n";
  // A degree is 111 km to the north, and here 65 km to the east.
  const auto triangle = [](const char* ring) {
    return std::string(R"({"type": "Polygon", "coordinates": [[)") + ring + "]]}\n";
  };
  std::ofstream(folder / "a.geojson")
      << triangle("[10.0002, 54.0002], [10.0006, 54.0002], [10.0002, 54.0005], [10.0002, 54.0002]");
  std::ofstream(folder / "b.geojson")
      << triangle("[10.0012, 54.0006], [10.0014, 54.0006], [10.0012, 54.0008], [10.0012, 54.0006]");
  write_grid(folder / "a.nc");
  write_png(folder / "a.png", 4, 2, {.bits = 16},
            [](int column, int row, int) { return 1000 * (1 + column + 4 * row); });
}

}  // namespace ergocast::test
