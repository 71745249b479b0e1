// SPDX-License-Identifier: BSD-3-Clause
// The runs received on one URL. The commands that show a team or give it orders listen to them
// here.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/ids.h"
#include "core/base/result.h"
#include "core/motion/end_rules.h"
#include "runtime/bus/transport.h"
#include "runtime/process/program_options.h"
#include "team/messages.h"
#include "team/participant.h"

namespace ergocast::cli {

/// The maximum number of runs on one URL.
/// Limit (Commands): runs that `status`, `stop` and `pause` tell apart. Beyond it: others are not
/// shown; `stop --now` stops them, too, and reports it.
inline constexpr std::size_t kMostRuns = 16;

/// Called with each message, its bus and its transmitter.
using OnMessage = std::function<void(const Message&, Bus, AgentId transmitter)>;

/// Receives all messages about the state of teams, and those of replays. An error if LCM cannot be
/// used.
/// @param role  whose subscriptions are used
Result<std::unique_ptr<Transport>> listen_to_teams(const BusOptions& options, OnMessage on_message,
                                                   OnMessage on_replayed,
                                                   Role role = Role::kMonitor);

/// The messages received from one run.
class MonitoredRun {
 public:
  static constexpr Role kRole = Role::kMonitor;

  /// @param since  when listening began: until the allowed silence is over, a member counts as
  /// present although nothing was received from it
  MonitoredRun(RunId run, Instant since);

  void receive(const Message& message, Bus bus, AgentId transmitter, Instant now);

  /// Whether a MISSION, from the coordinator or repeated by an agent, reported the mission's end.
  bool over() const { return over_; }
  const std::string& reason() const { return reason_; }
  /// The newest of the world's ticks, which continue in a pause.
  Tick tick() const { return tick_; }
  /// "tick 517, t = 51.7 s": the number of counted ticks before `tick`, and its time.
  std::string mission_time(Tick tick) const;
  /// Wall time until the world reaches `tick`; 0 in lockstep [s]. @pre knows_mission()
  double seconds_until(Tick tick) const;
  RunId run() const { return me_.run(); }
  bool knows_mission() const { return me_.knows_mission(); }
  /// @pre knows_mission()
  const Mission& mission() const { return me_.mission(); }
  /// See MissionFollower.
  const std::optional<std::string>& plan_problem() const { return me_.follower().plan_problem(); }
  /// How many ticks count by the newest end. @pre knows_mission()
  Tick tick_count() const { return me_.tick_count(); }
  /// The present agents whose vehicles have been seen.
  std::vector<AgentPlace> places() const;
  /// How many more ticks count. @pre knows_mission()
  Tick ticks_left() const { return me_.tick_count() - me_.counted(tick_); }
  /// Whether the mission has begun, is known as a whole, and is not over.
  bool is_running() const {
    return knows_mission() && me_.follower().state() == MissionState::kRunning && !over_;
  }
  /// See core/mission/hold.h. @pre knows_mission()
  const Amendments& amendments() const { return me_.follower().amendments(); }
  std::span<const Hold> holds() const { return amendments().holds; }
  /// The newest RECORD_ACK; nothing: none was received.
  const std::optional<RecordAck>& recorded() const { return recorded_; }
  bool unheard() const;
  bool coordinator_seen() const { return seen(kCoordinator); }
  bool world_seen() const { return !vehicles_.empty(); }
  /// Whether the whole roster is known.
  bool knows_roster() const { return me_.follower().revision() >= 0; }
  /// Whether no vehicle moved in the newest state that names it; true if none was received.
  bool stands_still() const;
  /// The vehicles in the newest states that name them.
  struct Standing {
    int all = 0, standing = 0;
    int circling = 0;                 ///< in a pause: fixed wings, which cannot stand
    std::vector<std::string> moving;  ///< the others: "agent 2"
    double speed_mps = 0;             ///< of the others, added up
    bool leaves_zone = false;         ///< one of the others leaves a zone, and brakes only then
  };
  Standing standing() const;
  /// Where each vehicle is in the newest state that names it [m].
  std::map<AgentId, Eigen::Vector3d> places_m() const;

  /// Processes that are not silent and have not reported their end: "agent 2", "the world".
  std::vector<std::string> still_there(Instant now) const;
  /// Those of them that may still move a vehicle: a world whose vehicles stand and a logger do not.
  std::vector<std::string> still_moving(Instant now) const;
  /// Members that are silent and have not reported that they finished.
  std::vector<std::string> lost(Instant now) const;
  /// In ascending order of authors; as the whole MISSION has it.
  const std::vector<RosterEntry>& roster() const { return me_.follower().roster(); }
  /// The entry of the present member under a number; null if there is none.
  const RosterEntry* present_member(AgentId id) const;
  /// The phase that a member has reported last; kJoining: none.
  AgentPhase phase_of(const Author& author) const;
  int agents() const { return static_cast<int>(agents_.size()); }

 private:
  template <class M>
  void on(const M&, const Arrival&) {}  // the other types need no action
  void on(const MissionPart& part, const Arrival& arrival);
  void on(const AgentStatus& status, const Arrival& arrival);
  void on(const WorldState& world, const Arrival& arrival);
  void on(const RecordAck& ack, const Arrival& arrival);
  void note_end(const Arrival& arrival, bool ended);
  bool seen(AgentId process) const { return me_.liveness().last_sign_of_kind(process).has_value(); }
  bool silent(const Author& agent, Instant now) const;
  bool there(AgentId process, Instant now) const;
  std::vector<std::string> agents_there(Instant now) const;

  struct VehicleSeen {
    Tick tick = -1;
    Eigen::Vector3d velocity_mps{0, 0, 0};
    Eigen::Vector3d position_m{0, 0, 0};
  };

  Participant me_;
  Instant since_;
  std::map<Author, AgentPhase> agents_;      // as each reported last; kJoining: it reported none
  std::map<Author, bool> processes_;         // worlds and loggers: whether they reported their end
  std::map<AgentId, VehicleSeen> vehicles_;  // in the newest state that names it
  std::optional<RecordAck> recorded_;
  Tick tick_ = 0;
  bool over_ = false;  // the coordinator reported it
  std::string reason_;
};

/// Asks to choose one of several runs, and lists them.
std::string choice_of(const std::map<RunId, MonitoredRun>& runs);

/// "a, b and c".
std::string listed(const std::vector<std::string>& names);

}  // namespace ergocast::cli
