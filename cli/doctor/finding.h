// SPDX-License-Identifier: BSD-3-Clause
// The result of one check of the machine, and its severity.
#pragma once

#include <string>
#include <vector>

namespace ergocast::doctor {

enum class Level {
  kOk,
  kNote,     ///< information; no action is needed
  kWarning,  ///< works, but loses messages or disturbs another program
  kProblem,  ///< agents will not receive each other's messages
};
const char* to_string(Level level);

struct Finding {
  std::string check;  ///< the name of the check, in a word or two
  Level level = Level::kOk;
  std::string found;   ///< one line
  std::string why;     ///< why it matters; empty if all is well
  std::string remedy;  ///< commands to copy, one a line; empty if nothing needs repair
};
using Findings = std::vector<Finding>;

Level worst_of(const Findings& findings);

/// "eth0, eth1".
std::string joined(const std::vector<std::string>& words, const char* separator = ", ");
/// `value` with `digits` digits after the point.
std::string fixed(double value, int digits);
/// "1 note", "2 notes".
std::string counted(long count, const char* what);
/// `text` without control characters for the terminal: other hosts choose these names.
std::string printable(std::string text);

}  // namespace ergocast::doctor
