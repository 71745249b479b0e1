// SPDX-License-Identifier: BSD-3-Clause
// A density on the cells of a grid in space, from a NetCDF file with CF conventions.
#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "target/heights.h"
#include "target/maps/map_file.h"
#include "target/raster_integral.h"

namespace ergocast {

/// More cells take minutes to read.
/// Limit (Files of a scenario): cells of a NetCDF grid. Beyond it: the scenario is refused.
inline constexpr std::size_t kMostVoxels = std::size_t{1} << 28;

/// The part of a file to read.
struct NetcdfChoice {
  std::string variable;
  std::optional<int> time_index;            ///< of several times; the first is 0
  std::array<std::string, 4> dimensions{};  ///< x, y, z and time by name; empty: by CF
  bool plane = false;                       ///< whether one layer is wanted, without heights
};

/// Reads rows one by one, so that a grid of any size needs the memory of a row and of one of the
/// file's chunks, at most 64 MiB.
class NetcdfGrid {
 public:
  /// The variable's axes are x, y, z and perhaps time (target/maps/netcdf_axis.h); x and y are
  /// evenly spaced. A plane has no z, or one of length 1.
  static Result<std::unique_ptr<NetcdfGrid>, MapProblem> open(const std::filesystem::path& file,
                                                              const NetcdfChoice& choice);

  virtual ~NetcdfGrid() = default;
  NetcdfGrid(const NetcdfGrid&) = delete;
  NetcdfGrid& operator=(const NetcdfGrid&) = delete;

  /// The grid's cells seen from above, and their heights, ascending; in a plane 0 to 1 m.
  virtual const RasterGrid& raster() const = 0;
  virtual const std::vector<Heights>& layers() const = 0;

  /// Reads a row of a layer, both counted from below and from the south, into raster().columns
  /// values, the westernmost first: densities from 0 to kMaxMapValue, unpacked, 0 where the file
  /// has fill values.
  virtual std::optional<MapProblem> row(int layer, int row, std::span<double> values) = 0;

 protected:
  NetcdfGrid() = default;
};

}  // namespace ergocast
