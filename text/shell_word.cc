// SPDX-License-Identifier: BSD-3-Clause
// Quotes what a shell would read as more than a word.
#include "text/shell_word.h"

#include <algorithm>
#include <cctype>
#include <cstring>

namespace ergocast {

std::string shell_word(std::string_view text) {
  const bool plain = !text.empty() && std::all_of(text.begin(), text.end(), [](unsigned char c) {
    return c < 128 && (std::isalnum(c) != 0 || std::strchr("./_-@:+", c) != nullptr);
  });
  if (plain) return std::string(text);
  std::string word = "'";
  for (const char c : text) word += c == '\'' ? "'\\''" : std::string(1, c);
  return word + '\'';
}

}  // namespace ergocast
