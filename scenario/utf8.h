// SPDX-License-Identifier: BSD-3-Clause
// Where a text stops being UTF-8.
#pragma once

#include <cstddef>
#include <string_view>

namespace ergocast {

/// Where `text` stops being UTF-8; npos if it never does.
std::size_t first_bad_utf8(std::string_view text);

}  // namespace ergocast
