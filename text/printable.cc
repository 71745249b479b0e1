// SPDX-License-Identifier: BSD-3-Clause
// Copies well-formed characters and writes all other bytes as hexadecimal escapes.
#include "text/printable.h"

#include <algorithm>

namespace ergocast {
namespace {

/// The length of the character that `text` begins with; 0 if it is malformed or controls a
/// terminal.
std::size_t harmless_bytes(std::string_view text) {
  const auto byte = [&text](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned lead = byte(0);
  if (lead < 0x80) return (lead >= 0x20 && lead != 0x7f) || lead == '\n' || lead == '\t' ? 1 : 0;
  const std::size_t size = lead >= 0xc2 && lead < 0xe0   ? 2
                           : lead >= 0xe0 && lead < 0xf0 ? 3
                           : lead >= 0xf0 && lead < 0xf5 ? 4
                                                         : 0;
  if (size == 0 || text.size() < size) return 0;
  const auto tail = text.substr(1, size - 1);
  if (!std::all_of(tail.begin(), tail.end(), [](char c) { return (c & 0xc0) == 0x80; })) return 0;
  return lead == 0xc2 && byte(1) < 0xa0 ? 0 : size;  // U+0080 to U+009F are control characters
}

}  // namespace

std::string printable(std::string_view text) {
  constexpr const char* kDigits = "0123456789abcdef";
  std::string result;
  while (!text.empty()) {
    const std::size_t size = harmless_bytes(text);
    if (size > 0) {
      result += text.substr(0, size);
    } else {
      const auto byte = static_cast<unsigned char>(text[0]);
      result += {'\\', 'x', kDigits[byte >> 4], kDigits[byte & 15]};
    }
    text.remove_prefix(std::max<std::size_t>(1, size));
  }
  return result;
}

}  // namespace ergocast
