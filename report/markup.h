// SPDX-License-Identifier: BSD-3-Clause
// Formats text for people: numbers with few digits, and text escaped for XML.
#pragma once

#include <string>
#include <string_view>

namespace ergocast {

/// `text` for the content of an XML element or a quoted attribute. Characters that XML does not
/// allow become U+FFFD.
std::string escape(std::string_view text);

/// About three significant digits: 0.368, 12.5, 143 976, 9.33 × 10⁻⁴. Whole numbers keep all their
/// digits.
std::string readable(double value);

}  // namespace ergocast
