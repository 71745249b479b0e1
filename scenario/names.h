// SPDX-License-Identifier: BSD-3-Clause
// Names of scenarios: they become names of folders.
#pragma once

#include <string>
#include <string_view>

namespace ergocast {

/// A name, is_name() of core/mission_limits.h: `text` with '_' for whatever a name may not have.
std::string name_from(std::string_view text);

}  // namespace ergocast
