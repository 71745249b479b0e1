// SPDX-License-Identifier: BSD-3-Clause
// Writes numbers so that they read back exactly.
#include "cli/command_text.h"

#include <algorithm>
#include <initializer_list>

#include "text/shell_word.h"
#include "text/shortest.h"

namespace ergocast::cli {

std::vector<std::string> words_of(const Overrides& overrides) {
  std::vector<std::string> words;
  const auto add = [&words](std::initializer_list<std::string> more) {
    words.insert(words.end(), more);
  };
  if (overrides.duration_s) add({"--duration", shortest(*overrides.duration_s)});
  if (overrides.agents) add({"--agents", std::to_string(*overrides.agents)});
  if (overrides.realtime_factor) {
    add({"--realtime=" + shortest(*overrides.realtime_factor)});
  } else if (overrides.pace == Pace::kLockstep) {
    add({"--lockstep"});
  }
  for (const FieldValue& field : overrides.fields) add({"--set", field.path + '=' + field.value});
  return words;
}

std::string options_of(const Overrides& overrides) {
  std::string text;
  for (const std::string& word : words_of(overrides)) {
    const std::size_t equals = std::min(word.find('='), word.size());
    text += ' ' + shell_word(word.substr(0, equals));
    if (equals < word.size()) text += '=' + shell_word(word.substr(equals + 1));
  }
  return text;
}

}  // namespace ergocast::cli
