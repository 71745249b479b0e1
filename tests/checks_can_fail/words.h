// SPDX-License-Identifier: BSD-3-Clause
// What the sources of a part of the program can say: read out of them, so that a check that somebody
// adds is asked for its plant whether or not he knows of the register.
#pragma once

#include <string>
#include <vector>

namespace ergocast::test {

/// What one statement says, or what one call makes another function say.
struct Saying {
  std::string place;               ///< "scenario/validate.cc:101"
  std::vector<std::string> parts;  ///< said always, in this order; what lies between is computed
  /// What it says one or the other of: the branches of `condition ? … : …`, each in parts.
  std::vector<std::vector<std::string>> alternatives;
  /// For a call with no words of its own: what the called function can say besides the parts.
  std::vector<Saying> or_else;

  /// Whether `text` says it, in one of its ways.
  bool in(const std::string& text) const;
};

/// The sayings of these files, paths relative to the tree. Words are a text with a space in it: names
/// of fields, files and keys are none. Statements for which all is well ("Level::kOk") say nothing.
std::vector<Saying> sayings_of(const std::vector<std::string>& files);

/// The .cc files of a folder of the tree, but for those in `without`.
std::vector<std::string> sources_in(const std::string& folder,
                                    const std::vector<std::string>& without = {});

/// "place: words" of every saying, and of every alternative of one, that is in none of `said`; how
/// texts are broken into lines does not matter.
std::vector<std::string> never_said(const std::vector<Saying>& sayings, std::vector<std::string> said);

/// "place and place: words" where two statements say the same of two words or more: nobody can tell which of them spoke.
std::vector<std::string> said_twice(const std::vector<Saying>& sayings);

/// For the test of the reader itself.
std::vector<Saying> sayings_in(const std::string& path, const std::string& text);

}  // namespace ergocast::test
