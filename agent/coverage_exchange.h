// SPDX-License-Identifier: BSD-3-Clause
// The coverage of the team as one agent knows it, and its exchange with teammates: the agent adds
// its samples, broadcasts its own blocks when they are due, merges the blocks of teammates, and
// repeats what others lack (agent/anti_entropy.h).
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "agent/agent_step.h"
#include "agent/anti_entropy.h"
#include "core/base/ids.h"
#include "core/law/coverage_table.h"
#include "core/law/target_shift.h"
#include "core/mission/end_schedule.h"
#include "core/mission/kinds.h"
#include "core/mission/mission.h"
#include "core/mission/roster.h"
#include "team/author_map.h"
#include "team/deadline.h"
#include "team/messages.h"
#include "team/participant.h"
#include "team/radio_range.h"

namespace ergocast {

class CoverageExchange {
 public:
  /// @param self  the agent's entry in the roster
  /// @param joined  its first tick, counted
  CoverageExchange(const Mission& mission, const RosterEntry& self, Tick joined);

  const CoverageTable& table() const { return table_; }
  /// c_k of the rows that count, computed at each call.
  const Coefficients& team_coverage() const;

  /// The counted tick has come; see CoverageTable.
  void set_now(Tick counted) { table_.set_now(counted); }

  // ---- the own coverage ----
  /// @param shift  the changes of the target
  void add_sample(Tick counted, const BasisAt& at, const TargetShift& shift);
  /// A target has changed: from now on rows may be shifted.
  void allow_shifts() { table_.allow_shifts(); }
  /// Broadcasts the own blocks that are due at `step`, or all. A recalled agent sends each block
  /// once more when it is due, and then nothing till the end.
  void broadcast(bool all, const AgentStep& step, const EndSchedule& ends, Participant& me,
                 Outbox& out);
  /// Sends the own blocks again, as they were broadcast.
  void repeat(Participant& me, Outbox& out) const;

  // ---- the coverage of teammates ----
  /// Counts a block of a teammate. A block that another agent repeats is then not repeated again.
  void note_received(const Contribution& theirs, AgentId transmitter);
  /// Merges it, unless it is refused.
  /// @param kind  of its author
  /// @param max_steps  of any block of this author at the time
  /// @param counted  the own tick, as numbered among those that count
  std::optional<Refusal> merge(const Contribution& theirs, int kind, std::int64_t max_steps,
                               Tick counted);
  /// From now on the coverage of agents that are silent at `step` does not count, by the roster
  /// that the tick may have waited for, never by an older one. Neither does a row whose author the
  /// newest roster lacks. All other coverage counts.
  void forget_silent(const AgentStep& step, const Participant& me);
  /// The first teammate in radio range whose coverage is due at `step` and missing; kUnassigned:
  /// none.
  AgentId awaited(const AgentStep& step, const RadioRange& radio, const EndSchedule& ends,
                  const Participant& me) const;

  // ---- repair ----
  void on(const Digest& theirs, const AgentStep& step, const Participant& me, Instant now);
  /// Repeats the blocks that teammates lack, and sends the own digest when it is due.
  /// @param roster  in ticks that count
  void repair(const std::vector<RosterEntry>& roster, const AgentStep& step, Participant& me,
              Instant now, Outbox& out);
  /// When repair() should be called next.
  Instant next_repair() const;

  // ---- for the status ----
  std::int64_t received() const { return received_; }
  std::int64_t relayed() const { return anti_entropy_.relayed(); }
  /// Counted ticks since the oldest of the teammates' last updates.
  Tick oldest_update_age(const AgentStep& step, const EndSchedule& ends,
                         const Participant& me) const;

 private:
  void note_unlisted(const MissionFollower& known);

  struct Broadcast {
    Contribution block;
    Tick tick = 0, next = 0;  // when it was sent, and when the next one is due, as counted
  };

  Author self_;
  int kind_;
  Sensors sensors_;
  CoverageTable table_;
  AntiEntropy anti_entropy_;
  std::vector<Broadcast> published_;  // own blocks as last broadcast
  AuthorMap<Tick> last_update_;       // counted tick at which a teammate's coverage last grew
  std::vector<Author> unlisted_;      // teammates with a row and no entry in the roster …
  std::int64_t listed_by_ = -1;       // … of this revision
  Deadline next_digest_;
  bool rests_ = false;              // it was recalled at the newest tick that it has begun, …
  bool own_repeat_wanted_ = false;  // … and a teammate lacks some of its coverage
  std::int64_t received_ = 0;
  mutable Coefficients team_coverage_;  // as of the last call of team_coverage()
};

}  // namespace ergocast
