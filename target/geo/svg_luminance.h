// SPDX-License-Identifier: BSD-3-Clause
// Which colours of a drawing are solid.
#pragma once

namespace ergocast {

/// Colours that are darker are solid: yellow is, a page in white or ivory is not.
inline constexpr double kSolidLuminance = 0.95;

/// ITU-R BT.709, of the stored parts, which are from 0 to 1.
inline double luminance(double red, double green, double blue) {
  return 0.2126 * red + 0.7152 * green + 0.0722 * blue;
}

}  // namespace ergocast
