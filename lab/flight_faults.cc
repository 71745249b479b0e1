// SPDX-License-Identifier: BSD-3-Clause
// Crashes, freezes and cuts off simulated processes by the schedule, but never destroys all
// copies of one fact.
#include <algorithm>

#include "team/liveness.h"
#include "lab/flight.h"

namespace ergocast::lab {

void Flight::begin_incidents() {
  const double progress = progress_s();
  while (next_incident_ < incidents_.size() && incidents_[next_incident_].at_s <= progress + 1e-9) {
    begin(incidents_[next_incident_++]);
  }
}

void Flight::begin(const Incident& incident) {
  using enum Incident::Kind;
  switch (incident.kind) {
    case kSplit:
    case kOneWayCut:
      ++(incident.kind == kSplit ? figures_.splits : figures_.one_way_cuts);
      cut(incident, false);
      endings_.push_back({now_ + seconds(incident.lasts_s), incident});
      return;
    case kAgentCrash:
      figures_.agent_crashes += crash(static_cast<Seat>(incident.who), incident.lasts_s);
      return;
    case kCoordinatorCrash:
      figures_.coordinator_crashes += crash(coordinator_seat(), incident.lasts_s);
      return;
    case kWorldCrash: figures_.world_crashes += crash(world_seat(), incident.lasts_s); return;
  }
}

void Flight::cut(const Incident& incident, bool join) {
  const auto first = [&](Seat seat) { return (incident.who >> (seat % 64) & 1) != 0; };
  for (Seat from = 0; from < seats_; ++from) {
    for (Seat to = 0; to < seats_; ++to) {
      const bool deaf = incident.kind == Incident::Kind::kSplit ? first(from) != first(to)
                                                                : first(from) && !first(to);
      if (!deaf) continue;
      join ? network_.join(from, to) : network_.cut(from, to);
    }
  }
}

void Flight::end_incidents() {
  std::erase_if(endings_, [this](const Ending& ending) {
    if (ending.at > now_) return false;
    cut(ending.incident, true);
    return true;
  });
}

/// An evicted agent has ended, and tells nobody any more.
bool Flight::anybody_else_knows_the_mission(Seat but) {
  for (Seat seat = 0; seat < agents_count_; ++seat) {
    if (seat == but || !at(seat).up || agent(seat).finished()) continue;
    if (agent(seat).follower().mission()) return true;
  }
  return false;
}

/// What nobody remembers, nobody can bring back: a vehicle's position is known to the world and,
/// by its last commands, to its agent; the mission to the coordinator and the agents that follow it.
/// So these are not taken down together.
bool Flight::may_crash(Seat seat) {
  if (!at(seat).up || at(seat).life >= kMaxIncarnationsPerAgent - 2) return false;
  if (mission_over()) return false;
  const bool world_knows = at(world_seat()).up && world_->begun_at();
  if (seat < agents_count_) {
    const bool coordinator_knows = at(coordinator_seat()).up && coordinator_->mission() != nullptr;
    if (!coordinator_knows && !anybody_else_knows_the_mission(seat)) return false;
    return world_knows || invariants_.last_tick() < 0;
  }
  if (seat == coordinator_seat()) return anybody_else_knows_the_mission(kMaxSeats);
  return world_knows && std::none_of(answered_.begin(), answered_.end(),
                                     [](Tick tick) { return tick < 0; });
}

bool Flight::crash(Seat seat, double lasts_s) {
  if (!may_crash(seat)) return false;
  at(seat).up = false;
  at(seat).restart = now_ + seconds(lasts_s);
  if (seat < agents_count_) {
    answered_[static_cast<std::size_t>(seat)] = -1;
    recoveries_[static_cast<std::size_t>(seat)].reset();
  }
  return true;
}

void Flight::restart_due() {
  for (Seat seat = 0; seat < seats_; ++seat) {
    if (at(seat).up || at(seat).restart > now_) continue;
    start(seat);
    if (seat >= agents_count_) continue;
    Recovery recovery{now_, {}};
    const auto team = living();
    for (const Author& author : invariants_.authors()) {
      if (author.agent != seat) continue;
      std::int64_t most = 0;
      for (const Holder& holder : team) {
        if (holder.table != nullptr) most = std::max(most, holder.table->steps_held(author).value_or(0));
      }
      if (most > 0) recovery.lacks.emplace_back(author, most);
    }
    recoveries_[static_cast<std::size_t>(seat)] = std::move(recovery);
  }
}

void Flight::heal() {
  healed_ = now_;
  if (!spares_the_record(options_.faults)) excused_ = invariants_.last_tick() + 1;
  endings_.clear();
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
