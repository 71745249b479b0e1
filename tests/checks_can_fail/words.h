// SPDX-License-Identifier: BSD-3-Clause
// Reads all texts that a part of the program can print from its sources. So every new check needs
// a planted fault, even if its author does not know these tests.
#pragma once

#include <string>
#include <vector>

namespace ergocast::test {

/// The text of one statement, or of a function that it calls.
struct Saying {
  std::string place;               ///< "scenario/rules/validate.cc:101"
  std::vector<std::string> parts;  ///< always printed, in this order, with values in between
  /// Alternative texts: the branches of `condition ? … : …`, each in parts.
  std::vector<std::vector<std::string>> alternatives;
  /// For a call without a text of its own: the texts of the called function, besides the parts.
  std::vector<Saying> or_else;

  /// Whether `text` contains it in one of its alternatives.
  bool in(const std::string& text) const;
};

/// The texts of these files, paths relative to the tree. A text has a space in it: names of fields,
/// files and keys are none. Statements of success ("Level::kOk") do not count.
std::vector<Saying> sayings_of(const std::vector<std::string>& files);

/// The .cc files of a folder of the tree, except those in `without`.
std::vector<std::string> sources_in(const std::string& folder,
                                    const std::vector<std::string>& without = {});

/// "place: text" of every text, and of every alternative of one, that is in none of `said`. Line
/// breaks are ignored.
std::vector<std::string> never_said(const std::vector<Saying>& sayings,
                                    std::vector<std::string> said);

/// "place and place: text" for two statements with the same text of two words or more, which the
/// output cannot distinguish.
std::vector<std::string> said_twice(const std::vector<Saying>& sayings);

}  // namespace ergocast::test
