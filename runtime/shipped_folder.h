// SPDX-License-Identifier: BSD-3-Clause
// Where what comes with the programs is.
#pragma once

#include <filesystem>
#include <string>

namespace ergocast {

/// As seen from the program: share/ergocast/NAME of an installation, or `in_tree` in the tree of
/// build/*/bin. Empty: nowhere.
std::filesystem::path shipped_folder(const std::string& name, const std::string& in_tree);

/// ergocast-spy.jar of an installation, or of this build. Empty: it was not built, for want of a JDK.
std::filesystem::path spy_jar();

}  // namespace ergocast
