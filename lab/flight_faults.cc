// SPDX-License-Identifier: BSD-3-Clause
// Crashes, freezes and cuts off simulated processes by the schedule, but never destroys all
// copies of one fact.
#include <algorithm>

#include "team/liveness.h"
#include "lab/flight.h"

namespace ergocast::lab {

void Flight::begin_events() {
  const double progress = progress_s();
  while (next_event_ < events_.size() && events_[next_event_].at_s <= progress + 1e-9) {
    begin(events_[next_event_++]);
  }
}

void Flight::begin(const FaultEvent& event) {
  using enum FaultEvent::Kind;
  switch (event.kind) {
    case kSplit:
    case kOneWayCut:
      ++(event.kind == kSplit ? figures_.splits : figures_.one_way_cuts);
      cut(event, false);
      fault_ends_.push_back({now_ + seconds(event.lasts_s), event});
      return;
    case kAgentCrash:
      figures_.agent_crashes += crash(static_cast<NodeId>(event.who), event.lasts_s);
      return;
    case kCoordinatorCrash:
      figures_.coordinator_crashes += crash(coordinator_node(), event.lasts_s);
      return;
    case kWorldCrash: figures_.world_crashes += crash(world_node(), event.lasts_s); return;
  }
}

void Flight::cut(const FaultEvent& event, bool join) {
  const auto first = [&](NodeId node) { return (event.who >> (node % 64) & 1) != 0; };
  for (NodeId from = 0; from < nodes_; ++from) {
    for (NodeId to = 0; to < nodes_; ++to) {
      const bool deaf = event.kind == FaultEvent::Kind::kSplit ? first(from) != first(to)
                                                                : first(from) && !first(to);
      if (!deaf) continue;
      join ? network_.join(from, to) : network_.cut(from, to);
    }
  }
}

void Flight::end_events() {
  std::erase_if(fault_ends_, [this](const FaultEnd& end) {
    if (end.at > now_) return false;
    cut(end.event, true);
    return true;
  });
}

/// An evicted agent has ended, and tells nobody any more.
bool Flight::anybody_else_knows_the_mission(NodeId but) {
  for (NodeId node = 0; node < agents_count_; ++node) {
    if (node == but || !at(node).up || agent(node).finished()) continue;
    if (agent(node).follower().mission()) return true;
  }
  return false;
}

/// What nobody remembers, nobody can bring back: a vehicle's position is known to the world and,
/// by its last commands, to its agent; the mission to the coordinator and the agents that follow it.
/// So these are not taken down together.
bool Flight::may_crash(NodeId node) {
  if (!at(node).up || at(node).life >= kMaxIncarnationsPerAgent - 2) return false;
  if (mission_over()) return false;
  const bool world_knows = at(world_node()).up && world_->begun_at();
  if (node < agents_count_) {
    const bool coordinator_knows = at(coordinator_node()).up && coordinator_->mission() != nullptr;
    if (!coordinator_knows && !anybody_else_knows_the_mission(node)) return false;
    return world_knows || invariants_.last_tick() < 0;
  }
  if (node == coordinator_node()) return anybody_else_knows_the_mission(kMaxNodes);
  return world_knows && std::none_of(answered_.begin(), answered_.end(),
                                     [](Tick tick) { return tick < 0; });
}

bool Flight::crash(NodeId node, double lasts_s) {
  if (!may_crash(node)) return false;
  at(node).up = false;
  at(node).restart = now_ + seconds(lasts_s);
  if (node < agents_count_) {
    answered_[static_cast<std::size_t>(node)] = -1;
    recoveries_[static_cast<std::size_t>(node)].reset();
  }
  return true;
}

void Flight::restart_due() {
  for (NodeId node = 0; node < nodes_; ++node) {
    if (at(node).up || at(node).restart > now_) continue;
    start(node);
    if (node >= agents_count_) continue;
    Recovery recovery{now_, {}};
    const auto team = living();
    for (const Author& author : invariants_.authors()) {
      if (author.agent != node) continue;
      std::int64_t most = 0;
      for (const TableView& holder : team) {
        if (holder.table != nullptr) most = std::max(most, holder.table->steps_held(author).value_or(0));
      }
      if (most > 0) recovery.lacks.emplace_back(author, most);
    }
    recoveries_[static_cast<std::size_t>(node)] = std::move(recovery);
  }
}

void Flight::heal() {
  healed_ = now_;
  if (!spares_the_record(options_.faults)) excused_ = invariants_.last_tick() + 1;
  fault_ends_.clear();
  network_.heal(now_);
  for (Process& process : processes_) {
    if (!process.up) process.restart = now_;
  }
  const double bound_s = recovery_bound_s(mission_, options_.faults);
  next_check_ = now_ + seconds(bound_s);
  // Without coordinator and agents the world ends by itself, and only then the logger.
  const double cut_off_s = 2 * (mission_.timing.lockstep_timeout_s + kFarewellPatience_s);
  deadline_ = next_check_ + seconds((planned_s_ + cut_off_s + kFarewell_s) /
                                    (1 - options_.faults.clock_rate_error));
}

}  // namespace ergocast::lab
