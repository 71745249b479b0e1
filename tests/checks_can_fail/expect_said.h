// SPDX-License-Identifier: BSD-3-Clause
// The register's rule: the program has printed every text in its sources, each after a planted
// fault.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "tests/checks_can_fail/words.h"

namespace ergocast::test {

/// Texts that no plant on a test machine can produce. Keep them few.
struct Unsayable {
  std::string file, words, why;
};

/// Whether two statements may use the same text, so that one plant serves both.
enum class Words { kAreTheirOwn, kMayBeShared };

/// Fails for each text of `files` that is in none of `said`, unless it is listed as unsayable. Also
/// fails for each unsayable text that was printed.
inline void expect_all_said(const std::vector<std::string>& files,
                            const std::vector<std::string>& said,
                            const std::vector<Unsayable>& unsayable,
                            Words words_of_two = Words::kAreTheirOwn) {
  const std::vector<Saying> sayings = sayings_of(files);
  EXPECT_FALSE(sayings.empty());
  std::set<const Unsayable*> used;
  for (const std::string& words : never_said(sayings, said)) {
    const auto reason = std::find_if(unsayable.begin(), unsayable.end(), [&](const Unsayable& one) {
      return words.starts_with(one.file + ":") && words.find(one.words) != words.npos;
    });
    if (reason == unsayable.end()) {
      ADD_FAILURE() << "nothing planted brings out " << words
                    << "\n(tests/checks_can_fail/README.md)";
    } else {
      used.insert(&*reason);
    }
  }
  for (const Unsayable& one : unsayable) {
    EXPECT_TRUE(used.contains(&one))
        << one.file << " prints it after all, or no more: " << one.words;
  }
  if (words_of_two == Words::kMayBeShared) return;
  for (const std::string& words : said_twice(sayings)) {
    ADD_FAILURE() << "two checks in one's words: " << words;
  }
}

}  // namespace ergocast::test
