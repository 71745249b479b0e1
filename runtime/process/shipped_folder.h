// SPDX-License-Identifier: BSD-3-Clause
// The folders of files that come with the programs.
#pragma once

#include <filesystem>
#include <string>

namespace ergocast {

/// share/ergocast/NAME of the program's installation, or `in_tree` of the source tree if the
/// program is in build/*/bin. Empty: it does not exist.
std::filesystem::path shipped_folder(const std::string& name, const std::string& in_tree);

/// ergocast-spy.jar of an installation, or of this build. Empty: it was not built without a JDK.
std::filesystem::path spy_jar();

/// The folder with the Python package ergocast of this build. Empty: the program is installed, and
/// so is the package, or it was not built.
std::filesystem::path python_of_this_build();

}  // namespace ergocast
