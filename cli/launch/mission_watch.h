// SPDX-License-Identifier: BSD-3-Clause
// What `ergocast run` receives and shows of its mission.
//
// It sends STOP, and repeats MISSION to a process that asks. Agents repeat MISSION, too. But if all
// agents have stopped, a new coordinator can get the mission only here.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/operate/stop_request.h"
#include "cli/watch/progress.h"
#include "core/base/ids.h"
#include "core/mission/mission.h"
#include "runtime/bus/transport.h"
#include "scenario/scenario.h"
#include "team/messages.h"
#include "team/mission_repeat.h"
#include "team/participant.h"

namespace ergocast::cli {

/// The stage of the mission. It is over when the coordinator ends it or an agent reaches the last
/// tick.
enum class Stage {
  kGathering,  ///< no agent knows the plan yet
  kReady,      ///< agents know it
  kRunning,    ///< agents are moving
  kOver,
};

class MissionWatch {
 public:
  static constexpr Role kRole = Role::kLauncher;

  MissionWatch(RunId run, const Timing& timing, ProgressDisplay& display, bool free_domain = false)
      : me_(kRole, {run, kUnassigned, 0}),
        mission_repeat_(run),
        timing_(timing),
        display_(display) {
    progress_.tick_count = timing.tick_count;
    progress_.dt_s = timing.dt_s;
    progress_.free_domain = free_domain;
  }

  void receive(const Message& message, Bus bus, AgentId transmitter, Instant now);

  Stage stage() const { return stage_; }
  /// Whether the coordinator reported that the mission failed; reason() returns the cause.
  bool failed() const { return failed_; }
  /// Whether the mission is over because it reached its last tick.
  bool complete() const { return stage_ == Stage::kOver && me_.counted(tick_) >= tick_count(); }
  const std::string& reason() const { return reason_; }

  /// The agents that the operator has sent out of the mission.
  std::vector<AgentId> sent_out() const;

  /// Lockstep: the error text of a tick that was not answered in time.
  std::optional<std::string> overdue(Instant now) const;
  /// Whether the mission is running, but no agent has reported for so long that none can be left.
  bool deserted(Instant now) const;

  /// Repeats the mission, as its coordinator sent it, to a process that has asked for it.
  void answer(Transport& transport, Instant now);

  /// Makes repeat() send STOP from now on; only the first call has an effect.
  void stop(bool failed, std::string reason);
  bool stopping() const { return stop_.has_value(); }
  /// @param led  whether a coordinator can end the mission in order
  void repeat(Transport& transport, Instant now, bool led);

 private:
  /// By the newest end that is known.
  Tick tick_count() const { return tick_count_of(timing_, me_.follower().amendments().ends); }
  template <class M>
  void on(const M&, const Arrival&) {}  // the other types need no action
  void on(const Hello& hello, const Arrival& arrival);
  void on(const TeamStatus& team, const Arrival& arrival);
  void on(const AgentStatus& agent, const Arrival& arrival);
  void on(const MissionPart& part, const Arrival& arrival);
  void on(const Stop& stop, const Arrival& arrival);
  void on(const RecordAck& ack, const Arrival& arrival);
  void reach(Stage stage, Instant now);
  void reach(Tick tick, Instant now);

  Participant me_;
  MissionRepeat mission_repeat_;
  Timing timing_;
  ProgressDisplay& display_;
  MissionProgress progress_;
  Stage stage_ = Stage::kGathering;
  bool failed_ = false;
  std::string reason_;
  std::size_t finds_told_ = 0;
  int wrong_told_ = 0;
  Tick tick_ = 0;           // the newest, whether it counts or not
  Instant tick_since_{};    // when the last tick or stage was reached
  Instant last_running_{};  // when a running agent was last received

  std::optional<StopRequest> stop_;
  std::optional<Instant> stopping_since_;
};

}  // namespace ergocast::cli
