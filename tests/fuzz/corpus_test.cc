// SPDX-License-Identifier: BSD-3-Clause
// Runs every target over every input of its corpus. Inputs that once caused a failure stay in the
// corpus.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <string>

#include "runtime/process/program_options.h"
#include "tests/fuzz/target.h"

namespace ergocast::fuzz {
namespace {

namespace fs = std::filesystem;

const fs::path kCorpora = fs::path(ERGOCAST_SOURCE_DIR) / "tests/fuzz/corpus";

std::vector<std::uint8_t> content_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(Corpus, EveryTargetHasOneAndEveryOneATarget) {
  std::set<std::string> named, kept;
  for (const Target& target : targets()) named.insert(target.name);
  for (const auto& folder : fs::directory_iterator(kCorpora)) {
    kept.insert(folder.path().filename().string());
  }
  EXPECT_EQ(named, kept);
}

/// A plan of another version is refused at its first field, and nothing behind it is read.
TEST(Corpus, PlansAreOfThisVersion) {
  const std::string field = std::string{'\x0a', static_cast<char>(version().size())} + version();
  for (const auto& file : fs::directory_iterator(kCorpora / "plan")) {
    const auto content = content_of(file.path());
    const std::string text(content.begin(), content.end());
    EXPECT_EQ(text.substr(0, field.size()), field) << file.path() << "; fuzz-seeds writes it anew";
  }
}

class CorpusOf : public ::testing::TestWithParam<const char*> {};

std::vector<const char*> names() {
  std::vector<const char*> names;
  for (const Target& target : targets()) names.push_back(target.name);
  return names;
}
INSTANTIATE_TEST_SUITE_P(Targets, CorpusOf, ::testing::ValuesIn(names()),
                         [](const auto& target) { return std::string(target.param); });

TEST_P(CorpusOf, BreaksNothing) {
  int inputs = 0;
  for (const Target& target : targets()) {
    if (std::string(target.name) != GetParam()) continue;
    for (const auto& file : fs::directory_iterator(kCorpora / target.name)) {
      SCOPED_TRACE(file.path());
      target.run(content_of(file.path()));
      ++inputs;
    }
  }
  EXPECT_GT(inputs, 0);
}

}  // namespace
}  // namespace ergocast::fuzz
