// SPDX-License-Identifier: BSD-3-Clause
// A NetCDF file: each variable is refused with a problem, or its rows are densities.
#include <algorithm>
#include <vector>

#include "target/maps/netcdf_file.h"
#include "target/maps/netcdf_grid.h"
#include "tests/fuzz/files.h"
#include "tests/fuzz/target.h"

namespace ergocast::fuzz {
namespace {

void require_words_of(const MapProblem& problem) {
  ERGOCAST_REQUIRE(!problem.what.empty() && !problem.remedy.empty());
}

/// Reads at most a million cells: later rows are read by the same code.
void read_grid(const std::filesystem::path& file, const NetcdfChoice& choice) {
  const auto opened = NetcdfGrid::open(file, choice);
  if (!opened) return require_words_of(opened.error());
  NetcdfGrid& grid = **opened;
  const RasterGrid& raster = grid.raster();
  ERGOCAST_REQUIRE(raster.columns >= 1 && raster.rows >= 1 && !grid.layers().empty());
  ERGOCAST_REQUIRE(raster.extent.size_m.minCoeff() > 0);
  std::vector<double> row(static_cast<std::size_t>(raster.columns));
  const int rows = std::min(raster.rows, 1 + (1 << 20) / raster.columns);
  const int last = static_cast<int>(grid.layers().size()) - 1;
  for (int i = 0; i < rows; ++i) {
    if (const auto problem = grid.row(i % 2 == 0 ? 0 : last, i, row))
      return require_words_of(*problem);
    for (const double value : row) ERGOCAST_REQUIRE(value >= 0 && value <= kMaxMapValue);
  }
}

}  // namespace

FUZZ_TARGET(netcdf) {
  constexpr std::size_t kMostVariables = 4;
  const std::filesystem::path file = memory_file(input);
  const auto opened = NetcdfFile::open(file);
  if (!opened) return require_words_of(opened.error());
  std::vector<std::string> names = (*opened)->variables();
  names.resize(std::min(names.size(), kMostVariables));
  for (const std::string& name : names)
    for (const bool plane : {false, true}) read_grid(file, {name, 0, {}, plane});
}

}  // namespace ergocast::fuzz
