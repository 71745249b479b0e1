// SPDX-License-Identifier: BSD-3-Clause
// Writes a number with the fewest digits that read back as it.
#include "text/shortest.h"

#include <charconv>
#include <cmath>

namespace ergocast {

std::string shortest(double value) {
  // 100000 instead of 1e+05, where both are easy to read.
  const bool plain = value == 0 || (std::abs(value) >= 1e-4 && std::abs(value) < 1e10);
  const auto format = plain ? std::chars_format::fixed : std::chars_format::general;
  char text[64];
  return {text, std::to_chars(text, text + sizeof text, value, format).ptr};
}

}  // namespace ergocast
