// SPDX-License-Identifier: BSD-3-Clause
// The bugs that the laboratory must detect. The files *_bugs.cc are linked in front of the real
// program as ergocast-with-bugs and intercept calls from one library into another (--wrap: the
// names in WRAPPED lines are the linker's, and CMake reads them there). ERGOCAST_BUG selects the
// bug; without it, every call passes through.
#pragma once

#include <cstdlib>
#include <string_view>

#include "agent/agent.h"

// NOLINTBEGIN(bugprone-reserved-identifier,readability-identifier-naming)
/// `real_x` is the program's own function, and `bug_x` stands in its place.
#define WRAPPED(result, x, symbol, ...)               \
  result real_##x(__VA_ARGS__) asm("__real_" symbol); \
  result bug_##x(__VA_ARGS__) asm("__wrap_" symbol);
// NOLINTEND(bugprone-reserved-identifier,readability-identifier-naming)

namespace ergocast {

inline bool bug(std::string_view name) {
  static const char* const chosen = std::getenv("ERGOCAST_BUG");
  return chosen != nullptr && name == chosen;
}

/// Some ticks after the mission's start, when all agents know each other.
inline constexpr Tick kUnderWay = 100;

/// The agent that receives a message now, and whether a teammate repeats it.
inline const Agent* listener;
inline bool is_relayed;

/// The same roster, in which no agent was sent home. Those that were sent out still are.
inline std::vector<RosterEntry> without_recalls(std::vector<RosterEntry> roster) {
  for (RosterEntry& entry : roster) {
    if (!entry.leaves) entry.recall_revision = -1;
  }
  return roster;
}

}  // namespace ergocast
