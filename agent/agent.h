// SPDX-License-Identifier: BSD-3-Clause
// One agent: messages and time in, messages out. No socket, thread, clock, logger or file.
//
// Messages only update tables; the control step reads the tables. In lockstep the agent answers a
// tick once it holds every block that is due by then. In real time it answers at once. It repeats
// coverage that teammates lack (anti_entropy.h), and the mission on request
// (team/mission_repeat.h). agent.cc has admission, messages and end; mission_run.cc has the tick.
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "agent/anti_entropy.h"
#include "agent/state_parts.h"
#include "core/base/ids.h"
#include "core/law/control.h"
#include "core/law/coverage_table.h"
#include "core/law/forecast.h"
#include "core/mission/kinds.h"
#include "core/motion/separation.h"
#include "core/motion/wall_following.h"
#include "core/motion/way_home.h"
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

  explicit Agent(AgentIdentity identity);

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
  Tick tick() const { return mission_run() ? mission_run()->step.tick : -1; }
  /// Whether the mission was paused at tick(), as far as this agent knew when that tick began.
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
  /// c_k of the rows that it holds, computed at each call: a law that looks ahead needs only ĉ_k.
  const Coefficients& team_coverage() const;
  /// The coverage that its last command answered to: ĉ_k if the law looks ahead, else c_k.
  const Coefficients& foreseen_coverage() const;
  const MissionFollower& follower() const { return me_.follower(); }
  /// Positions from teammates' beacons; null if the mission uses no beacons.
  const BeaconBook* beacons() const {
    return mission_run() && mission_run()->beacons ? &*mission_run()->beacons : nullptr;
  }
  /// The revision of the roster that the world uses at tick().
  std::int64_t roster_revision() const {
    return mission_run() ? mission_run()->step.roster_revision : 0;
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
  /// A tick of the world.
  struct Step {
    Tick tick = -1, answered = -1;
    Tick counted = -1;                 // its number among the ticks that count
    bool held = false;                 // the mission is paused: it does not count
    std::int64_t roster_revision = 0;  // the world's, at `tick`
    Eigen::Vector3d x_m{0, 0, 0};      // the point of the domain nearest to body_m
    Eigen::Vector3d body_m{0, 0, 0};   // a robot may be outside of the domain
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
  /// Its state from admission on. No tick comes while the mission waits for its quorum.
  struct InMission {
    /// @param joined  its first tick, counted
    InMission(const Mission& mission, const RosterEntry& self, Tick joined);

    Tick active_from;  // from the roster
    int kind;
    Sensors sensors;
    CoverageTable table;
    Controller controller;
    std::optional<Forecast> forecast;  // if the law looks ahead
    AntiEntropy anti_entropy;
    StateParts state_parts;
    std::optional<SeparationFilter> separation;  // if commands are filtered
    Bodies bodies;                               // of the newest tick, for the filter
    std::optional<BeaconBook> beacons;           // if only agents know their positions
    std::optional<WallFollower> follower;        // where there are walls
    std::optional<WayHome> way_home;             // if it has a station
    std::vector<RosterEntry> held_roster;        // for counted_roster(), once there are holds
    Coefficients foreseen;
    mutable Coefficients team_coverage;   // as of the last call of team_coverage()
    std::vector<Contribution> published;  // own blocks as last broadcast; repeat() repeats them
    AuthorMap<Tick> last_update;          // counted tick at which a member's coverage last grew
    std::optional<Instant> running_since;
    Instant stall_announced{};
    std::optional<WorldView> pending;
    Step step;
    Command last_command, command_before;     // header.tick −1: none yet
    std::optional<Incarnation> asking_world;  // a starting world that asks where we are
    Deadline next_status, next_digest;
  };
  struct Finished {
    bool failed;
    std::string reason;
    std::optional<InMission> mission;  // as it was
    Outbox final_messages;             // its final status, still to be published
  };

  template <class M>
  void on(const M&, const Arrival&) {}  // the other types need no action
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
  AgentStatus status_;  // its own counts, and those of the transport
  std::variant<Joining, InMission, Finished> state_;
};

}  // namespace ergocast
