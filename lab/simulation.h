// SPDX-License-Identifier: BSD-3-Clause
// A whole team in one process: the cores and the codec of the real processes, in virtual time.
// Everything follows from the plan, its seed and the faults.
//
// A step jumps to the next event, delivers what is due and advances every process that received
// something or wakes up. Without latency and faults, messages arrive in the order in which they
// were sent, and before time passes. simulation.cc has time and messages, simulation_faults.cc the
// faults of processes and links.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "agent/agent.h"
#include "coordinator/coordinator.h"
#include "lab/fault_schedule.h"
#include "lab/faults.h"
#include "lab/network.h"
#include "lab/node.h"
#include "lab/routes.h"
#include "lab/simulated_operator.h"
#include "lab/simulated_wire.h"
#include "logger/recorder.h"
#include "sim/world.h"
#include "team/subscriptions.h"

namespace ergocast::lab {

inline double in_seconds(Instant at) {
  return std::chrono::duration<double>(at.time_since_epoch()).count();
}

struct SimulationOptions {
  std::vector<std::byte> plan;  ///< compiled; its seed is the simulation's
  Faults faults{};
  std::string version{};
  SubscriptionTable subscriptions =
      kSubscriptions;  ///< without a subscription a process receives nothing; tests remove some
  std::string host = "laboratory";
  PacingClock::duration latency{};  ///< of a message without faults
  Amendments amendments{};          ///< known from the beginning; see Amending::plan()
  PhysicsMaker physics{};           ///< what moves the bodies of the world; sim/physics.h
  LawMaker laws = make_law;         ///< makes the agents' laws
  /// For tests: whether a message that `to` subscribes to is dropped. Healing does not end the
  /// drops.
  std::function<bool(const Message&, NodeId to)> drop{};
};

/// What has happened so far.
struct SimulationCounts {
  std::int64_t messages = 0, contributions = 0, digests = 0, relayed = 0;
  MessageFaults faults;
  std::int64_t splits = 0, one_way_cuts = 0;
  std::int64_t agent_crashes = 0, coordinator_crashes = 0, world_crashes = 0, skewed_clocks = 0;
  std::int64_t pauses = 0, recalls = 0, targets = 0, ends = 0, zones = 0, laws = 0;
  std::int64_t cancels = 0;
};

/// Is called at once for each event of a simulation.
class SimulationObserver {
 public:
  virtual ~SimulationObserver() = default;
  /// `again`: in place of a process that crashed.
  virtual void started(NodeId, Incarnation, bool /*again*/) {}
  /// All that a process sends at this moment, before any of it is encoded.
  virtual void sends(NodeId, const Outbox&) {}
  virtual void decoded(const Decoded&, bool /*damaged*/) {}
  /// Called also for messages that the process does not subscribe to or that are dropped.
  virtual void arrives(NodeId, const Message&) {}
  virtual void received(NodeId, const Message&) {}
  /// `hurries`: the process asks to be woken at a time that has passed. It would run at full load,
  /// and time would not pass here. Unless overridden, this throws std::logic_error.
  virtual void advanced(NodeId, bool hurries);
  virtual void healed() {}
};

class Simulation {
 public:
  /// @param trajectory, metrics  what the recorder writes
  /// @param observer  outlives the simulation; may be null
  /// @pre options.plan decodes, and both streams are good.
  Simulation(SimulationOptions options, std::ostream& trajectory, std::ostream& metrics,
             SimulationObserver* observer = nullptr);

  /// Advances to the next event, at most to `until`. Returns false and does nothing once all
  /// processes have finished, or wait for something that never happens.
  bool step(Instant until = Instant::max());
  /// Steps until nothing happens any more, or `limit` of virtual time has passed.
  void run(PacingClock::duration limit = PacingClock::duration::max());
  /// Has the coordinator end the mission in order.
  void end(std::string reason);
  /// Has an operator give the team another target.
  void change_target(const TargetChange& target) { operator_.want_target(target); }

  // ---- processes ----

