// SPDX-License-Identifier: BSD-3-Clause
// Every file says what it is about, and every folder can be looked through.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "tests/layering/tree.h"

namespace ergocast {
namespace {

TEST(Sources, BeginWithTheirLicenceAndASentenceOfTheirOwn) {
  std::vector<std::string> sentences;
  for (const std::string& path : code_of_the_tree()) {
    std::ifstream file(std::filesystem::path(ERGOCAST_SOURCE_DIR) / path);
    std::string licence, sentence;
    std::getline(file, licence) && std::getline(file, sentence);
    EXPECT_EQ(licence, "// SPDX-License-Identifier: BSD-3-Clause") << path;
    EXPECT_TRUE(sentence.starts_with("// ")) << path << ": write what the file is about";
    sentences.push_back(sentence);
  }
  std::sort(sentences.begin(), sentences.end());
  const auto twice = std::adjacent_find(sentences.begin(), sentences.end());
  EXPECT_EQ(twice, sentences.end()) << *twice;
}

// A longer list of files shows no architecture.
TEST(Sources, NoFolderHoldsMoreFilesThanAPersonCanLookThrough) {
  namespace fs = std::filesystem;
  constexpr int kMostFiles = 45;
  std::map<std::string, int> count;
  for (const auto& top : fs::directory_iterator(ERGOCAST_SOURCE_DIR)) {
    const std::string name = top.path().filename().string();
    if (name.starts_with('.') || name.starts_with("build") || !top.is_directory()) continue;
    for (const auto& file : fs::recursive_directory_iterator(top.path())) {
      if (file.is_regular_file()) ++count[file.path().parent_path().string()];
    }
  }
  EXPECT_GE(count.size(), 50U);
  for (const auto& [folder, files] : count) EXPECT_LE(files, kMostFiles) << folder;
}

}  // namespace
}  // namespace ergocast
