// SPDX-License-Identifier: BSD-3-Clause
// A coordinate variable of a NetCDF file (CF conventions): where its cells begin and end, in
// metres.
#pragma once

#include "core/base/result.h"
#include "target/heights.h"
#include "target/maps/netcdf_file.h"

namespace ergocast {

enum class AxisKind { kX, kY, kZ, kTime, kOther };

/// What a dimension is for, by its coordinate variable: the attributes axis, standard_name and
/// positive, else the name of the dimension.
AxisKind kind_of(const NetcdfFile& file, const std::string& dimension);

struct NetcdfAxis {
  std::vector<Heights> cells;  ///< ascending
  bool reversed = false;       ///< whether the file has them the other way round

  /// The file's index of a cell.
  std::size_t index(std::size_t cell) const { return reversed ? cells.size() - 1 - cell : cell; }
};

/// The axis of `dimension`. Cells are those of the attribute `bounds`, or end halfway between their
/// centres. With positive: down, z is minus the depth. Units are m or km.
Result<NetcdfAxis, MapProblem> read_axis(const NetcdfFile& file,
                                         const NetcdfFile::Dimension& dimension);

}  // namespace ergocast
