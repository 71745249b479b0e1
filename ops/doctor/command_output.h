// SPDX-License-Identifier: BSD-3-Clause
// What a command of the system's says.
#pragma once

#include <string>

namespace ergocast::doctor {

/// Everything that `command`, a line for the shell, writes; nothing if it cannot be run. Programs of
/// the system administrator's are found, too.
std::string output_of(const std::string& command);

}  // namespace ergocast::doctor
