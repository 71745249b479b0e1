// SPDX-License-Identifier: BSD-3-Clause
// Escapes text of files and other hosts for a terminal.
#pragma once

#include <string>
#include <string_view>

namespace ergocast {

/// `text` without terminal controls: control characters other than line break and tab, and bytes
/// that are not UTF-8, appear as \x1b.
std::string printable(std::string_view text);

}  // namespace ergocast
