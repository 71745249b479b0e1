// SPDX-License-Identifier: BSD-3-Clause
// The inside of a trial: who sits where, what time it is, what is wrong with whom. Its functions are
// in flight.cc (time and messages), flight_faults.cc (what is done to processes and links) and
// trial.cc (who is still there, and what came of it).
#pragma once

#include <memory>
#include <optional>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "lab/clock.h"
#include "lab/trial.h"

namespace ergocast::lab {

/// After the last tick: how long the slowest process may take to end.
inline constexpr double kFarewell_s = 10;

inline double in_seconds(Instant at) {
  return std::chrono::duration<double>(at.time_since_epoch()).count();
}

class Flight {
 public:
  Flight(const TrialOptions& options, std::ostream& trajectory, std::ostream& metrics);
  TrialResult run();

 private:
  struct Process {
    SkewedClock clock;
    Instant wakeup{};
    Instant restart = Instant::max();  // when it is started again, while it is down
    std::uint32_t life = 0;
    bool up = false, heard = false;
    bool judged = false;  // it has finished, and whether it may have is said
  };
  struct FaultEnd {
    Instant at;
    FaultEvent event;
  };
  struct Recovery {
    Instant since;
    std::vector<std::pair<Author, std::int64_t>> lacks;
  };

  NodeId coordinator_node() const { return agents_count_; }
  NodeId world_node() const { return agents_count_ + 1; }
  NodeId recorder_node() const { return agents_count_ + 2; }
  Process& at(NodeId node) { return processes_[static_cast<std::size_t>(node)]; }
  Agent& agent(NodeId node) { return *agents_[static_cast<std::size_t>(node)]; }
  template <class F>
  auto with(NodeId node, F f);
  const Subscriptions& subscriptions(NodeId node) const;
  std::string name_of(NodeId node) const;
  Incarnation incarnation_of(NodeId node) const;

  void set_clocks();
  void start(NodeId node);
  Instant next_time();
  void pass_to(Instant now);
  double progress_s() const;

  // The driver of the faults.
  void begin_events();
  void end_events();
  void begin(const FaultEvent& event);
  void cut(const FaultEvent& event, bool join);
  bool may_crash(NodeId node);
  bool crash(NodeId node, double lasts_s);
  void restart_due();
  void heal();
  bool anybody_else_knows_the_mission(NodeId node);

  void deliver_due();
  void hear(NodeId node, const Delivery& delivery);
  void advance_due();
  void advance(NodeId node);
  void publish(NodeId node);
  void after_agent(NodeId node);
  void look_for_recovery(NodeId node);
  void after_world();

  TableView view_of(NodeId node);
  std::vector<TableView> living();
  std::vector<TableView> present();
  void note_answer(NodeId node, const Message& message, const TableView& holder);
  void supervise_coordinator();
  std::string still_running();
  void note_hindrance();
  bool our_doing(Instant at) const;
  bool timed_out() const;
  bool evicted(NodeId node);
  bool struck(NodeId node);  // from the roster
  bool failed() const;
  bool mission_over() const;
  bool everybody_finished();
  void check_recovered();
  TrialResult result();

  const TrialOptions& options_;
  Mission mission_;
  std::uint64_t seed_;
  RunId run_;
  int agents_count_, nodes_;
  Network network_;
  Invariants invariants_;
  NodeSet on_bus_[kBusCount];  // whoever listens to anything there

  std::vector<Process> processes_;
  std::vector<std::unique_ptr<Agent>> agents_;
  std::unique_ptr<Coordinator> coordinator_;
  std::unique_ptr<World> world_;
  Recorder recorder_;

  Instant now_{};
  std::vector<FaultEvent> events_;
  std::size_t next_event_ = 0;
  std::vector<FaultEnd> fault_ends_;
  double planned_s_, faulty_s_;  // virtual time of the mission, and of its faults
  std::optional<Instant> healed_, failed_since_;
  std::optional<Instant> hindered_;  // the last moment at which somebody was away
  Tick excused_ = 0;       // ticks whose states may have been kept from the logger
  bool end_said_ = false;  // by a coordinator
  Instant next_check_ = Instant::max(), deadline_ = Instant::max();

  Outbox outbox_;
  std::vector<std::byte> bytes_, damaged_;
  std::vector<Tick> answered_;  // by agent
  std::optional<Tick> acknowledged_;  // by the logger, as far as it has reached the world that lives
  bool logger_lost_ = false;          // says that world
  std::vector<std::optional<Recovery>> recoveries_;
  double recovery_sum_s_ = 0;
  TrialFigures figures_;
};

template <class F>
auto Flight::with(NodeId node, F f) {
  if (node < agents_count_) return f(agent(node));
  if (node == coordinator_node()) return f(*coordinator_);
  if (node == world_node()) return f(*world_);
  return f(recorder_);
}

}  // namespace ergocast::lab
