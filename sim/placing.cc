// SPDX-License-Identifier: BSD-3-Clause
// Where vehicles begin, and where a restarted world finds them.
#include <algorithm>

#include "core/motion/charge.h"
#include "core/motion/filter_rules.h"
#include "core/motion/starts.h"
#include "core/motion/vehicle.h"
#include "core/motion/zones.h"
#include "sim/fleet.h"

namespace ergocast {

namespace {

/// Without a battery it is always full.
double charge_of(std::int32_t charge_ppm) {
  return charge_ppm == kNoCharge ? 1 : share_of(charge_ppm);
}

}  // namespace

void Fleet::begin(Tick tick, const StateAssembler& before, Surroundings surroundings) {
  if (filters_always()) filter_.emplace(*mission_, 0);
  if (filter_) filter_->set_zones(zones_);
  if (begins_by_state(*mission_)) {
    settle(tick, before, surroundings);
  } else {
    for (auto& [id, slot] : vehicles_) recall(id, slot, tick);
  }
  if (!physics_) return;
  for (const auto& [id, slot] : vehicles_) physics_->place(id, slot.x_m, slot.applied_mps);
}

/// Puts all bodies where they were in one state, so that they keep their distance from each other
/// and from walls. Vehicles whose agents have left are in no other message. In lockstep the
/// vehicles continue with the answers to that tick. In real time all stand: old commands were for
/// other positions.
void Fleet::settle(Tick tick, const StateAssembler& before, Surroundings surroundings) {
  const bool realtime = mission_->timing.pace == Pace::kRealtime;
  for (auto& [id, slot] : vehicles_) {
    slot.placed = false;
    if (realtime) slot.commands.stand();
  }
  for (const WorldState& state : before.states()) {
    for (const Vehicle& vehicle : state.vehicles_in_part()) {
      Slot& slot = vehicles_[vehicle.id];
      slot.x_m = vehicle.position_m;
      slot.applied_mps = vehicle.velocity_mps;
      slot.charge = charge_of(vehicle.charge_ppm);
      slot.placed = true;
    }
  }
  for (Tick past = before.newest(); past >= 0 && past < tick && !realtime; ++past) {
    for (auto& [id, slot] : vehicles_) {
      drive(id, slot, past);
      const bool keeps = !mission_->walls.empty() || any_closed(zones_, past);
      if (keeps && slot.driven(past, mission_->timing)) keep_from_walls(id, slot, past);
      move(id, slot, past);
    }
  }
  for (auto& [id, slot] : vehicles_) {
    if (slot.placed) continue;
    place(id, slot, place_for(id, surroundings));
    slot.placed = true;
  }
}

/// Computes where a slot is at tick `now` from its agent's last two commands.
void Fleet::recall(AgentId id, Slot& slot, Tick now) {
  const Tick answered = slot.commands.answered();
  if (answered < 0) return;
  slot.x_m = slot.commands.last()->position_m;
  slot.charge = charge_of(slot.commands.last()->charge_ppm);
  const Command* const before = slot.commands.before();
  if (before != nullptr && before->header.tick + 1 == answered)
    slot.applied_mps = within_speed_limit(motion_of(*mission_, id), before->velocity_mps);
  for (Tick tick = answered; tick < now; ++tick) {
    drive(id, slot, tick);
    if (any_closed(zones_, tick) && slot.driven(tick, mission_->timing))
      keep_from_walls(id, slot, tick);
    move(id, slot, tick);
  }
}

/// The position of a new vehicle: its start if that is far enough from all others, else one with
/// room that the seed chooses.
Eigen::Vector3d Fleet::place_for(AgentId id, Surroundings surroundings) const {
  if (surroundings == Surroundings::kPlanned || !keeps_distance(*mission_))
    return start_of(*mission_, id);
  const auto distance_m =
      surroundings == Surroundings::kStanding ? start_distance_m : join_distance_m;
  std::vector<Placed> others;
  for (const auto& [other, slot] : vehicles_) {
    if (other != id && slot.placed) others.push_back({other, slot.x_m});
  }
  const bool planned = static_cast<std::size_t>(id) < mission_->starts_m.size();
  const bool free = std::ranges::all_of(others, [&](const Placed& other) {
    const double apart_m = (other.position_m - start_of(*mission_, id)).norm();
    return apart_m >= distance_m(*mission_, id, other.id);
  });
  return planned && free ? start_of(*mission_, id)
                         : start_beside(*mission_, id, others, distance_m);
}

void Fleet::place(AgentId id, Slot& slot, const Eigen::Vector3d& x_m) const {
  slot.x_m = x_m;
  slot.applied_mps = first_velocity(motion_of(*mission_, id), x_m);
}

/// Filters one command by walls, zones and own limits, as filter_commands() does in lockstep.
void Fleet::keep_from_walls(AgentId id, Slot& slot, Tick tick) {
  const double limit_mps =
      limit_or_speed_mps(motion_of(*mission_, id).speed_limit_mps, slot.next_mps);
  const Mover self{id, tick, slot.x_m, limit_mps, slot.applied_mps};
  slot.next_mps = filter_->safe(self, slot.next_mps, {}).velocity_mps;
}

}  // namespace ergocast
