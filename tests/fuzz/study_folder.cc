// SPDX-License-Identifier: BSD-3-Clause
// A study's folder: study.json, and after a line "--" study.csv.
#include "cli/study/study_directory.h"
#include "tests/fuzz/files.h"
#include "tests/fuzz/target.h"

namespace ergocast::fuzz {

FUZZ_TARGET(study_folder) {
  static const Folder folder;
  static const cli::StudyIdentity identity{
      {{"law.epsilon"}, {{"mission", {"0.1"}, 2, 15}, {"mission", {"1"}, 3, 20}}},
      {"00", "11"},
      "1"};
  constexpr std::string_view kSeparator = "--\n";
  const std::string_view text = text_of(input);
  const std::size_t end = std::min(text.find(kSeparator), text.size());
  folder.write("study.json", text.substr(0, end));
  folder.write("study.csv", text.substr(std::min(end + kSeparator.size(), text.size())));
  const auto opened = cli::StudyDirectory::open(folder.path(), identity);
  if (!opened) {
    ERGOCAST_REQUIRE(!opened.error().empty());
    return;
  }
  cli::StudyDirectory& directory = **opened;
  ERGOCAST_REQUIRE(directory.done().size() == directory.rows().size());
  ERGOCAST_REQUIRE(!directory.sort());
}

}  // namespace ergocast::fuzz
