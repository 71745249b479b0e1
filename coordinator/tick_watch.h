// SPDX-License-Identifier: BSD-3-Clause
// Tracks the newest tick of the world and of the agents. In lockstep it finds the process that a
// tick waits for.
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "coordinator/members.h"
#include "core/base/ids.h"
#include "core/mission/mission.h"
#include "team/messages.h"

namespace ergocast {

/// A lockstep tick that has lasted for longer than the plan allows.
struct OverdueTick {
  RosterEntry* straggler;  ///< the member that has not answered it; null: each member has
  std::string sentence;    ///< what the tick waits for
};

class TickWatch {
 public:
  /// The newest tick of the world.
  Tick tick() const { return tick_; }
  /// The newest tick of the world or of any agent. The world may have stopped since its last state,
  /// and agents may be ahead of that state.
  Tick newest() const { return std::max(tick_, agents_tick_); }
  /// The time since which the team could answer tick().
  Instant since() const { return since_; }
  /// Whether any world has sent a state.
  bool world_heard() const { return world_heard_; }
  /// The revision of MISSION that the world used at tick(), or at an earlier tick after a restart.
  std::int64_t world_revision() const { return world_revision_; }
  std::int64_t missed_deadlines() const { return missed_deadlines_; }

  /// Takes in the world's state. False if it is older than tick(): then only world_heard() follows.
  bool receive(const WorldState& world, Instant now);
  /// Takes in a question of a starting world, which names the agent that this world waits for. A
  /// question of another world than before gives the tick its full time again.
  void receive_question(const Hello& question, Instant now);
  void note_agent(Tick tick) { agents_tick_ = std::max(agents_tick_, tick); }
  /// The tick gets its full time again.
  void give_full_time(Instant now) { since_ = now; }

  // ---- before a takeover ----
  /// The predecessor or a world has reached `tick`.
  void note_world(Tick tick) { tick_ = std::max(tick_, tick); }
  /// Begins at the newest tick that is known, and not after the end of the mission.
  void take_over(Tick end, Instant now);

  /// Lockstep: what tick() waits for, if it has waited for too long.
  std::optional<OverdueTick> overdue(const Timing& timing, Members& members,
                                     const SignsOfLife& signs);

 private:
  RosterEntry* straggler(Members& members, const SignsOfLife& signs);

  Tick tick_ = 0;
  Instant since_{};
  std::int64_t world_revision_ = 0;
  std::int64_t missed_deadlines_ = 0;
  bool world_heard_ = false;
  std::map<AgentId, Tick> answered_;  // as the world reports them
  Tick agents_tick_ = 0;
  Incarnation asking_world_ = 0;    // the world that asked last for the team's state, …
  AgentId asks_for_ = kUnassigned;  // … the agent that it waited for in that question, …
  Instant asked_{};                 // … and the time of the question
};

}  // namespace ergocast
