// SPDX-License-Identifier: BSD-3-Clause
// Numbers in texts that somebody else wrote.
#pragma once

#include <charconv>
#include <concepts>
#include <optional>
#include <string_view>
#include <system_error>

namespace ergocast {

/// The number that `text` is from its first character to its last; nothing where it is anything else
/// or not in the range of `Number`. Without a sign for unsigned numbers, without '+' for any, and the
/// same in every locale. `base` is for whole numbers: std::from_chars says what it may be.
template <class Number, std::same_as<int>... Base>
std::optional<Number> read_number(std::string_view text, Base... base) {
  Number number{};
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, number, base...);
  return error == std::errc() && rest == end ? std::optional(number) : std::nullopt;
}

}  // namespace ergocast
