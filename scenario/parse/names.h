// SPDX-License-Identifier: BSD-3-Clause
// Makes names of scenarios, which become names of folders.
#pragma once

#include <string>
#include <string_view>

namespace ergocast {

/// A name, is_name() of plan/mission_limits.h: `text` with '_' for each character that is not
/// allowed.
std::string name_from(std::string_view text);

}  // namespace ergocast
