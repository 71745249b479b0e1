// SPDX-License-Identifier: BSD-3-Clause
// Names of scenarios: they become names of folders.
#pragma once

#include <string>
#include <string_view>

namespace ergocast {

inline constexpr int kMaxNameLength = 64;

/// Whether `name` is 1 to kMaxNameLength letters, digits, '_', '-' or '.', the first of them not
/// '-' or '.'.
bool is_name(std::string_view name);

/// `text` with '_' for whatever a name may not have.
std::string name_from(std::string_view text);

}  // namespace ergocast
