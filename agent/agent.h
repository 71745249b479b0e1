// SPDX-License-Identifier: BSD-3-Clause
// One agent: messages and time in, messages out. No socket, thread, clock, logger or file.
//
// Messages only update tables; the control step reads them. In lockstep a tick is answered once
// every block due by it is held; in real time at once, with what is there. What teammates lack it
// repeats to them (anti_entropy.h), and the mission itself on request
// (team/mission_repeat.h). Its life until and after the mission is in agent.cc, the tick in
// mission_run.cc.
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "agent/anti_entropy.h"
#include "agent/state_parts.h"
#include "core/control.h"
#include "core/coverage_table.h"
#include "core/forecast.h"
#include "core/ids.h"
#include "core/kinds.h"
#include "core/separation.h"
#include "core/wall_following.h"
#include "core/way_home.h"
#include "team/author_map.h"
#include "team/beacon_book.h"
#include "team/bodies.h"
#include "team/deadline.h"
#include "team/messages.h"
#include "team/mission_repeat.h"
#include "team/participant.h"
#include "team/radio_range.h"

namespace ergocast {

struct AgentIdentity {
  RunId run = 0;                       ///< 0: the run of the first mission heard
  AgentId requested_id = kUnassigned;  ///< kUnassigned: whatever the coordinator gives
  Incarnation incarnation = 0;         ///< random, not 0
  std::string host;
  std::string version;
  std::string kind{};  ///< the name of the kind that it brings; empty: the one planned
};

class Agent {
 public:
  static constexpr Role kRole = Role::kAgent;

  explicit Agent(AgentIdentity identity);

  /// Takes in a message. Harmless when late, repeated, out of order or untrue.
  /// @param bus  on which it came
  /// @param transmitter  who it comes from: its sender, or an agent that repeats it
  void receive(const Message& message, Bus bus, AgentId transmitter, Instant now);

  /// Does whatever is due at `now` and appends what to publish, in order.
  void advance(Instant now, Outbox& out);

  /// Ends its part at once, as when its process is told to stop; advance() then says so.
  void leave(std::string reason) { finish(false, std::move(reason)); }

  /// When advance() must be called at the latest, even if nothing arrives.
  Instant next_wakeup() const;

  bool finished() const { return std::holds_alternative<Finished>(state_); }
  /// Why it finished; `failed()` if that is an error of this agent or of the mission.
  const std::string& reason() const;
  bool failed() const;
  /// What keeps it from taking part in the mission, in words; empty if nothing does.
  std::string blocked_reason() const;

  RunId run() const { return me_.run(); }
  AgentId id() const { return me_.id(); }
  Author author() const { return me_.author(); }
  AgentPhase phase() const;
  Tick tick() const { return mission_run() ? mission_run()->step.tick : -1; }
  /// Whether the mission was paused at tick(), as far as this agent knew when it began that.
  bool held() const { return mission_run() != nullptr && mission_run()->step.held; }
  /// The number of tick() among those that count.
  Tick counted_tick() const { return mission_run() ? mission_run()->step.counted : -1; }
  /// The roster in ticks that count.
  const std::vector<RosterEntry>& counted_roster() const {
    const bool same = follower().holds().empty() || mission_run() == nullptr;
    return same ? follower().roster() : mission_run()->held_roster;
  }
  /// Null before it is admitted.
  const CoverageTable* coverage() const { return mission_run() ? &mission_run()->table : nullptr; }
  /// c_k of the rows that it holds, added up when it is asked for: a law that looks ahead needs
  /// ĉ_k.
  const Coefficients& team_coverage() const;
  /// What its last command answers to: ĉ_k if the law looks ahead, else c_k.
  const Coefficients& foreseen_coverage() const;
  const MissionFollower& follower() const { return me_.follower(); }
  /// What it knows of teammates' places, where agents tell them; null elsewhere.
  const BeaconBook* beacons() const {
    return mission_run() && mission_run()->beacons ? &*mission_run()->beacons : nullptr;
  }
  /// Of the roster that the world flies tick() by.
  std::int64_t roster_revision() const {
    return mission_run() ? mission_run()->step.roster_revision : 0;
  }
  const RefusalCounts& refused() const { return me_.refused(); }

  /// What the transport counted; shown in the status.
  void count_refused(Refusal refusal) { me_.count_refused(refusal); }
  void note_rate_offender(AgentId agent) { status_.rate_offender = agent; }
  void set_kernel_drops(std::int64_t drops) { status_.kernel_drops = drops; }
  /// How late or deaf its process was; the next status tells the worst since the last.
  void note_loop_lag(double lag_s) { status_.loop_lag_s = std::max(status_.loop_lag_s, lag_s); }

