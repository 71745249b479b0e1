// SPDX-License-Identifier: BSD-3-Clause
// Strict parsing of numbers in text from outside the program.
#pragma once

#include <charconv>
#include <concepts>
#include <optional>
#include <string_view>
#include <system_error>

namespace ergocast {

/// The number that the whole of `text` represents; nothing if it has other characters or the number
/// is outside the range of `Number`. No sign for unsigned numbers, no '+' at all; independent of
/// the locale. `base` is for whole numbers, as in std::from_chars.
template <class Number, std::same_as<int>... Base>
std::optional<Number> read_number(std::string_view text, Base... base) {
  Number number{};
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, number, base...);
  return error == std::errc() && rest == end ? std::optional(number) : std::nullopt;
}

}  // namespace ergocast
