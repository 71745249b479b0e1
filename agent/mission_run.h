// SPDX-License-Identifier: BSD-3-Clause
// A mission as one agent takes part in it, from its admission on: what the agent does at a tick of
// the world. No tick comes while the mission waits for its quorum.
//
// At a tick the agent samples, broadcasts what is due, and answers with a command. In lockstep it
// answers once it holds every block that is due by then, in real time at once. The ideas are parts:
// coverage and its exchange (agent/coverage_exchange.h), the law (agent/guidance.h), and how a
// velocity becomes safe (agent/safe_motion.h).
//
// `me` is the agent's own Participant: its number, what it knows of mission and roster, and its way
// to publish. It is a parameter, not a member, so that agents can be moved.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "agent/agent_step.h"
#include "agent/coverage_exchange.h"
#include "agent/guidance.h"
#include "agent/safe_motion.h"
#include "agent/search_exchange.h"
#include "core/base/ids.h"
#include "core/law/coverage_table.h"
#include "core/law/lost_places.h"
#include "core/law/target_shift.h"
#include "core/mission/end_schedule.h"
#include "core/mission/roster.h"
#include "team/beacon_book.h"
#include "team/deadline.h"
#include "team/messages.h"
#include "team/participant.h"
#include "team/radio_range.h"

namespace ergocast {

/// The mission is over for an agent.
struct MissionOver {
  bool failed;
  std::string reason;
  bool stops_vehicle = false;  ///< the vehicle's driver goes on, so it needs a last command
};

/// The reason of an agent that was sent out of the mission.
inline constexpr const char* kSentOut = "sent out of the mission by the operator";

class MissionRun {
 public:
  /// @param self  the agent's entry in the roster
  MissionRun(const Participant& me, const RosterEntry& self, const LawMaker& laws);

  /// Why the mission is over for the process if it is no longer a member at `tick`, else nothing.
  static std::optional<MissionOver> evicted(const Participant& me, Tick tick);

  // ---- what the agent learns ----
  /// Takes in the newest roster.
  void note_roster(const Participant& me);
  /// The mission runs. Only the first call has an effect.
  void start(Instant now);
  bool started() const { return running_since_.has_value(); }
  /// A starting world asks where the vehicles are.
  void asked_by(Incarnation world) { asking_world_ = world; }
  /// Whether a transmitter is in radio range.
  bool receives(AgentId transmitter, const Participant& me) const {
    return radio_.receives(me.id(), transmitter);
  }

  template <class M>
  void on(const M&, const Arrival&, Participant&) {}  // the other types need no action
  void on(const Contribution& theirs, const Arrival& arrival, Participant& me);
  void on(const Digest& theirs, const Arrival& arrival, Participant& me);
  void on(const Effort& theirs, const Arrival& arrival, Participant& me);
  void on(const WorldState& world, const Arrival& arrival, Participant& me);
  void on(const Beacon& beacon, const Arrival& arrival, Participant& me);

  // ---- what the agent does ----
  /// Begins and answers ticks. Returns why the mission is over for the agent, if it is.
  /// @pre started()
  std::optional<MissionOver> advance(Participant& me, Instant now, Outbox& out);
  /// Answers a starting world, and teammates that lack coverage.
  void help(Participant& me, Instant now, Outbox& out);
  /// Whether the next status is due.
  bool status_due(Instant now) const { return next_status_.due(now, step_.tick); }
  /// @param status  what it has of the process; the rest is filled in
  void publish_status(AgentStatus status, Participant& me, Instant now, Outbox& out);
  /// Commands velocity 0 for the newest tick: the vehicle's driver may not know STOP.
  void stop_vehicle(Participant& me, Outbox& out);
  /// The same as publish_status(), for an agent that has finished.
  void publish_last_status(AgentStatus status, Participant& me, Outbox& out) const;
  /// When help() or publish_status() should be called next.
  Instant next_wakeup() const;

  // ---- what it has ----
  const AgentStep& step() const { return step_; }
  /// The roster in ticks that count.
  const std::vector<RosterEntry>& counted_roster(const Participant& me) const;
  const CoverageTable& coverage() const { return exchange_.table(); }
  /// Null if the law does not search.
  const Efforts* efforts() const { return search_ ? &search_->efforts() : nullptr; }
  const Coefficients& team_coverage() const { return exchange_.team_coverage(); }
  const Coefficients& foreseen_coverage() const { return guidance_.foreseen(); }
  const BeaconBook* beacons() const { return motion_.bodies().beacons(); }

 private:
  Tick lead(const Participant& me, Instant now) const;
  std::int64_t max_steps(const RosterEntry& author, const Participant& me, Tick lead) const;
  bool may_begin(const Participant& me) const;
  void add_lost_samples(const PlaceAtTick& before, const Mission& mission);
  std::optional<MissionOver> begin_tick(Participant& me, Instant now, Outbox& out);
  AgentId awaited(const Participant& me) const;
  void answer(Participant& me, Outbox& out);
  void repeat(Participant& me, Outbox& out);
  bool is_behind(Tick world_tick, const Participant& me, Instant now) const;
  bool stalled(const Participant& me, Instant now) const;
  void report_position(Participant& me, Outbox& out);
  AgentPhase phase(const Participant& me) const;
  void fill_in(AgentStatus& status, const Participant& me) const;

  Tick active_from_;  // from the roster
  RadioRange radio_;
  CoverageExchange exchange_;
  std::optional<SearchExchange> search_;
  EndSchedule ends_;
  bool has_known_ends_ = false;  // also if they are void by now
  TargetShift shift_;
  Guidance guidance_;
  SafeMotion motion_;
  std::vector<RosterEntry> held_roster_;  // for counted_roster(), once there are holds
  std::optional<Instant> running_since_;
  std::optional<OwnState> pending_;  // of the tick to begin next
  AgentStep step_;
  Tick answered_ = -1;  // the newest tick that was answered
  AgentId waiting_for_ = kUnassigned;
  bool repeat_wanted_ = false;
  bool covered_ = false;  // whether the last tick was sampled
  bool world_is_behind_ = false;
  Instant stall_announced_{};
  std::int64_t missed_ticks_ = 0;
  Command last_command_, command_before_;    // header.tick −1: none yet
  std::optional<Incarnation> asking_world_;  // a starting world that asks where we are
  Deadline next_status_;
};

}  // namespace ergocast
