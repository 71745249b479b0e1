// SPDX-License-Identifier: BSD-3-Clause
// Where bodies begin, where a restarted world finds them, and what keeps them apart in real time.
#include <algorithm>

#include "core/base/geometry.h"
#include "core/motion/filter_rules.h"
#include "core/motion/starts.h"
#include "sim/world.h"

namespace ergocast {

/// Whether it has received a state with all bodies that is new enough to begin from. An agent that
/// has answered a tick knows the whole state of that tick, and sends it before the answer.
bool World::knows_bodies() const {
  Tick newest = -1;
  for (const auto& [id, slot] : vehicles_) {
    if (slot.author.incarnation != 0) newest = std::max(newest, slot.answered());
  }
  return !begins_by_state() || question_.before.newest() >= newest;
}

/// Puts all bodies where they were in one state, so that they keep their distance from each other
/// and from walls. Vehicles whose agents have left are in no other message. In lockstep the
/// vehicles continue with the answers to that tick. In real time all stand: old commands were for
/// other positions.
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

/// The position of a new body: its start if that is far enough from all others, else one with room
/// that the seed chooses. At the beginning no body moves yet, so less distance is enough.
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

/// Computes where a slot was at tick_ from its agent's last two commands.
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

/// Filters one command by walls and own limits, as filter_commands() does in lockstep.
void World::keep_from_walls(AgentId id, VehicleSlot& slot, Tick tick) {
  const double limit_mps = motion_of(mission(), id).speed_limit_mps;
  const Mover self{id, tick, slot.x_m, limit_mps, slot.applied_mps};
  slot.next_mps = filter_->safe(self, slot.next_mps, {}).velocity_mps;
}

void World::on(const WorldState& before, const Arrival&) {
  if (!question_.since || !begins_by_state()) return;
  if (before.header.tick <= me_.end_tick()) question_.before.see(before);
}

/// Filters all commands by the positions at the beginning of the step, so that the vehicles' order
/// does not matter. In lockstep agents know the other bodies, so only edges and the vehicles' own
/// limits count; points need neither. A vehicle without a command stands, or brakes.
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

// ---- a physics in the place of core/motion/vehicle.h ----

/// Makes the physics once a mission is known. False if that fails.
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

/// Moves the bodies by the physics. Agents refuse a position outside of the domain. Those that keep
/// a distance accept it, because they need the true position.
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
