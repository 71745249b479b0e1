// SPDX-License-Identifier: BSD-3-Clause
// Notes where vehicles have been, forecasts the coverage from it, and asks the controller.
#include "agent/guidance.h"

#include <algorithm>
#include <cmath>

#include "core/law/look_ahead.h"

namespace ergocast {

Guidance::Guidance(const Mission& mission, const RosterEntry& self)
    : id_(self.author.agent),
      kind_(self.kind),
      active_from_(self.active_from),
      dead_reckons_(looks_ahead(mission) && mission.dead_reckoning),
      controller_(mission, self.kind),
      foreseen_(Coefficients::Zero(mission.basis.mode_count())) {
  if (looks_ahead(mission)) forecast_.emplace(mission, self.author);
}

void Guidance::on(const WorldState& world, const RadioRange& radio, const Participant& me) {
  const Tick tick = world.header.tick;
  if (!forecast_ || tick < active_from_) return;
  // A restarted world may send the same tick with fewer vehicles: then only its parts count.
  if (tick >= parts_.tick()) {
    if (parts_.same(world)) {
      parts_.add(world);
    } else {
      parts_.begin(world);
    }
  }
  // Nothing is covered at a held tick, and no vehicle moves on before the mission continues.
  if (me.is_held(tick)) return;
  const Timing& timing = me.timing();
  const auto hold =
      static_cast<Tick>(std::max(1.0, std::ceil(timing.command_hold_s / timing.dt_s)));
  for (const Vehicle& vehicle : world.vehicles_in_part()) {
    if (!radio.receives(id_, vehicle.id)) continue;
    if (timing.pace == Pace::kRealtime && vehicle.answered_tick < tick - hold) continue;
    forecast_->see(vehicle.id, me.counted(tick), vehicle.position_m);
  }
}

void Guidance::note_law(const Mission& mission, std::span<const LawChange> laws, Tick tick) {
  controller_.set_law(law_numbers(mission, kind_, law_at(laws, tick)));
}

bool Guidance::has_state_of(Tick tick) const {
  return !dead_reckons_ || tick < active_from_ || parts_.tick() > tick || parts_.complete();
}

Eigen::Vector3d Guidance::wanted_mps(const CoverageTable& table,
                                     const std::vector<RosterEntry>& roster,
                                     const TargetShift& shift, const AgentStep& step) {
  if (forecast_) {
    forecast_->note_shift(shift);
    forecast_->note_revision(step.roster_revision);
    forecast_->look_ahead(table, roster, step.counted, foreseen_);
  } else {
    table.average(foreseen_);
  }
  const TargetShift::Change* const present = shift.of_coverage(step.counted);
  if (present != nullptr) foreseen_ -= present->by_mode;
  controller_.set_coverage(foreseen_);
  return controller_.command(id_, step.counted, step.x_m, *step.basis_at);
}

double Guidance::metric(const Coefficients& coverage, const TargetShift& shift,
                        Tick counted) const {
  const TargetShift::Change* const present = shift.of_coverage(counted);
  return controller_.metric(present != nullptr ? coverage - present->by_mode : coverage);
}

}  // namespace ergocast
