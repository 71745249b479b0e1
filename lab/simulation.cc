// SPDX-License-Identifier: BSD-3-Clause
// Jumps to the earliest event, delivers what is due, and advances every process that received
// something or wakes up.
#include "lab/simulation.h"

#include <algorithm>
#include <stdexcept>

#include "lab/identity.h"
#include "plan/plan.h"

namespace ergocast::lab {

void SimulationObserver::advanced(NodeId, bool hurries) {
  if (hurries) throw std::logic_error("a process asks to be woken in the past");
}

Simulation::Simulation(SimulationOptions options, std::ostream& trajectory, std::ostream& metrics,
                       SimulationObserver* observer)
    : options_(std::move(options)),
      trajectory_(trajectory),
      metrics_(metrics),
      observer_(observer),
      mission_(decode_plan_with_table(options_.plan).value()),
      run_(simulated_run(mission_)),
      agent_count_(static_cast<int>(mission_.starts_m.size())),
      network_(mission_.seed, options_.faults, agent_count_, node_count(), options_.latency),
      wire_(run_, mission_.seed),
      faults_(options_.faults, mission_),
      nodes_(static_cast<std::size_t>(node_count())) {
  tick_count_ = mission_.timing.tick_count;
  skew_clocks();
  for (NodeId node = 0; node < node_count(); ++node) start(node);
  for (NodeId node = 0; node < node_count(); ++node) {
    routes_.add(node, subscriptions_of(role_of(node), options_.subscriptions));
  }
}

void Simulation::start(NodeId id) {
  Node& node = at(id);
  const bool again = node.starts > 0;
  const Incarnation incarnation = identity(mission_, static_cast<std::uint32_t>(id), node.starts++);
  if (id < agent_count_) {
    node.core = std::make_unique<Agent>(
        AgentIdentity{run_, id, incarnation, options_.host, options_.version}, options_.laws);
  } else if (id == coordinator_node()) {
    node.core = std::make_unique<Coordinator>(
        CoordinatorIdentity{run_, incarnation, options_.host, options_.version},
        again ? std::vector<std::byte>() : options_.plan,
        again ? Takeover::kMust : Takeover::kNever);
    if (!again)
      std::get<std::unique_ptr<Coordinator>>(node.core)->plan_amendments(options_.amendments);
  } else if (id == world_node()) {
    node.core = std::make_unique<World>(run_, incarnation, options_.physics);
  } else {
    node.core = std::make_unique<Recorder>(run_, incarnation, trajectory_, metrics_);
  }
  node.up = true;
  node.answered = false;
  node.wakeup = now_;
  if (observer_ != nullptr) observer_->started(id, incarnation, again);
}

Role Simulation::role_of(NodeId node) const {
  if (node < agent_count_) return Role::kAgent;
  if (node == coordinator_node()) return Role::kCoordinator;
  return node == world_node() ? Role::kWorld : Role::kLogger;
}

std::string Simulation::name_of(NodeId node) const {
  if (node < agent_count_) return "agent " + std::to_string(node);
  if (node == coordinator_node()) return "the coordinator";
  return node == world_node() ? "the world" : "the logger";
}

bool Simulation::everybody_finished() const {
  for (NodeId node = 0; node < node_count(); ++node) {
    if (!at(node).up || !finished(node)) return false;
  }
  return true;
}

void Simulation::end(std::string reason) {
  Node& node = at(coordinator_node());
  std::get<std::unique_ptr<Coordinator>>(node.core)->end(false, std::move(reason),
                                                         node.clock.local(now_));
  node.wakeup = now_;
}

SimulationCounts Simulation::counts() const {
  SimulationCounts counts = counts_;
  counts.faults = network_.counted();
  return counts;
}

// ---- time ----

void Simulation::run(PacingClock::duration limit) {
  while (now_.time_since_epoch() < limit && step()) {
  }
}

bool Simulation::step(Instant until) {
  if (everybody_finished()) return false;
  const Instant next = std::min(next_event(), until);
  if (next == Instant::max()) return false;
  now_ = std::max(now_, next);
  do_faults();
  send_to_coordinator();
  deliver_due();
  advance_due();
  supervise_coordinator();
  return true;
}

Instant Simulation::next_event() const {
  Instant next = std::min({network_.next(), faults_.next(), operator_.next()});
  for (const Node& node : nodes_) next = std::min(next, node.up ? node.wakeup : node.restart);
  return next;
}

void Simulation::advance_due() {
  for (NodeId node = 0; node < node_count(); ++node) {
    if (at(node).up && (at(node).received || at(node).wakeup <= now_)) advance(node);
  }
}

void Simulation::advance(NodeId id) {
  Node& node = at(id);
  const Instant local = node.clock.local(now_);
  node.received = false;
  const Instant next = std::visit(
      [&](auto& core) {
        core->advance(local, outbox_);
        return core->finished() ? Instant::max() : core->next_wakeup();
      },
      node.core);
  publish(id);
  node.wakeup = node.clock.when(next);
  SimulationObserver nobody;
  (observer_ != nullptr ? *observer_ : nobody).advanced(id, next <= local);
}

// ---- messages ----

void Simulation::publish(NodeId from) {
  if (outbox_.empty()) return;
  if (observer_ != nullptr) observer_->sends(from, outbox_);
  for (const Outgoing& sent : outbox_) {
    auto decoded = wire_.pass(sent.message);
    if (observer_ != nullptr) observer_->decoded(*decoded, false);
    if (!*decoded) continue;
    note(from, sent);
    const AgentId sender = header_of(sent.message).sender;
    const int corrupted =
        network_.send(now_, from, routes_.on(sent.bus), sent.bus,
                      sent.relayer != kUnassigned ? sent.relayer : sender, std::move(decoded));
    for (int i = 0; i < corrupted; ++i) {
      if (observer_ == nullptr) break;  // only an observer sees them
      const auto copy = static_cast<std::uint64_t>(network_.counted().corrupted - i);
      observer_->decoded(wire_.pass_damaged(copy), true);
    }
  }
  outbox_.clear();
}

/// Updates what the faults and the counts depend on.
void Simulation::note(NodeId from, const Outgoing& sent) {
  ++counts_.messages;
  counts_.relayed += sent.relayer != kUnassigned;
  counts_.contributions += std::holds_alternative<Contribution>(sent.message);
  counts_.digests += std::holds_alternative<Digest>(sent.message);
  if (const auto* world = std::get_if<WorldState>(&sent.message)) {
    last_tick_ = std::max(last_tick_, world->header.tick);
    counted_ = std::max(counted_, world->header.tick - world->uncounted_ticks);
  }
  if (const auto* part = std::get_if<MissionPart>(&sent.message)) {
    end_announced_ |= is_over(part->state);
    if (from == coordinator_node())
      tick_count_ = tick_count_of(mission_.timing, coordinator().amendments().ends);
  }
  const auto* command = std::get_if<Command>(&sent.message);
  at(from).answered |= command != nullptr && command->header.tick >= 0;
}

void Simulation::deliver_due() {
  while (network_.next() <= now_) {
    Delivery delivery = network_.pop();
    const Message& message = **delivery.read;
    const auto reaches = [&](NodeId node) {
      return delivery.to[static_cast<std::size_t>(node)] && at(node).up;
    };
    for (NodeId node = 0; observer_ != nullptr && node < node_count(); ++node) {
      if (reaches(node)) observer_->arrives(node, message);
    }
    // Everything on a bus arrives; what no subscription names goes no further.
    for (NodeId node : routes_.listeners(delivery.bus, message)) {
      if (reaches(node)) deliver(node, message, delivery);
    }
    if (delivery.read.use_count() == 1) wire_.reuse(std::move(delivery.read));
  }
}

void Simulation::deliver(NodeId to, const Message& message, const Delivery& delivery) {
  if (options_.drop && options_.drop(message, to)) return;
  Node& node = at(to);
  node.received = true;
  std::visit(
      [&](auto& core) {
        core->receive(message, delivery.bus, delivery.transmitter, node.clock.local(now_));
      },
      node.core);
  if (observer_ != nullptr) observer_->received(to, message);
}

}  // namespace ergocast::lab
