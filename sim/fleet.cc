// SPDX-License-Identifier: BSD-3-Clause
// Follows the roster, and moves each vehicle by its agent's command in force.
#include "sim/fleet.h"

#include <algorithm>

#include "core/base/geometry.h"
#include "core/mission/station.h"
#include "core/motion/charge.h"
#include "core/motion/filter_rules.h"
#include "core/motion/home.h"
#include "core/motion/push.h"
#include "core/motion/vehicle.h"
#include "core/motion/zones.h"

namespace ergocast {

// ---- members ----

void Fleet::take_roster(const std::vector<RosterEntry>& roster, Surroundings surroundings) {
  for (const RosterEntry& entry : roster) {
    const auto known = vehicles_.find(entry.author.agent);
    if (entry.active_until < 0 || known == vehicles_.end()) continue;
    if (known->second.author == entry.author) known->second.author.incarnation = 0;
  }
  for (const RosterEntry& entry : roster) {
    if (entry.active_until >= 0) continue;
    const AgentId id = entry.author.agent;
    const auto [at, is_new] = vehicles_.try_emplace(id);
    Slot& slot = at->second;
    if (is_new) {
      place(id, slot, place_for(id, surroundings));
      if (physics_ && surroundings != Surroundings::kPlanned)
        physics_->place(id, slot.x_m, slot.applied_mps);
    }
    if (slot.author != entry.author) slot.commands.clear();
    slot.author = entry.author;
  }
}

CommandHistory* Fleet::commands_of(const Header& sender) {
  const auto at = vehicles_.find(sender.sender);
  if (at == vehicles_.end() || at->second.author.incarnation != sender.incarnation) return nullptr;
  return &at->second.commands;
}

std::optional<Tick> Fleet::newest_answer() const {
  std::optional<Tick> newest;
  for (const auto& [id, slot] : vehicles_) {
    if (slot.commands.last() == nullptr) continue;
    newest = std::max(newest, std::optional(slot.commands.answered()));
  }
  return newest;
}

Tick Fleet::newest_answer_of_members() const {
  Tick newest = -1;
  for (const auto& [id, slot] : vehicles_) {
    if (slot.has_driver()) newest = std::max(newest, slot.commands.answered());
  }
  return newest;
}

bool Fleet::everyone_answered(Tick tick) const {
  bool any = false;
  for (const auto& [id, slot] : vehicles_) {
    if (!slot.has_driver()) continue;
    if (slot.commands.answered() != tick) return false;
    any = true;
  }
  return any;
}

int Fleet::late_members(Tick tick) const {
  return static_cast<int>(std::ranges::count_if(vehicles_, [&](const auto& one) {
    return one.second.has_driver() && one.second.commands.answered() < tick;
  }));
}

AgentId Fleet::first_unheard() const {
  for (const auto& [id, slot] : vehicles_) {
    if (slot.has_driver() && slot.commands.before() == nullptr) return id;
  }
  return kUnassigned;
}

bool Fleet::filters_always() const { return filters_again(*mission_) || any_but_points(*mission_); }

void Fleet::take_zones(const std::vector<Zone>& zones) {
  if (zones == zones_) return;
  zones_ = zones;
  if (!filter_) filter_.emplace(*mission_, 0);
  filter_->set_zones(zones_);
}

// ---- moving ----

void Fleet::step(Tick tick) {
  for (auto& [id, slot] : vehicles_) {
    drive(id, slot, tick);
    if (slot.driven(tick, mission_->timing) && slot.next_mps != slot.commands.last()->velocity_mps)
      ++clamped_commands_;
  }
  if (filter_ && (filters_always() || any_closed(zones_, tick))) filter_commands(tick);
  if (physics_) return move_bodies();
  for (auto& [id, slot] : vehicles_) move(id, slot, tick);
}

void Fleet::stop() {
  for (auto& [id, slot] : vehicles_) slot.applied_mps = slot.next_mps = {0, 0, 0};
  if (physics_) move_bodies();
}

void Fleet::use_batteries() {
  for (auto& [id, slot] : vehicles_) {
    const Battery* const battery = battery_of(*mission_, id);
    if (battery == nullptr) continue;
    const double apart_m = length_of(*station_of(*mission_, id) - slot.x_m);
    slot.charge =
        share_after(*battery, slot.charge, apart_m <= home_m(*mission_, id), mission_->timing.dt_s);
  }
}

void Fleet::drive(AgentId id, Slot& slot, Tick tick) const {
  const Eigen::Vector3d wanted_mps = slot.has_driver() && slot.charge > 0
                                         ? slot.commands.velocity_mps(tick, mission_->timing)
                                         : Eigen::Vector3d(0, 0, 0);
  slot.next_mps = executed(motion_of(*mission_, id), slot.applied_mps, wanted_mps);
}

void Fleet::move(AgentId id, Slot& slot, Tick tick) const {
  const Eigen::Vector3d mean_mps =
      mean_velocity(motion_of(*mission_, id), slot.applied_mps, slot.next_mps);
  slot.x_m = reflect(moved(*mission_, id, tick, slot.x_m, mean_mps, {zones_, slot.next_mps}),
                     mission_->domain);
  slot.applied_mps = slot.next_mps;
}

/// Filters all commands by the positions at the beginning of the step, so that the vehicles' order
/// does not matter. In lockstep agents know the other bodies, so only edges and the vehicles' own
/// limits count; points need neither, unless a zone is closed. A vehicle without a command stands,
/// or brakes.
void Fleet::filter_commands(Tick tick) {
  const bool guards = world_guards(*mission_);
  bodies_.clear();
  for (const auto& [id, slot] : vehicles_) {
    const double limit_mps = motion_of(*mission_, id).speed_limit_mps;
    if (guards) bodies_.push_back({id, slot.x_m, limit_mps, 0, true, slot.applied_mps});
  }
  for (auto& [id, slot] : vehicles_) {
    const Motion motion = motion_of(*mission_, id);
    const bool as_wanted =
        motion.is_point() && !filters_again(*mission_) && !any_closed(zones_, tick);
    if (!slot.driven(tick, mission_->timing) || as_wanted) continue;
    const double limit_mps = limit_or_speed_mps(motion.speed_limit_mps, slot.next_mps);
    const Mover self{id, tick, slot.x_m, limit_mps, slot.applied_mps};
    slot.next_mps = filter_->safe(self, slot.next_mps, bodies_).velocity_mps;
  }
}

/// Moves the bodies by the physics. Agents refuse a position outside of the domain. Those that keep
/// a distance accept it, because they need the true position.
void Fleet::move_bodies() {
  moved_.clear();
  for (const auto& [id, slot] : vehicles_) moved_.push_back({id, slot.next_mps});
  physics_->pass_tick(moved_);
  for (const PhysicalBody& body : moved_) {
    Slot& slot = vehicles_.at(body.id);
    slot.x_m =
        keeps_distance(*mission_) ? body.position_m : mission_->domain.nearest(body.position_m);
    slot.applied_mps = body.velocity_mps;
  }
}

std::vector<WorldState> Fleet::snapshot(Tick tick) {
  const auto parts = std::max<std::size_t>(
      1, (vehicles_.size() + kMaxVehiclesPerState - 1) / kMaxVehiclesPerState);
  std::vector<WorldState> states(parts);
  for (std::size_t part = 0; part < parts; ++part) {
    states[part].part = static_cast<std::int32_t>(part);
    states[part].parts = static_cast<std::int32_t>(parts);
  }
  std::size_t i = 0;
  for (const auto& [id, slot] : vehicles_) {
    Vehicle& vehicle = states[i++ / kMaxVehiclesPerState].add_vehicle();
    vehicle.id = id;
    vehicle.answered_tick = slot.commands.answered();
    vehicle.position_m = slot.x_m;
    vehicle.velocity_mps = slot.applied_mps;
    vehicle.detected = objects_.detected(id, tick, slot.x_m);
    vehicle.reported_cell =
        reports_.cell(id, tick, slot.x_m, vehicle.detected, objects_.places_m());
    if (battery_of(*mission_, id) != nullptr) vehicle.charge_ppm = charge_ppm_of(slot.charge);
  }
  return states;
}

std::optional<std::string> Fleet::learn(const Mission& mission) {
  if (!mission_) {
    mission_ = mission;
    objects_ = Objects(mission);
    reports_ = Reports(mission);
  }
  if (!physics_maker_ || physics_) return {};
  auto made = physics_maker_(mission);
  if (!made) return made.error();
  physics_ = *std::move(made);
  return {};
}

}  // namespace ergocast
