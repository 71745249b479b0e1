// One agent: messages and time in, messages out. No socket, thread, clock, logger or file.
//
// Messages only update tables; the control step reads them. In lockstep a tick is answered once
// every block due by it is held; in real time at once, with what is there.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/control.h"
#include "core/coverage_table.h"
#include "core/ids.h"
#include "core/messages.h"
#include "core/mission_follower.h"

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
  Agent(AgentIdentity identity, PlanDecoder decode_plan);

  /// Takes in a message. Harmless when late, repeated, out of order or untrue.
  void receive(const Message& message, Instant now);

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

  RunId run() const { return identity_.run; }
  AgentId id() const { return self_.agent; }
  AgentPhase phase() const { return phase_; }
  Tick tick() const { return tick_; }
  const CoverageTable* coverage() const { return table_ ? &*table_ : nullptr; }

  /// What the transport counted; shown in the status.
  void count_refused(Refusal refusal) { ++refused_[static_cast<std::size_t>(refusal)]; }
  void set_kernel_drops(std::int64_t drops) { kernel_drops_ = drops; }

 private:
  struct WorldView {
    Tick tick;
    std::int64_t roster_revision;
    Eigen::Vector3d position_m;
  };
  /// What was heard of one sender on the swarm bus, by its sequence numbers.
  struct Heard {
    std::int64_t first = 0, last = 0, count = 0;
    Tick news_tick = -1;  ///< when its coverage last grew for us
    std::int64_t lost() const { return std::max<std::int64_t>(0, last - first + 1 - count); }
  };

  void on(const MissionPart& part);
  void on(const Contribution& theirs);
  void on(const AgentStatus& status);
  Heard& count_heard(const Header& from);
  void on(const WorldState& world);
  void on(const Stop& stop);

  void join();
  bool evicted(Tick tick);
  void begin_tick(Outbox& out);
  void broadcast(Outbox& out);
  void repeat(Outbox& out);
  bool may_answer();
  void answer(Outbox& out);
  void publish_status(Instant now, Outbox& out);
  void finish(bool failed, std::string reason);
  Header header(Bus bus, Tick tick);
  template <class M>
  void publish(Bus bus, const M& message, Tick tick, Outbox& out);
  Tick next_broadcast_after(Tick tick) const;
  double max_staleness_s() const;
  std::int64_t messages_lost() const;

  AgentIdentity identity_;
  MissionFollower follower_;
  Author self_;
  AgentPhase phase_ = AgentPhase::kJoining;
  bool failed_ = false;
  std::string reason_;

  std::optional<CoverageTable> table_;
  std::optional<Controller> controller_;
  Coefficients team_coverage_;
  std::vector<Contribution> published_;  // own blocks as last broadcast: what a repeat repeats

  std::optional<WorldView> pending_;
  bool repeat_wanted_ = false;
  std::int64_t roster_revision_ = 0;  // of the world, at tick_
  Tick tick_ = -1, answered_tick_ = -1, next_broadcast_tick_ = 0;
  Eigen::Vector2d x_m_{0, 0};
  std::optional<BasisAt> basis_at_;
  Command last_command_;
  AgentId waiting_for_ = kUnassigned;

  Instant next_hello_{}, next_status_{};
  Tick next_status_tick_ = 0;
  Sequencer sequencer_;
  std::map<Author, Heard> heard_;
  std::int64_t received_ = 0, contributions_received_ = 0, missed_ticks_ = 0, kernel_drops_ = 0;
  RefusalCounts refused_{};

  // A teammate that already speaks under the id we ask for.
  std::int64_t rival_sequence_ = 0;
  int rival_statuses_ = 0;
};

}  // namespace ergocast
