// SPDX-License-Identifier: BSD-3-Clause
// One agent: messages and time in, messages out. No socket, thread, clock, logger or file.
//
// Messages only update tables; the control step reads the tables. The agent asks for admission,
// follows the mission, repeats it on request (team/mission_repeat.h), and finishes. What it does in
// the mission is a MissionRun (agent/mission_run.h).
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "agent/mission_run.h"
#include "core/base/ids.h"
#include "core/law/coverage_table.h"
#include "core/law/law.h"
#include "core/mission/roster.h"
#include "team/beacon_book.h"
#include "team/messages.h"
#include "team/mission_repeat.h"
#include "team/participant.h"

namespace ergocast {

struct AgentIdentity {
  RunId run = 0;                       ///< 0: the run of the first mission received
  AgentId requested_id = kUnassigned;  ///< kUnassigned: the coordinator chooses
  Incarnation incarnation = 0;         ///< random, not 0
  std::string host;
  std::string version;
  std::string kind{};  ///< name of its kind; empty: the kind planned for its id
};

class Agent {
 public:
  static constexpr Role kRole = Role::kAgent;

  /// @param laws  makes its law in a mission; all members of a team need the same one
  explicit Agent(AgentIdentity identity, LawMaker laws = make_law);

  /// Takes in a message. Harmless when late, repeated, out of order or untrue.
  /// @param bus  on which it arrived
  /// @param transmitter  its sender, or the agent that repeats it
  void receive(const Message& message, Bus bus, AgentId transmitter, Instant now);

  /// Does what is due at `now` and appends the messages to publish, in order.
  void advance(Instant now, Outbox& out);

  /// Finishes at once, as when its process gets a signal; advance() then appends its final status.
  void leave(std::string reason) { finish(false, std::move(reason)); }

  /// The latest time at which advance() must be called, even if nothing arrives.
  Instant next_wakeup() const;

  bool finished() const { return std::holds_alternative<Finished>(state_); }
  /// Why it finished; `failed()` if that is an error of this agent or of the mission.
  const std::string& reason() const;
  bool failed() const;
  /// A sentence about what keeps it out of the mission; empty if nothing does.
  std::string blocked_reason() const;

  RunId run() const { return me_.run(); }
  AgentId id() const { return me_.id(); }
  Author author() const { return me_.author(); }
  AgentPhase phase() const;
  Tick tick() const { return mission_run() ? mission_run()->step().tick : -1; }
  /// Whether the mission was paused at tick(), as far as this agent knew when that tick began.
  bool held() const { return mission_run() != nullptr && mission_run()->step().held; }
  /// The number of tick() among those that count.
  Tick counted_tick() const { return mission_run() ? mission_run()->step().counted : -1; }
  /// The roster in ticks that count.
  const std::vector<RosterEntry>& counted_roster() const {
    return mission_run() ? mission_run()->counted_roster(me_) : follower().roster();
  }
  /// Null before it is admitted.
  const CoverageTable* coverage() const {
    return mission_run() ? &mission_run()->coverage() : nullptr;
  }
  /// Where the team has searched, as it knows; null before it is admitted, or if the law does not
  /// search.
  const Efforts* efforts() const { return mission_run() ? mission_run()->efforts() : nullptr; }
  /// c_k of the rows that it holds, computed at each call: a law that looks ahead needs only ĉ_k.
  const Coefficients& team_coverage() const;
  /// The coverage that its last command answered to: ĉ_k if the law looks ahead, else c_k.
  const Coefficients& foreseen_coverage() const;
  const MissionFollower& follower() const { return me_.follower(); }
  /// Positions from teammates' beacons; null if the mission uses no beacons.
  const BeaconBook* beacons() const { return mission_run() ? mission_run()->beacons() : nullptr; }
  /// The revision of the roster that the world uses at tick().
  std::int64_t roster_revision() const {
    return mission_run() ? mission_run()->step().roster_revision : 0;
  }
  const RefusalCounts& refused() const { return me_.refused(); }

  /// Counts of the transport, for the status.
  void count_refused(Refusal refusal) { me_.count_refused(refusal); }
  void note_rate_offender(AgentId agent) { status_.rate_offender = agent; }
  void set_kernel_drops(std::int64_t drops) { status_.kernel_drops = drops; }
  /// How late its process was; the next status has the worst value since the one before.
  void note_loop_lag(double lag_s) { status_.loop_lag_s = std::max(status_.loop_lag_s, lag_s); }

 private:
  /// Its requests for admission. It also asks a restarted coordinator that does not know of it.
  struct Hellos {
    Instant next{}, last{};
    std::int64_t revision = -1;  // named by the last HELLO
  };
  /// Until the roster names it.
  struct Joining {
    std::optional<Instant> duplicate_id_since;  // another process sends under the requested id
  };
  struct Finished {
    bool failed;
    std::string reason;
    std::optional<MissionRun> mission;  // as it was
    Outbox final_messages;              // its final status, still to be published
  };

  template <class M>
  void on(const M& message, const Arrival& arrival) {  // the other types concern only the mission
    if (MissionRun* const run = in_mission()) run->on(message, arrival, me_);
  }
  void on(const MissionPart& part, const Arrival& arrival);
  void on(const AgentStatus& status, const Arrival& arrival);
  void on(const Hello& hello, const Arrival& arrival);
  void on(const Stop& stop, const Arrival& arrival);

  const Mission& mission() const { return me_.mission(); }
  MissionRun* in_mission() { return std::get_if<MissionRun>(&state_); }
  const MissionRun* in_mission() const { return std::get_if<MissionRun>(&state_); }
  /// Its mission, also after its end; null if it was never admitted.
  const MissionRun* mission_run() const;
  const RosterEntry* own_entry() const { return follower().entry_of(me_.incarnation()); }
  bool number_is_closed() const;
  bool may_ask() const { return !finished() && me_.run() != 0 && own_entry() == nullptr; }
  void ask_for_admission(Instant now, Outbox& out);
  void repeat_mission(Instant now, Outbox& out);
  AgentStatus take_process_status();
  void finish(bool failed, std::string reason, bool send_zero_velocity = false);

  Participant me_;
  AgentId requested_id_;
  std::string version_, kind_;
  LawMaker laws_;
  Hellos hellos_;
  MissionRepeat mission_repeat_;
  AgentStatus status_;  // its process's part: host and transport
  std::variant<Joining, MissionRun, Finished> state_;
};

}  // namespace ergocast
