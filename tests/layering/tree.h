// SPDX-License-Identifier: BSD-3-Clause
// The files of the source tree.
#pragma once

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/layering/rules.h"

namespace ergocast {

inline bool is_code(const std::filesystem::path& file) {
  static const std::set<std::string> kExtensions = {".h", ".hpp", ".cc", ".cpp"};
  return kExtensions.contains(file.extension().string());
}

/// Paths of the tree's code, relative to its root.
inline std::vector<std::string> code_of_the_tree() {
  namespace fs = std::filesystem;
  const fs::path root(ERGOCAST_SOURCE_DIR);
  std::vector<std::string> paths;
  for (const auto& top : fs::directory_iterator(root)) {
    const std::string name = top.path().filename().string();
    if (name.starts_with('.') || name.starts_with("build") || kFree.contains(name)) continue;
    if (!top.is_directory()) {
      if (is_code(top.path())) paths.push_back(name);
      continue;
    }
    for (const auto& file : fs::recursive_directory_iterator(top.path())) {
      if (is_code(file.path())) paths.push_back(fs::relative(file.path(), root).string());
    }
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

inline std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

}  // namespace ergocast
