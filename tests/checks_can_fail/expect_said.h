// SPDX-License-Identifier: BSD-3-Clause
// Checks that a program has printed every text in its sources. Planted faults cause the texts.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "tests/checks_can_fail/words.h"

namespace ergocast::test {

/// A text that no planted fault can produce on a test machine. Keep these few.
struct Unsayable {
  std::string file, words, why;
};

/// Whether two statements may print the same text, so that one planted fault covers both.
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
      ADD_FAILURE() << "no planted fault produces " << words
                    << "\n(tests/checks_can_fail/README.md)";
    } else {
      used.insert(&*reason);
    }
  }
  for (const Unsayable& one : unsayable) {
    EXPECT_TRUE(used.contains(&one))
        << one.file << " does print it, or no longer has it: " << one.words;
  }
  if (words_of_two == Words::kMayBeShared) return;
  for (const std::string& words : said_twice(sayings)) {
    ADD_FAILURE() << "two checks print the same words: " << words;
  }
}

}  // namespace ergocast::test
