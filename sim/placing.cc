// SPDX-License-Identifier: BSD-3-Clause
// Where bodies begin, where a restarted world finds them, and what keeps them apart in real time.
#include <algorithm>

#include "core/geometry.h"
#include "sim/world.h"

namespace ergocast {

/// Whether it has been told of a state in which all bodies were. Who has answered a tick knows its
/// whole state, and says it before the answer.
bool World::knows_bodies() const {
  Tick newest = -1;
  for (const auto& [id, slot] : vehicles_) {
    if (slot.author.incarnation != 0) newest = std::max(newest, slot.answered());
  }
  return !begins_by_state() || question_.before.newest() >= newest;
}

/// Puts all bodies where they were in one state, so that they keep their distance, and that to
/// walls; vehicles whose agents have left are in no other message. In lockstep they go on by the
/// answers to that tick. In real time all stand: held commands were for other places.
void World::settle() {
  const bool realtime = mission().timing.pace == Pace::kRealtime;
  for (auto& [id, slot] : vehicles_) {
    slot.placed = false;
    if (realtime && slot.command) slot.command->velocity_mps.setZero();
  }
  for (const WorldState& state : question_.before.states()) {
    for (int i = 0; i < state.vehicle_count; ++i) {
      const Vehicle& vehicle = state.vehicles[static_cast<std::size_t>(i)];
      VehicleSlot& slot = vehicles_[vehicle.id];
      slot.x_m = vehicle.position_m;
      slot.applied_mps = vehicle.velocity_mps;
      slot.placed = true;
    }
  }
  for (Tick tick = question_.before.newest(); tick >= 0 && tick < tick_ && !realtime; ++tick) {
    for (auto& [id, slot] : vehicles_) {
      drive(id, slot, tick, false);
      if (!mission().walls.empty() && driven(slot, tick, false)) keep_from_walls(id, slot, tick);
      move(id, slot, tick);
    }
  }
  for (auto& [id, slot] : vehicles_) {
    if (slot.placed) continue;
    place(id, slot, place_for(id));
    slot.placed = true;
  }
}

/// Where a new body appears: at its start if that is far enough from all others, else where the
/// seed finds room. At the beginning nobody moves yet.
Eigen::Vector3d World::place_for(AgentId id) const {
  const Mission& mission = me_.mission();
  if (!keeps_distance()) return start_of(mission, id);
  const bool begins = tick_ == 0 && !schedule_.published;
  const auto distance_m = begins ? start_distance_m : join_distance_m;
  std::vector<Placed> others;
  for (const auto& [other, slot] : vehicles_) {
    if (other != id && slot.placed) others.push_back({other, slot.x_m});
  }
  const bool planned = static_cast<std::size_t>(id) < mission.starts_m.size();
  const bool free = std::ranges::all_of(others, [&](const Placed& other) {
    const double apart_m = (other.position_m - start_of(mission, id)).norm();
    return apart_m >= distance_m(mission, id, other.id);
  });
  return planned && free ? start_of(mission, id) : start_beside(mission, id, others, distance_m);
}

/// Puts a slot where it was at tick_, by its agent's last two commands.
void World::recall(AgentId id, VehicleSlot& slot) {
  if (slot.answered() < 0) return;
  const bool realtime = mission().timing.pace == Pace::kRealtime;
  slot.x_m = slot.command->position_m;
  const bool in_a_row =
      slot.command_before && slot.command_before->header.tick + 1 == slot.answered();
  if (in_a_row) {
    slot.applied_mps =
        within_speed_limit(motion_of(mission(), id), slot.command_before->velocity_mps);
  }
  for (Tick tick = slot.answered(); tick < tick_; ++tick) {
    drive(id, slot, tick, realtime);
    move(id, slot, tick);
  }
}

/// As filter_commands() in lockstep.
void World::keep_from_walls(AgentId id, VehicleSlot& slot, Tick tick) {
  const double limit_mps = motion_of(mission(), id).speed_limit_mps;
  const Mover self{id, tick, slot.x_m, limit_mps, slot.applied_mps};
  slot.next_mps = filter_->safe(self, slot.next_mps, {}).velocity_mps;
}

void World::on(const WorldState& before, const Arrival&) {
  if (!question_.since || !begins_by_state()) return;
  if (before.header.tick <= me_.end_tick()) question_.before.see(before);
}

/// All vehicles by where all of them are, so that their order does not count. In lockstep only by
/// edges and their own limits, which points do not need: agents know the rest. Who is not driven
/// stands, or brakes.
void World::filter_commands() {
  const bool guards = world_guards(mission());
  bodies_.clear();
  for (const auto& [id, slot] : vehicles_) {
    const double limit_mps = motion_of(mission(), id).speed_limit_mps;
    if (guards) bodies_.push_back({id, slot.x_m, limit_mps, 0, true, slot.applied_mps});
  }
  for (auto& [id, slot] : vehicles_) {
    const Motion motion = motion_of(mission(), id);
    if (!driven(slot, tick_, true) || (motion.is_point() && !filters_again(mission()))) continue;
    const Mover self{id, tick_, slot.x_m, motion.speed_limit_mps, slot.applied_mps};
    slot.next_mps = filter_->safe(self, slot.next_mps, bodies_).velocity_mps;
  }
}

// ---- a physics in the place of core/vehicle.h ----

/// Once a mission is known. False: there is none for it.
bool World::make_physics() {
  if (!physics_maker_ || physics_) return true;
  auto made = physics_maker_(mission());
  if (auto* problem = std::get_if<std::string>(&made)) {
    no_physics_ = true;
    finish(std::move(*problem));
    return false;
  }
  physics_ = std::move(std::get<0>(made));
  return true;
}

void World::place_bodies() {
  if (!physics_) return;
  for (const auto& [id, slot] : vehicles_) physics_->place(id, slot.x_m, slot.applied_mps);
}

/// By the physics. Agents refuse a place outside of the domain, unless they keep a distance: then
/// they need the true one.
void World::move_bodies() {
  moved_.clear();
  for (const auto& [id, slot] : vehicles_) moved_.push_back({id, slot.next_mps});
  physics_->pass_tick(moved_);
  for (const PhysicalBody& body : moved_) {
    VehicleSlot& slot = vehicles_.at(body.id);
    slot.x_m = keeps_distance() ? body.position_m : mission().domain.nearest(body.position_m);
    slot.applied_mps = body.velocity_mps;
  }
}

}  // namespace ergocast
