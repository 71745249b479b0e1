// SPDX-License-Identifier: BSD-3-Clause
// Checks that all vehicles stay where the last step has led them: the world takes no step after the
// end, and no agent commands one.
#include <string>

#include "lab/invariants.h"

namespace ergocast::lab {

/// Notes by which revision of the mission its end was named, by another end or a pause.
void Invariants::note_end_of(const Amendments& list) {
  if (list.ends == ends_ && list.holds == holds_) return;
  ends_ = list.ends;
  holds_ = list.holds;
  end_revision_ = truth_.revision();
}

/// In real time a world may not know the newest end yet. Another world may find a vehicle
/// elsewhere.
void Invariants::check_ended(double t_s, const WorldState& world) {
  const Tick tick = world.header.tick;
  if (world.header.incarnation != final_world_) final_places_m_.clear();
  final_world_ = world.header.incarnation;
  if (world.roster_revision < end_revision_) return;
  if (counted_ticks(truth_.holds(), tick) < ticks_of(mission_, &truth_.amendments())) return;
  for (const Vehicle& vehicle : world.vehicles_in_part()) {
    const auto [last, first] = final_places_m_.try_emplace(vehicle.id, vehicle.position_m);
    if (first || last->second == vehicle.position_m) continue;
    violate(t_s, Invariant::kNobodyMovesAfterTheEnd, "vehicle " + std::to_string(vehicle.id),
            text("is ", (vehicle.position_m - last->second).norm(),
                 " m from where the mission has ended, at tick ", tick));
  }
}

/// By the end that the agent knew when it answered the tick.
void Invariants::check_ended(double t_s, const Command& command, const TableView& speaker) {
  const auto newest = commanded_.find(speaker.self);
  const Tick tick = command.header.tick;
  if (tick < 0 || (newest != commanded_.end() && tick <= newest->second)) return;
  if (counted_ticks(speaker.holds, tick) >= ticks_of(mission_, speaker.amendments))
    commanded_after(t_s, command);
}

void Invariants::commanded_after(double t_s, const Command& command) {
  if (command.velocity_mps.isZero(0)) return;
  violate(t_s, Invariant::kNobodyMovesAfterTheEnd, "agent " + std::to_string(command.header.sender),
          text("|v| = ", command.velocity_mps.norm(), " m/s at tick ", command.header.tick));
}

}  // namespace ergocast::lab
