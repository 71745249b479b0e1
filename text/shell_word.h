// SPDX-License-Identifier: BSD-3-Clause
// Words of command lines that a person can paste into a shell.
#pragma once

#include <string>
#include <string_view>

namespace ergocast {

/// Any `text` as one word of a shell; quoted only if necessary.
std::string shell_word(std::string_view text);

}  // namespace ergocast
