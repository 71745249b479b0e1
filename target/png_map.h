// SPDX-License-Identifier: BSD-3-Clause
// A grey PNG: a pixel is a cell.
#pragma once

#include "target/map_file.h"

namespace ergocast {

/// Grey of 8 or 16 bits, not interlaced. The number that a pixel holds is the density, whatever
/// gamma the file states; with an alpha channel it is multiplied by the pixel's opacity, so that
/// what is transparent is 0.
OpenedMap open_png_map(const std::filesystem::path& file);

}  // namespace ergocast
