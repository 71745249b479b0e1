// One agent: messages and time in, messages out. No socket, thread, clock, logger or file.
//
// Messages only update tables; the control step reads them. In lockstep a tick is answered once
// every block due by it is held; in real time at once, with what is there. What teammates lack it
// repeats to them (anti_entropy.h), and the mission itself to whoever asks for it.
#pragma once

#include <algorithm>
#include <bitset>
#include <optional>
#include <string>
#include <vector>

#include "agent/anti_entropy.h"
#include "agent/hearing.h"
#include "core/control.h"
#include "core/coverage_table.h"
#include "team/deadline.h"
#include "core/forecast.h"
#include "team/freshness.h"
#include "core/ids.h"
#include "team/messages.h"
#include "team/mission_follower.h"
#include "team/radio_range.h"

namespace ergocast {

struct AgentIdentity {
  RunId run = 0;                       ///< 0: the run of the first mission heard
  AgentId requested_id = kUnassigned;  ///< kUnassigned: whatever the coordinator gives
  Incarnation incarnation = 0;         ///< random, not 0
  std::string host;
  std::string version;
};

class Agent {
 public:
  explicit Agent(AgentIdentity identity);

  /// Takes in a message. Harmless when late, repeated, out of order or untrue.
  /// @param transmitter  who it comes from: its sender, or an agent that repeats it
  void receive(const Message& message, Instant now, AgentId transmitter);
  void receive(const Message& message, Instant now) {
    receive(message, now, header_of(message).sender);
  }

  /// Does whatever is due at `now` and appends what to publish, in order.
  void advance(Instant now, Outbox& out);

  /// Ends its part at once, as when its process is told to stop; advance() then says so.
  void leave(std::string reason) { finish(false, std::move(reason)); }

  /// When advance() must be called at the latest, even if nothing arrives.
  Instant next_wakeup() const;

  bool finished() const { return phase_ == AgentPhase::kFinished; }
  /// Why it finished; `failed()` if that is an error of this agent or of the mission.
  const std::string& reason() const { return reason_; }
  bool failed() const { return failed_; }
  /// What keeps it from taking part in the mission, in words; empty if nothing does.
  std::string obstacle() const;

  RunId run() const { return identity_.run; }
  AgentId id() const { return self_.agent; }
  const Author& author() const { return self_; }
  AgentPhase phase() const { return phase_; }
  Tick tick() const { return tick_; }
  const CoverageTable* coverage() const { return table_ ? &*table_ : nullptr; }
  /// c_k of the rows that it holds, added up when it is asked for: a law that looks ahead needs ĉ_k.
  const Coefficients& team_coverage() const;
  /// What its last command answers to: ĉ_k if the law looks ahead, else c_k.
  const Coefficients& foreseen_coverage() const { return foreseen_; }
  const MissionFollower& follower() const { return follower_; }
  /// Of the roster that the world flies tick() by.
  std::int64_t roster_revision() const { return roster_revision_; }
  const RefusalCounts& refused() const { return refused_; }

  /// What the transport counted; shown in the status.
  void count_refused(Refusal refusal) { ++refused_[static_cast<std::size_t>(refusal)]; }
  void note_babbler(AgentId agent) { babbler_ = agent; }
  void set_kernel_drops(std::int64_t drops) { kernel_drops_ = drops; }
  /// How late or deaf its process was; the next status tells the worst since the last.
  void note_loop_lag(double lag_s) { loop_lag_s_ = std::max(loop_lag_s_, lag_s); }

 private:
  struct WorldView {
    Tick tick;
    std::int64_t roster_revision;
    Eigen::Vector3d position_m;
  };

  void on(const MissionPart& part, Instant now);
  void on(const Contribution& theirs, AgentId transmitter, Instant now);
  void on(const Digest& theirs, Instant now);
  void on(const AgentStatus& status, Instant now);
  void on(const WorldState& world, Instant now);
  void on(const Hello& hello, Instant now);
  void on(const Stop& stop);

  void note_places(const WorldState& world);
  void join();
  bool admitted() const { return follower_.entry_of(identity_.incarnation) != nullptr; }
  const RosterEntry* member(const Header& from) const;
  std::int64_t most_steps(const RosterEntry& author, Instant now) const;
  bool evicted(Tick tick);
  void begin_tick(Instant now, Outbox& out);
  bool stalled(Instant now) const;
  bool abandoned(Instant now) const;
  void broadcast(Outbox& out);
  void repeat(Outbox& out);
  bool knows_places() const;
  bool may_answer();
  void answer(Outbox& out);
  void help_others(Instant now, Outbox& out);
  void plan_mission_repeat(Instant now, PacingClock::duration gap);
  void repeat_mission(Instant now, Outbox& out);
  void tell_world(Outbox& out);
  void stand_still(Outbox& out);
  void publish_status(Instant now, Outbox& out);
  void finish(bool failed, std::string reason);
  Header header(Bus bus, Tick tick);
  template <class M>
  void publish(Bus bus, const M& message, Tick tick, Outbox& out);

  AgentIdentity identity_;
  MissionFollower follower_;
  Author self_;
  AgentPhase phase_ = AgentPhase::kJoining;
  bool failed_ = false;
  std::string reason_;

  std::optional<CoverageTable> table_;
  std::optional<Controller> controller_;
  std::optional<Forecast> forecast_;  // if the law looks ahead
  std::optional<AntiEntropy> anti_entropy_;
  RadioRange radio_;
  Hearing hearing_;
  Coefficients foreseen_;
  mutable Coefficients team_coverage_;  // of when it was asked for last
  std::vector<Contribution> published_;  // own blocks as last broadcast: what a repeat repeats

  std::optional<WorldView> pending_;
  Tick places_tick_ = -1;  // of the newest WORLD_STATE, …
  std::bitset<kMaxAgents / kMaxVehiclesPerState> places_parts_;  // … its parts that were heard, …
  std::size_t places_wanted_ = 0;                                // … and how many there are
  bool repeat_wanted_ = false;
  std::int64_t roster_revision_ = 0;  // of the world, at tick_
  Tick active_from_ = 0;  // as the roster says
  Tick tick_ = -1, answered_tick_ = -1, next_broadcast_tick_ = 0;
  Instant tick_begun_{}, stalled_said_{};
  Eigen::Vector2d x_m_{0, 0};
  std::optional<BasisAt> basis_at_;
  Command last_command_, command_before_;  // header.tick −1: none yet
  AgentId waiting_for_ = kUnassigned;
  Instant world_heard_{}, coordinator_heard_{};  // the latter also through a teammate
  std::optional<Incarnation> world_asks_;  // where we were: it has just started
  bool halted_ = false;                    // its vehicle has yet to be told

  Instant next_hello_{}, last_hello_{};
  Deadline next_status_, next_digest_;
  std::optional<Instant> mission_repeat_;  // somebody has asked for the mission
  std::optional<Instant> mission_repeated_;
  int repeats_left_to_others_ = 0;
  Sequencer sequencer_;
  std::int64_t received_ = 0, contributions_received_ = 0, missed_ticks_ = 0, kernel_drops_ = 0;
  AgentId babbler_ = kUnassigned;
  double loop_lag_s_ = 0;
  RefusalCounts refused_{};

  Freshness freshness_;
  std::optional<Instant> rival_since_;  // a teammate already speaks under the id we ask for
};

}  // namespace ergocast
