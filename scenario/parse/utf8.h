// SPDX-License-Identifier: BSD-3-Clause
// Finds the first byte of a text that is not UTF-8.
#pragma once

#include <cstddef>
#include <string_view>

namespace ergocast {

/// The offset of the first byte that is not UTF-8; npos if there is none.
std::size_t first_bad_utf8(std::string_view text);

}  // namespace ergocast
