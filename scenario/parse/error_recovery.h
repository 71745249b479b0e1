// SPDX-License-Identifier: BSD-3-Clause
// Error recovery after a syntax error: Protobuf's parser stops at the first error, but a person
// wants to see all. The field with the error is cut out of the text, and the rest is parsed again.
#pragma once

#include <compare>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace ergocast {

/// A place in a text as Protobuf counts: from 0, in bytes, a tab up to the next multiple of 8.
struct Place {
  int line = 0, column = 0;
  auto operator<=>(const Place&) const = default;
};
std::size_t offset_of(std::string_view text, Place place);
Place place_of(std::string_view text, std::size_t offset);

/// A field that cannot be read.
struct BrokenField {
  std::size_t begin, end;  ///< its range in the text
  std::size_t culprit;     ///< the token that the parser reported
  std::string path;        ///< such as "target.gaussians[2].sigma_m"; empty for stray characters
  std::string text;        ///< of the culprit, or its beginning
  bool decimal_comma = false;  ///< the text is a number such as 1,5
};

/// The field that causes an error at `offset`; nothing at the text's end.
std::optional<BrokenField> broken_field(std::string_view text, std::size_t offset,
                                        std::string_view message);

/// Where an unclosed block begins; nothing if all are closed.
std::optional<std::size_t> unclosed_block(std::string_view text);

/// Where blocks are first nested more than `limit` deep.
std::optional<std::size_t> too_deep(std::string_view text, int limit);

}  // namespace ergocast
