// SPDX-License-Identifier: BSD-3-Clause
// Reads a grey PNG as a map: each pixel is a cell.
#pragma once

#include "target/maps/map_file.h"

namespace ergocast {

/// Grey of 8 or 16 bits, not interlaced. A pixel's number is the density, independent of the file's
/// gamma. With an alpha channel it is multiplied by the pixel's opacity, so that a transparent
/// pixel is 0.
OpenedMap open_png_map(const std::filesystem::path& file);

}  // namespace ergocast
