// SPDX-License-Identifier: BSD-3-Clause
// Passes the velocity of the law, the way home or the wall follower on to the filter.
#include "agent/safe_motion.h"

#include <algorithm>

#include "core/base/geometry.h"
#include "core/mission/station.h"
#include "core/motion/filter_rules.h"
#include "core/motion/home.h"

namespace ergocast {

void BlockedTicks::note(const SafeVelocity& safe) {
  by = safe.blocked ? safe.by : kUnassigned;
  now = safe.blocked ? now + 1 : 0;
  all += safe.blocked ? 1 : 0;
  longest = std::max(longest, now);
}

SafeMotion::SafeMotion(const Mission& mission, const Author& self, std::int64_t revision)
    : id_(self.agent),
      bodies_(mission, self, revision),
      filters_(filters_commands(mission, id_)),
      has_station_(station_of(mission, self.agent).has_value()) {
  if (filters_) separation_.emplace(mission, unguarded_hold_ticks(mission));
  if (follows_walls(mission)) wall_follower_.emplace(mission, id_);
  if (has_station_) way_home_.emplace(mission, id_);
  if (const Battery* const battery = battery_of(mission, id_))
    charge_.emplace(*battery, mission.timing.dt_s);
}

void SafeMotion::prepare_recall(const Mission& mission) {
  if (way_home_ || !home_of(mission, id_)) return;
  way_home_.emplace(mission, id_);
  way_home_->note_zones(mission, zones_in_use_);
}

bool SafeMotion::is_home(const Mission& mission, const Eigen::Vector3d& x_m) const {
  const auto home = home_of(mission, id_);
  return !home || length_of(*home - x_m) <= home_m(mission, id_);
}

void SafeMotion::on(const WorldState& world) {
  if (filters_) bodies_.on(world);
}

/// Where the mission filters no commands, a filter is made for the zones alone. It needs no hold
/// ticks, because all edges of the domain reflect.
void SafeMotion::note_zones(const std::vector<Zone>& zones, const Mission& mission) {
  if (zones == zones_) return;
  zones_ = zones;
  if (!separation_) separation_.emplace(mission, 0);
  separation_->set_zones(zones_);
}

/// A zone may close or end without a new list of zones, so the ticks are compared each time.
void SafeMotion::use_zones(Tick tick, const Mission& mission) {
  const auto in_use = [&](const Zone& zone) {
    return std::ranges::find(zones_in_use_, zone) != zones_in_use_.end();
  };
  const auto count =
      std::ranges::count_if(zones_, [&](const Zone& zone) { return zone.closed_at(tick); });
  const bool same =
      count == std::ssize(zones_in_use_) && std::ranges::all_of(zones_, [&](const Zone& zone) {
        return zone.closed_at(tick) == in_use(zone);
      });
  if (same) return;
  zones_in_use_.clear();
  for (const Zone& zone : zones_) {
    if (zone.closed_at(tick)) zones_in_use_.push_back(zone);
  }
  way_out_.reset();
  if (way_home_) way_home_->note_zones(mission, zones_in_use_);
}

/// The velocity that leads out of zones, if the vehicle must leave one.
std::optional<Eigen::Vector3d> SafeMotion::way_out_mps(const AgentStep& step,
                                                       const Participant& me) {
  if (zones_in_use_.empty()) return std::nullopt;
  const Motion motion = motion_of(me.mission(), id_);
  const StraightWay holding = holding_way(motion, step.body_m, step.body_mps);
  if (!must_leave(zones_in_use_, step.tick, me.mission(), motion, holding)) return std::nullopt;
  if (!way_out_) way_out_.emplace(me.mission(), id_, zones_in_use_);
  return way_out_->velocity_mps(step.tick, step.body_m, step.body_mps);
}

void SafeMotion::note_roster(const std::vector<RosterEntry>& roster) {
  bodies_.note_roster(roster);
  undriven_.clear();
  for (const RosterEntry& entry : roster) undriven_.push_back(entry.author.agent);
  std::ranges::sort(undriven_);
  undriven_.erase(std::unique(undriven_.begin(), undriven_.end()), undriven_.end());
  std::erase_if(undriven_, [&](AgentId id) {
    return std::ranges::any_of(roster, [&](const RosterEntry& entry) {
      return entry.author.agent == id && entry.active_until < 0;
    });
  });
  if (way_home_) way_home_->detour().begin(undriven_.size());
}

Eigen::Vector3d SafeMotion::command_mps(const Eigen::Vector3d& wanted_mps, const AgentStep& step,
                                        const Participant& me) {
  if (!zones_.empty() || !zones_in_use_.empty()) use_zones(step.tick, me.mission());
  const auto way_out = way_out_mps(step, me);
  const Eigen::Vector3d aim = way_out ? *way_out : aim_mps(wanted_mps, step, me);
  if (!filters_ && zones_in_use_.empty()) return aim;
  const SafeVelocity command = safe(aim, step, me);
  if (wall_follower_) wall_follower_->note(command.wall);
  blocked_.note(command);
  return command.velocity_mps;
}

bool SafeMotion::goes_home(const AgentStep& step) {
  if (!way_home_ || step.held) return false;
  if (charge_) {
    charge_->note(step.counted, step.charge_ppm);
    if (charge_->must_go(way_home_->needed_s(step.x_m))) return true;
  }
  return step.recalled || (has_station_ && way_home_->begun(step.counted, step.x_m));
}

/// The velocity to ask the filter for: that of the way home, or `wanted_mps`, or along a wall.
Eigen::Vector3d SafeMotion::aim_mps(const Eigen::Vector3d& wanted_mps, const AgentStep& step,
                                    const Participant& me) {
  if (goes_home(step)) {
    note_standing_bodies(mover(step, me), step, me);
    return way_home_->velocity_mps(step.body_m, step.body_mps);
  }
  if (step.recalled) return {0, 0, 0};
  if (!wall_follower_ || returns()) return wanted_mps;
  return wall_follower_->aim(step.tick, step.body_m, wanted_mps);
}

/// The way keeps twice the uncertainty from each body. Between two bodies whose uncertainties leave
/// no gap, the filter would pass slowly.
void SafeMotion::note_standing_bodies(const Mover& self, const AgentStep& step,
                                      const Participant& me) {
  if (undriven_.empty() || !keeps_distance(me.mission())) return;
  way_home_->detour().begin(undriven_.size());
  const auto others = bodies_.neighbours(step, me);
  if (!others) return;
  for (const Neighbour& other : *others) {
    if (!other.known || !std::ranges::binary_search(undriven_, other.id)) continue;
    const Eigen::Vector3d center_m =
        anchor_m(motion_of(me.mission(), other.id), other.position_m, other.velocity_mps);
    way_home_->detour().add(center_m.head<2>(), separation_->contact_m(id_, other.id) +
                                                    2 * separation_->uncertainty_m(self, other));
  }
}

Mover SafeMotion::mover(const AgentStep& step, const Participant& me) const {
  const double limit_mps = motion_of(me.mission(), id_).speed_limit_mps;
  return {id_, step.tick, step.body_m, limit_mps, step.body_mps};
}

SafeVelocity SafeMotion::safe(const Eigen::Vector3d& aim_mps, const AgentStep& step,
                              const Participant& me) {
  if (!filters_) {
    Mover self = mover(step, me);
    self.max_speed_mps = limit_or_speed_mps(self.max_speed_mps, aim_mps);
    return separation_->safe(self, aim_mps, {});
  }
  const auto others = bodies_.neighbours(step, me);
  if (!others) return {.blocked = true, .blind = true};
  return separation_->safe(mover(step, me), aim_mps, *others);
}

}  // namespace ergocast