  int agent_count() const { return agent_count_; }
  int node_count() const { return agent_count_ + 3; }
  NodeId coordinator_node() const { return agent_count_; }
  NodeId world_node() const { return agent_count_ + 1; }
  NodeId logger_node() const { return agent_count_ + 2; }
  std::string name_of(NodeId node) const;
  /// The newest incarnation of each process, also while it is down.
  const Agent& agent(NodeId node) const { return core<Agent>(node); }
  const Coordinator& coordinator() const { return core<Coordinator>(coordinator_node()); }
  const World& world() const { return core<World>(world_node()); }
  const Recorder& recorder() const { return core<Recorder>(logger_node()); }
  bool up(NodeId node) const { return at(node).up; }
  bool finished(NodeId node) const { return at(node).finished(); }

  // ---- progress ----

  Instant now() const { return now_; }
  Instant local_time(NodeId node) const { return at(node).clock.local(now_); }
  /// The time that the schedule of faults uses. A lockstep mission takes no virtual time while no
  /// message is late, so mission time counts there. A mission that makes no progress has to be
  /// healed as well.
  double progress_s() const;
  /// Virtual time that the whole mission takes.
  double planned_s() const { return lab::planned_s(mission_); }
  /// The world's last tick; −1 before its first.
  Tick last_tick() const { return last_tick_; }
  /// The last tick was published, or a coordinator has announced the end.
  bool mission_over() const { return end_announced_ || counted_ >= tick_count_; }
  /// Whether the operator has sent an agent out of the mission.
  bool sent_out(AgentId id) const { return operator_.sent_out(id); }
  /// The last moment at which a process was down or cut off, or at which messages were too late or
  /// too few to judge recovery.
  std::optional<Instant> hindered() const { return hindered_; }
  SimulationCounts counts() const;

 private:
  Node& at(NodeId node) { return nodes_[static_cast<std::size_t>(node)]; }
  const Node& at(NodeId node) const { return nodes_[static_cast<std::size_t>(node)]; }
  template <class Core>
  const Core& core(NodeId node) const {
    return *std::get<std::unique_ptr<Core>>(at(node).core);
  }
  Role role_of(NodeId node) const;
  void start(NodeId node);

  bool everybody_finished() const;
  Instant next_event() const;
  void deliver_due();
  void deliver(NodeId to, const Message& message, const Delivery& delivery);
  void advance_due();
  void advance(NodeId node);
  void publish(NodeId from);
  void note(NodeId from, const Outgoing& sent);

  // Faults of processes and links.
  void skew_clocks();
  void do_faults();
  void begin(const FaultEvent& event);
  void cut(const FaultEvent& event, bool join);
  bool anybody_else_knows_the_mission(NodeId but) const;
  bool may_crash(NodeId node) const;
  bool crash(NodeId node, double lasts_s);
  void heal();
  void supervise_coordinator();
  bool takes_orders() const;
  void want_zone(std::uint64_t word);
  void want_cancel(std::uint64_t word);
  void want_target(std::uint64_t word);
  Tick drawn_delay(std::uint64_t word) const;
  TargetChange drawn_target(std::uint64_t word) const;
  Tick drawn_end(std::uint64_t word) const;
  LawChange drawn_law(std::uint64_t word) const;
  void send_to_coordinator();

  SimulationOptions options_;
  std::ostream &trajectory_, &metrics_;
  SimulationObserver* observer_;
  Mission mission_;
  RunId run_;
  int agent_count_;
  Network network_;
  Routes routes_;
  SimulatedWire wire_;
  FaultSchedule faults_;
  SimulatedOperator operator_;
  std::vector<Node> nodes_;

  Instant now_{};
  Tick tick_count_ = 0;                 // by the newest end that a coordinator has sent
  Tick last_tick_ = -1, counted_ = -1;  // counted_: the ticks before last_tick_ that count
  bool end_announced_ = false;          // by a coordinator
  Outbox outbox_;
  SimulationCounts counts_;
  std::optional<Instant> hindered_;
};

}  // namespace ergocast::lab
