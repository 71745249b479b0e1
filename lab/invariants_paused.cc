// SPDX-License-Identifier: BSD-3-Clause
// Checks what holds only while the mission is paused: nothing counts, and a vehicle that has braked
// stands or loiters.
#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "core/mission/kinds.h"
#include "core/mission/station.h"
#include "core/motion/vehicle.h"
#include "lab/invariants.h"

namespace ergocast::lab {
namespace {

/// A standing unicycle shows where it looks by a velocity of 1e-9 of its limit.
constexpr double kStanding = 1e-8;

/// Whether bodies may be commanded to move apart although all stand.
bool may_give_way(const Separation& separation) {
  return separation.position_error_m > 0 || separation.disturbance_m > 0 ||
         separation.response_s > 0;
}

/// The number of ticks after a command of 0 until a vehicle stands, or moves as slowly as it can.
Tick braking_ticks(const Motion& motion, double dt_s) {
  if (motion.vehicle.kind != VehicleKind::kAcceleration) return 1;
  const double most_mps = motion.vehicle.max_acceleration_mps2 * dt_s;
  return 2 + static_cast<Tick>(std::ceil(motion.speed_limit_mps / most_mps));
}

}  // namespace

/// An agent that knows that the mission is paused wants no motion.
void Invariants::check_paused(double t_s, const Command& command) {
  const Motion motion = motion_of(mission_, command.header.sender);
  const bool stands_at_once = motion.is_point() && !may_give_way(mission_.separation);
  if (!stands_at_once || command.velocity_mps.isZero(0)) return;
  if (may_leave_a_zone(command.header.sender, command.position_m, command.header.tick)) return;
  violate(t_s, Invariant::kNobodyMovesWhilePaused, "agent " + std::to_string(command.header.sender),
          text("|v| = ", command.velocity_mps.norm(), " m/s at tick ", command.header.tick));
}

/// In lockstep all agents know of the pause. In real time commands are held, and some agents may
/// not know of it yet.
void Invariants::check_paused(double t_s, const WorldState& world) {
  const Tick tick = world.header.tick;
  if (mission_.timing.pace == Pace::kRealtime || may_give_way(mission_.separation)) return;
  for (const Hold& hold : truth_.holds()) {
    for (const Vehicle& vehicle : world.vehicles_in_part()) {
      const Motion motion = motion_of(mission_, vehicle.id);
      // The velocity is that of the step that led here.
      const Tick stands_from = hold.from + braking_ticks(motion, mission_.timing.dt_s);
      if (tick < stands_from || tick > hold.end()) continue;
      if (may_leave_a_zone(vehicle.id, vehicle.position_m, tick)) continue;
      const double speed_mps = vehicle.velocity_mps.norm();
      const double least_mps = motion.vehicle.min_speed_mps;
      const double most_mps = std::max(least_mps * (1 + 1e-9), kStanding * motion.speed_limit_mps);
      if (speed_mps <= most_mps) continue;
      violate(t_s, Invariant::kNobodyMovesWhilePaused, "vehicle " + std::to_string(vehicle.id),
              text("|v| = ", speed_mps, " m/s at tick ", tick, ", paused from tick ", hold.from));
    }
  }
}

bool Invariants::any_zone_closed_at(Tick tick) const {
  return std::ranges::any_of(zones_,
                             [tick](const auto& zone) { return zone.second.closed_at(tick); });
}

void Invariants::began(double t_s, const TableView& holder) {
  const std::int64_t steps = steps_of(*holder.table, holder.self);
  const auto [last, is_first] = own_steps_.try_emplace(holder.self, steps);
  const std::int64_t before = std::exchange(last->second, steps);
  if (is_first) return;
  // In lockstep all messages about the mission decide; in real time, what the agent knows of them.
  const bool exact = mission_.timing.pace == Pace::kLockstep;
  const std::span<const Hold> holds = exact ? std::span<const Hold>(truth_.holds()) : holder.holds;
  const Amendments* const list = exact ? &truth_.amendments() : holder.amendments;
  const bool by_plan =
      is_held(holds, holder.answered) ||
      counted_ticks(holds, holder.answered) >= covers_until(mission_, holder.self.agent, list);
  const RosterEntry* const own = entry_of(*holder.roster, holder.self);
  const bool recalled = own != nullptr && is_recalled(*own, holder);
  if (recalled && !is_held(holds, holder.answered)) ++rested_[holder.self];
  // It goes round zones, or waits. Afterwards it has the whole time again.
  if (recalled && any_zone_closed_at(holder.answered)) rested_[holder.self] = 0;
  if (!recalled) rested_.erase(holder.self);
  check_recalled_home(t_s, holder);
  const std::optional<bool> charged = this->charged(holder.self.agent, holder.answered);
  const bool idle = by_plan || recalled || (before > 0 && charged == true);
  if ((idle || (exact && recalled_in_truth(holder))) && steps > before) {
    violate(t_s, Invariant::kNothingCountsWhilePaused, name_of(holder.self),
            text("has ", steps - before, " more steps at tick ", holder.answered));
  }
  if (!idle && charged && before > 0 && steps == before) {
    violate(t_s, Invariant::kWhatIsNotPausedCounts, name_of(holder.self),
            text("has no step of tick ", holder.answered));
  }
}

}  // namespace ergocast::lab
