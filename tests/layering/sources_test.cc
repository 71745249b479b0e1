// SPDX-License-Identifier: BSD-3-Clause
// Every file says what it is about, and every folder can be looked through.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
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

/// The words of a list of CMake, without comments.
std::vector<std::string> words_of(const std::filesystem::path& list) {
  std::ifstream file(list);
  std::vector<std::string> words;
  for (std::string line; std::getline(file, line);) {
    std::ranges::replace_if(
        line, [](char c) { return c == '(' || c == ')'; }, ' ');
    std::istringstream parts(line.substr(0, line.find('#')));
    for (std::string word; parts >> word;) words.push_back(word);
  }
  return words;
}

/// What the lists of tests name: files relative to the list's folder, or to tests/.
std::set<std::string> listed_files() {
  namespace fs = std::filesystem;
  const fs::path root(ERGOCAST_SOURCE_DIR);
  std::set<std::string> files;
  for (const auto& list : fs::recursive_directory_iterator(root / "tests")) {
    const fs::path& path = list.path();
    if (path.extension() != ".cmake" && path.filename() != "CMakeLists.txt") continue;
    const fs::path folder = fs::relative(path.parent_path(), root);
    for (const std::string& word : words_of(path))
      files.insert({(folder / word).string(), (fs::path("tests") / word).string()});
  }
  return files;
}

// A test that no list names is never built, and nothing else reports that.
TEST(Sources, EachTestIsInAListOfTests) {
  namespace fs = std::filesystem;
  const fs::path root(ERGOCAST_SOURCE_DIR);
  const std::set<std::string> listed = listed_files();
  int tests = 0;
  for (const auto& file : fs::recursive_directory_iterator(root / "tests")) {
    const std::string path = fs::relative(file.path(), root).string();
    if (!path.ends_with("_test.cc")) continue;
    ++tests;
    EXPECT_TRUE(listed.contains(path))
        << path << ": name it in tests/parts.cmake or programs.cmake";
  }
  EXPECT_GE(tests, 200);
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
