// SPDX-License-Identifier: BSD-3-Clause
// Runs a command of the operating system and returns its output.
#pragma once

#include <string>

namespace ergocast::doctor {

/// Everything that `command`, a line for the shell, prints; nothing if it cannot be run. Also finds
/// programs in the folders of the system administrator.
std::string output_of(const std::string& command);

}  // namespace ergocast::doctor