 private:
  /// How it asks to be admitted, also by a coordinator that was restarted and does not know of it.
  struct Hellos {
    Instant next{}, last{};
    std::int64_t revision = -1;  // that the last one named
  };
  /// Until the roster names it.
  struct Joining {
    std::optional<Instant> duplicate_id_since;  // a teammate already speaks under the id we ask for
  };
  /// A tick of the world.
  struct Step {
    Tick tick = -1, answered = -1;
    Tick counted = -1;                 // its number among those that count
    bool held = false;                 // the mission is paused: it does not count
    std::int64_t roster_revision = 0;  // of the world, at `tick`
    Eigen::Vector3d x_m{0, 0, 0};      // in the domain
    Eigen::Vector3d body_m{0, 0, 0};   // a robot may be beside it
    Eigen::Vector3d body_mps{0, 0, 0};
    std::optional<BasisAt> basis_at;
    Instant begun{};
    bool repeat_wanted = false;
    AgentId waiting_for = kUnassigned;
  };
  struct WorldView {
    Tick tick;
    std::int64_t roster_revision;
    std::int64_t answered_tick;
    Eigen::Vector3d position_m, velocity_mps;
  };
  /// From its admission on. While the mission waits for its quorum, no tick comes.
  struct InMission {
    /// @param joined  its first tick, counted
    InMission(const Mission& mission, const RosterEntry& self, Tick joined);

    Tick active_from;  // as the roster says
    int kind;          // its own
    Sensors sensors;
    CoverageTable table;
    Controller controller;
    std::optional<Forecast> forecast;  // if the law looks ahead
    AntiEntropy anti_entropy;
    StateParts state_parts;
    std::optional<SeparationFilter> separation;  // if commands are filtered
    Bodies bodies;                               // then, of the newest tick
    std::optional<BeaconBook> beacons;           // where only agents know their places
    std::optional<WallFollower> follower;        // where there are walls
    std::optional<WayHome> way_home;             // if it has a station
    std::vector<RosterEntry> held_roster;        // as counted_roster() says, once there are holds
    Coefficients foreseen;
    mutable Coefficients team_coverage;   // of when it was asked for last
    std::vector<Contribution> published;  // own blocks as last broadcast: what a repeat repeats
    AuthorMap<Tick> last_update;  // when a member's coverage last grew for us, in ticks that count
    std::optional<Instant> running_since;
    Instant stall_announced{};
    std::optional<WorldView> pending;
    Step step;
    Command last_command, command_before;     // header.tick −1: none yet
    std::optional<Incarnation> asking_world;  // where we were: it has just started
    Deadline next_status, next_digest;
  };
  struct Finished {
    bool failed;
    std::string reason;
    std::optional<InMission> mission;  // as it was
    Outbox final_messages;             // its final status, still to be published
  };

  template <class M>
  void on(const M&, const Arrival&) {}  // nothing follows from the other types
  void on(const MissionPart& part, const Arrival& arrival);
  void on(const Contribution& theirs, const Arrival& arrival);
  void on(const Digest& theirs, const Arrival& arrival);
  void on(const AgentStatus& status, const Arrival& arrival);
  void on(const WorldState& world, const Arrival& arrival);
  void on(const Beacon& beacon, const Arrival& arrival);
  void on(const Hello& hello, const Arrival& arrival);
  void on(const Stop& stop, const Arrival& arrival);

  const Mission& mission() const { return me_.mission(); }
  InMission* in_mission() { return std::get_if<InMission>(&state_); }
  /// Its mission, also after its end; null if it was never admitted.
  const InMission* mission_run() const;
  const RosterEntry* own_entry() const { return follower().entry_of(me_.incarnation()); }
  bool may_ask() const { return !finished() && me_.run() != 0 && own_entry() == nullptr; }
  std::optional<std::string> evicted(Tick tick) const;
  void ask_for_admission(Instant now, Outbox& out);
  void repeat_mission(Instant now, Outbox& out);
  void note_roster();
  std::int64_t max_steps(const InMission& mission_run, const RosterEntry& author,
                         Instant now) const;
  std::int64_t lost() const;
  Tick oldest_update_age(const InMission& mission_run) const;
  AgentPhase phase_in(const InMission& mission_run) const;
  AgentStatus status_of(const InMission& mission_run, AgentPhase phase);
  void publish_status(InMission& mission_run, Instant now, Outbox& out);
  void finish(bool failed, std::string reason, bool send_zero_velocity = false);

  void advance_mission(InMission& mission_run, Instant now, Outbox& out);
  void note_places(InMission& mission_run, const WorldState& world);
  bool may_begin(const InMission& mission_run) const;
  bool begin_tick(InMission& mission_run, Instant now, Outbox& out);
  void publish_place(InMission& mission_run, const WorldView& view, Outbox& out);
  bool stalled(const InMission& mission_run, Instant now) const;
  void broadcast(InMission& mission_run, bool all, Outbox& out);
  void repeat(InMission& mission_run, Outbox& out);
  bool may_answer(InMission& mission_run) const;
  void answer(InMission& mission_run, Outbox& out);
  void forget_silent(InMission& mission_run) const;
  Eigen::Vector3d wanted(InMission& mission_run);
  Eigen::Vector3d kept_apart(InMission& mission_run, const Eigen::Vector3d& wanted_mps);
  SafeVelocity safe_velocity(InMission& mission_run, const Eigen::Vector3d& aim_mps);
  void answer_digests(InMission& mission_run, Instant now, Outbox& out);
  void report_position(InMission& mission_run, Outbox& out);

  Participant me_;
  AgentId requested_id_;
  std::string version_, kind_;
  Hellos hellos_;
  MissionRepeat mission_repeat_;
  RadioRange radio_;
  AgentStatus status_;  // what it counts, and what the transport told
  std::variant<Joining, InMission, Finished> state_;
};

}  // namespace ergocast
