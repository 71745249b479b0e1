// SPDX-License-Identifier: BSD-3-Clause
// The ESRI ASCII grid: a few "key value" lines, then the cells from the north-west, row by row.
#pragma once

#include "target/maps/map_file.h"

namespace ergocast {

/// Keys, in any case and order: ncols, nrows, cellsize, xllcorner or xllcenter, yllcorner or
/// yllcenter, and NODATA_value (default −9999). A cell with this value is 0. Line breaks among the
/// cells have no meaning.
OpenedMap open_ascii_grid(const std::filesystem::path& file);

}  // namespace ergocast
