// SPDX-License-Identifier: BSD-3-Clause
// What one check of the machine says, and how bad it is.
#pragma once

#include <string>
#include <vector>

namespace ergocast::doctor {

enum class Level {
  kOk,
  kNote,     ///< good to know; nothing has to be done
  kWarning,  ///< works, but loses messages or confuses somebody
  kProblem,  ///< agents will not hear each other
};
const char* to_string(Level level);

struct Finding {
  std::string check;  ///< what was looked at, in a word or two
  Level level = Level::kOk;
  std::string found;   ///< one line
  std::string why;     ///< why it matters; empty if all is well
  std::string remedy;  ///< commands to copy, one a line; empty if there is nothing to mend
};
using Findings = std::vector<Finding>;

Level worst_of(const Findings& findings);

/// "eth0, eth1".
std::string joined(const std::vector<std::string>& words, const char* separator = ", ");
/// `value` with so many digits after the point.
std::string fixed(double value, int digits);
/// "1 note", "2 notes".
std::string counted(long count, const char* what);
/// Without what could steer a terminal, for names that others chose.
std::string printable(std::string text);

}  // namespace ergocast::doctor
