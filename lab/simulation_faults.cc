// SPDX-License-Identifier: BSD-3-Clause
// Crashes, freezes and cuts off simulated processes by the schedule, but never destroys all
// copies of one fact.
#include <algorithm>

#include "lab/random_stream.h"
#include "lab/simulation.h"

namespace ergocast::lab {
namespace {

/// A random stream beside those of lab/faults.cc.
constexpr std::uint32_t kClocks = 16;

/// As `ergocast pause` repeats it.
constexpr auto kOperatorPeriod = std::chrono::milliseconds(100);

}  // namespace

double Simulation::planned_s() const {
  const Timing& timing = mission_.timing;
  return static_cast<double>(timing.tick_count) * timing.dt_s / timing.realtime_factor;
}

double Simulation::progress_s() const {
  const double virtual_s = in_seconds(now_);
  const Timing& timing = mission_.timing;
  if (timing.pace == Pace::kRealtime) return virtual_s;
  return std::max(virtual_s,
                  static_cast<double>(last_tick_) * timing.dt_s / timing.realtime_factor);
}

void Simulation::set_up_faults() {
  const Faults& faults = options_.faults;
  const Timing& timing = mission_.timing;
  hinders_ = hinders(faults, timing.lockstep_timeout_s);
  faulty_s_ = faults.lasting_share * planned_s();
  // A share of 1 lasts to the end, also of a mission that began late.
  if (faults.lasting_share >= 1) faulty_s_ += timing.admission_timeout_s;
  events_ = fault_events(faults, mission_.seed, agent_count_, faulty_s_);
  if (faults.clock_rate_error <= 0 && faults.clock_offset_max_s <= 0) return;
  RandomStream random(mission_.seed, kClocks);
  for (Node& node : nodes_) {
    const double rate = 1 + faults.clock_rate_error * (2 * random.uniform() - 1);
    node.clock = SkewedClock(rate, seconds(faults.clock_offset_max_s * random.uniform()));
    ++counts_.skewed_clocks;
  }
}

/// The last event is healing, which ends all faults.
Instant Simulation::next_fault() const {
  if (healed_) return Instant::max();
  const bool any = next_fault_ < events_.size();
  Instant next(seconds(any ? std::min(events_[next_fault_].at_s, faulty_s_) : faulty_s_));
  for (const FaultEnd& end : fault_ends_) next = std::min(next, end.at);
  return std::min(next, paused_until_.value_or(next));
}

/// Time passes in whole nanoseconds: a moment may have come although progress_s() is a rounding
/// error short.
bool Simulation::comes(double at_s) const { return Instant(seconds(at_s)) <= now_; }

void Simulation::do_faults() {
  if (!healed_) {
    end_events();
    begin_events();
    if (comes(faulty_s_) || progress_s() >= faulty_s_ || mission_over()) heal();
  }
  bool away = false;
  for (NodeId node = 0; node < node_count(); ++node) {
    if (!up(node) && at(node).restart <= now_) start(node);
    away |= !up(node);
  }
  if (away || (hinders_ && !healed_) || !fault_ends_.empty()) hindered_ = now_;
}

void Simulation::begin_events() {
  const double progress = progress_s();
  const auto due = [&](double at_s) { return comes(at_s) || at_s <= progress + 1e-9; };
  while (next_fault_ < events_.size() && due(events_[next_fault_].at_s)) {
    begin(events_[next_fault_++]);
  }
}

void Simulation::begin(const FaultEvent& event) {
  using enum FaultEvent::Kind;
  switch (event.kind) {
    case kSplit:
    case kOneWayCut:
      ++(event.kind == kSplit ? counts_.splits : counts_.one_way_cuts);
      cut(event, false);
      fault_ends_.push_back({now_ + seconds(event.lasts_s), event});
      return;
    case kAgentCrash:
      counts_.agent_crashes += crash(static_cast<NodeId>(event.who), event.lasts_s);
      return;
    case kCoordinatorCrash:
      counts_.coordinator_crashes += crash(coordinator_node(), event.lasts_s);
      return;
    case kWorldCrash:
      counts_.world_crashes += crash(world_node(), event.lasts_s);
      return;
    case kPause:
      ++counts_.pauses;
      paused_until_ = std::max(paused_until_.value_or(now_), now_ + seconds(event.lasts_s));
      return;
  }
}

void Simulation::cut(const FaultEvent& event, bool join) {
  const auto first = [&](NodeId node) { return (event.who >> (node % 64) & 1) != 0; };
  for (NodeId from = 0; from < node_count(); ++from) {
    for (NodeId to = 0; to < node_count(); ++to) {
      const bool deaf = event.kind == FaultEvent::Kind::kSplit ? first(from) != first(to)
                                                               : first(from) && !first(to);
      if (!deaf) continue;
      join ? network_.join(from, to) : network_.cut(from, to);
    }
  }
}

/// An operator who wants the mission to be paused, or to go on, sends this until a tick is named,
/// ten times a second.
void Simulation::send_to_coordinator() {
  const NodeId node = coordinator_node();
  if (operator_messages_ == 0 && !paused_until_) return;
  if (!up(node) || finished(node) || coordinator().looking() || mission_over()) return;
  const auto& holds = coordinator().holds();
  if (is_open(holds) == paused_until_.has_value()) {
    next_operator_message_ = now_;
    return;
  }
  if (now_ < next_operator_message_) return;
  next_operator_message_ = now_ + kOperatorPeriod;
  const Pause pause{
      {run_, kOperator, 1, ++operator_messages_, coordinator().tick()}, named_changes(holds), {}};
  deliver(node, pause, Delivery{Bus::kSwarm, kOperator, {}, nullptr});
}

void Simulation::end_events() {
  if (paused_until_ && *paused_until_ <= now_) paused_until_.reset();
  std::erase_if(fault_ends_, [this](const FaultEnd& end) {
    if (end.at > now_) return false;
    cut(end.event, true);
    return true;
  });
}

/// An evicted agent has ended, and sends nothing any more.
bool Simulation::anybody_else_knows_the_mission(NodeId but) const {
  for (NodeId node = 0; node < agent_count_; ++node) {
    if (node == but || !up(node) || finished(node)) continue;
    if (agent(node).follower().mission()) return true;
  }
  return false;
}

/// Only the world and, by its last commands, the agent know a vehicle's position. Only the
/// coordinator and the agents that follow it know the mission. A process that alone knows something
/// does not crash.
bool Simulation::may_crash(NodeId node) const {
  if (!up(node) || at(node).starts >= kMaxIncarnationsPerAgent - 2) return false;
  if (mission_over()) return false;
  const bool world_knows = up(world_node()) && world().begun_at();
  if (node < agent_count_) {
    const bool coordinator_knows = up(coordinator_node()) && coordinator().mission() != nullptr;
    if (!coordinator_knows && !anybody_else_knows_the_mission(node)) return false;
    return world_knows || last_tick_ < 0;
  }
  if (node == coordinator_node()) return anybody_else_knows_the_mission(kMaxNodes);
  return world_knows && std::all_of(nodes_.begin(), nodes_.begin() + agent_count_,
                                    [](const Node& agent) { return agent.up && agent.answered; });
}

bool Simulation::crash(NodeId node, double lasts_s) {
  if (!may_crash(node)) return false;
  at(node).up = false;
  at(node).restart = now_ + seconds(lasts_s);
  return true;
}

/// Acts like an init system: restarts a coordinator that found no mission to take over.
void Simulation::supervise_coordinator() {
  Node& node = at(coordinator_node());
  if (healed_ || !node.up || !coordinator().finished() || mission_over()) return;
  if (coordinator().mission() != nullptr) return;
  ++counts_.coordinator_crashes;
  node.up = false;
  node.restart = now_;
}

void Simulation::heal() {
  healed_ = true;
  fault_ends_.clear();
  paused_until_.reset();
  network_.heal(now_);
  for (Node& node : nodes_) {
    if (!node.up) node.restart = now_;
  }
  if (observer_ != nullptr) observer_->healed();
}

}  // namespace ergocast::lab
