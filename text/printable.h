// SPDX-License-Identifier: BSD-3-Clause
// Text of files and strangers as a terminal may have it.
#pragma once

#include <string>
#include <string_view>

namespace ergocast {

/// `text` without what a terminal would obey: control characters other than line break and tab, and
/// bytes that are no UTF-8, stand there as \x1b.
std::string printable(std::string_view text);

}  // namespace ergocast
