// SPDX-License-Identifier: BSD-3-Clause
// The ESRI ASCII grid: a few "key value" lines, then the cells from the north-west, row by row.
#pragma once

#include "target/map_file.h"

namespace ergocast {

/// Keys, in any case and order: ncols, nrows, cellsize, xllcorner or xllcenter, yllcorner or
/// yllcenter, and NODATA_value, −9999 if it is left out. A cell that has it is 0. Line breaks among
/// the cells mean nothing.
OpenedMap open_ascii_grid(const std::filesystem::path& file);

}  // namespace ergocast
