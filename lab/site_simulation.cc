// SPDX-License-Identifier: BSD-3-Clause
// Steps the divided team, and hands plan, roster and states to the recorder without a wire.
#include "lab/site_simulation.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "core/mission/kinds.h"
#include "lab/identity.h"
#include "plan/plan.h"

namespace ergocast::lab {
namespace {

/// No process receives what has its own incarnation.
constexpr Incarnation kRecorderStart = 1, kWorldStart = 2, kCoordinatorStart = 3;

/// Longer than a recorder waits for anything after the end.
constexpr double kAfterTheEnd_s = 10;

}  // namespace

SiteSimulation::SiteSimulation(std::span<const std::byte> plan, std::ostream& trajectory,
                               std::ostream& metrics, const LawMaker& laws)
    : team_(decode_plan_with_table(plan).value(), Edges::kReflect, laws),
      objects_(team_.mission()),
      reports_(team_.mission()),
      recorder_(simulated_run(team_.mission()), kRecorderStart, trajectory, metrics),
      from_{simulated_run(team_.mission()), kWorld, kWorldStart, 0, 0} {
  start(plan);
  publish_state();
}

/// One part has all: it passes no wire, which would limit it.
void SiteSimulation::start(std::span<const std::byte> plan) {
  MissionPart part;
  part.header = {from_.run, kCoordinator, kCoordinatorStart, 1, 0};
  part.state = MissionState::kRunning;
  part.plan.assign(plan.begin(), plan.end());
  for (std::size_t i = 0; i < team_.size(); ++i) {
    const auto id = static_cast<AgentId>(i);
    RosterEntry& entry = part.roster.emplace_back();
    entry.author = {id, identity(team_.mission(), static_cast<std::uint32_t>(i), 0)};
    entry.kind = planned_kind(team_.mission(), id);
  }
  part.content_hash = hash_of(part);
  recorder_.receive(part, Bus::kSwarm, kCoordinator, Instant{});
}

bool SiteSimulation::step() {
  if (recorder_.finished() || team_.tick() >= team_.mission().timing.tick_count) return false;
  team_.step();
  publish_state();
  record(team_.tick() < team_.mission().timing.tick_count ? 0 : kAfterTheEnd_s);
  return true;
}

void SiteSimulation::end(std::string reason) { recorder_.stop(std::move(reason)); }

/// What a world sends at this tick.
void SiteSimulation::publish_state() {
  const std::size_t size = team_.size();
  const std::size_t most = kMaxVehiclesPerState;
  WorldState state;
  state.parts = static_cast<std::int32_t>((size + most - 1) / most);
  for (; state.part < state.parts; ++state.part) {
    state.header = from_;
    state.header.sequence = ++from_.sequence;
    state.header.tick = team_.tick();
    state.vehicle_count = 0;
    const std::size_t first = static_cast<std::size_t>(state.part) * most;
    for (std::size_t i = first; i < std::min(size, first + most); ++i) {
      Vehicle& vehicle = state.add_vehicle();
      vehicle = {};
      vehicle.id = static_cast<AgentId>(i);
      vehicle.answered_tick = team_.tick() - 1;
      vehicle.position_m = team_.x_m(i);
      vehicle.velocity_mps = team_.v_mps(i);
      vehicle.detected = objects_.detected(vehicle.id, team_.tick(), team_.x_m(i));
      vehicle.reported_cell = reports_.cell(vehicle.id, team_.tick(), team_.x_m(i),
                                            vehicle.detected, objects_.places_m());
    }
    recorder_.receive(state, Bus::kWorld, kWorld, Instant{});
  }
}

/// Time passes only after the last tick.
void SiteSimulation::record(double seconds_later) {
  Outbox nobody_reads;
  recorder_.advance(Instant{}, nobody_reads);
  if (seconds_later > 0) recorder_.advance(Instant{} + seconds(seconds_later), nobody_reads);
}

}  // namespace ergocast::lab
