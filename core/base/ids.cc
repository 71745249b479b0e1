// SPDX-License-Identifier: BSD-3-Clause
// Prints an identity as sixteen hexadecimal digits.
#include "core/base/ids.h"

#include <cstdio>

namespace ergocast {

std::string to_hex(std::uint64_t identity) {
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(identity));
  return text;
}

}  // namespace ergocast
