// SPDX-License-Identifier: BSD-3-Clause
// Target maps of grey PGM pictures, and of occupancy maps.
#pragma once

#include <filesystem>

#include "target/maps/map_file.h"

namespace ergocast {

/// A pixel's value is its shade, from 0 to 255.
OpenedMap open_pgm_map(const std::filesystem::path& file);

/// In the mode trinary free cells are 1 and others 0; else a cell is its occupancy in percent, and
/// 0 where that is unknown. A map that lies turned is refused.
OpenedMap open_occupancy_target(const std::filesystem::path& yaml);

}  // namespace ergocast
