// SPDX-License-Identifier: BSD-3-Clause
// The Python that commands start.
#pragma once

#include <string>
#include <vector>

namespace ergocast::cli {

/// Debian's, for which python3-ergocast is built.
inline constexpr const char* kPython = "/usr/bin/python3";

/// Becomes this Python with a function of the package ergocast of this build, or of the
/// installation: `module`.main(`arguments`) returns the exit code. If a module is missing, the exit
/// code is kExitUnavailable; one line begins with `without` and names the package to install.
/// Returns only if there is no Python, after the same line.
int become_python(const std::string& module, const std::vector<std::string>& arguments,
                  const std::string& without);

}  // namespace ergocast::cli
