// Where what comes with the programs is.
#pragma once

#include <filesystem>
#include <string>

namespace ergocast {

/// As seen from the program: share/ergocast/NAME of an installation, or `in_tree` in the tree of
/// build/*/bin. Empty: nowhere.
std::filesystem::path shipped_folder(const std::string& name, const std::string& in_tree);

}  // namespace ergocast
