// SPDX-License-Identifier: BSD-3-Clause
// Notes where vehicles have been, forecasts the coverage from it, and asks the controller.
#include "agent/guidance.h"

#include <algorithm>
#include <cmath>

#include "core/law/look_ahead.h"
#include "core/mission/station.h"
#include "core/motion/home.h"

namespace ergocast {

Guidance::Guidance(const Mission& mission, const RosterEntry& self, const LawMaker& laws)
    : id_(self.author.agent),
      kind_(self.kind),
      active_from_(self.active_from),
      law_(laws(mission, self.kind)),
      law_numbers_(law_numbers(mission, self.kind, nullptr)),
      needs_(law_->needs()),
      needs_state_(needs_.places || (needs_.coverage && looks_ahead(mission) &&
                                     (mission.dead_reckoning || any_battery(mission)))),
      metric_(mission),
      foreseen_(Coefficients::Zero(mission.basis.mode_count())) {
  if (needs_.coverage && looks_ahead(mission)) forecast_.emplace(mission, self.author);
}

void Guidance::on(const WorldState& world, const RadioRange& radio, const Participant& me) {
  const Tick tick = world.header.tick;
  if ((!forecast_ && !needs_.places) || tick < active_from_) return;
  // A restarted world may send the same tick with fewer vehicles: then only its parts count.
  if (tick >= parts_.tick()) {
    if (parts_.same(world)) {
      parts_.add(world);
    } else {
      parts_.begin(world);
      seen_.clear();
    }
    if (needs_.places) note_places(world, radio, me.mission().domain);
  }
  // Nothing is covered at a held tick, and no vehicle moves on before the mission continues.
  if (!forecast_ || me.is_held(tick)) return;
  const Timing& timing = me.timing();
  const auto hold =
      static_cast<Tick>(std::max(1.0, std::ceil(timing.command_hold_s / timing.dt_s)));
  for (const Vehicle& vehicle : world.vehicles_in_part()) {
    if (!radio.receives(id_, vehicle.id)) continue;
    if (timing.pace == Pace::kRealtime && vehicle.answered_tick < tick - hold) continue;
    const bool rests = charges(me.mission(), vehicle.id, vehicle.position_m, vehicle.velocity_mps);
    forecast_->see(vehicle.id, me.counted(tick), vehicle.position_m, rests);
  }
}

void Guidance::note_places(const WorldState& world, const RadioRange& radio, const Box& domain) {
  for (const Vehicle& vehicle : world.vehicles_in_part()) {
    if (!radio.receives(id_, vehicle.id)) continue;
    const TeamPlace now{vehicle.id, domain.nearest(vehicle.position_m)};
    const auto at = std::ranges::lower_bound(seen_, vehicle.id, {}, &TeamPlace::agent);
    if (at == seen_.end() || at->agent != vehicle.id) {
      seen_.insert(at, now);
    } else {
      *at = now;
    }
  }
}

void Guidance::note_amendments(const Mission& mission, const Amendments& list, Tick tick) {
  const LawNumbers numbers = law_numbers(mission, kind_, law_at(list.laws, tick));
  if (numbers != law_numbers_) law_->set_law(law_numbers_ = numbers);
  const TargetChange* const change = target_at(list.targets, tick);
  const std::int32_t number = change != nullptr ? change->number : -1;
  if (number == newest_target_) return;
  newest_target_ = number;
  const Coefficients& planned =
      mission.basis.free_domain ? mission.cosine_target : mission.target_coefficients;
  law_->set_target(change != nullptr ? change->in_cosines() : planned);
}

bool Guidance::has_state_of(Tick tick) const {
  return !needs_state_ || tick < active_from_ || parts_.tick() > tick || parts_.complete();
}

Eigen::Vector3d Guidance::wanted_mps(const CoverageTable& table, const Efforts* efforts,
                                     const std::vector<RosterEntry>& roster,
                                     const TargetShift& shift, const AgentStep& step) {
  if (needs_.team || needs_.places) set_team(roster, step);
  if (needs_.places) set_places(step);
  if (needs_.coverage) foresee(table, roster, shift, step);
  return law_->wanted_mps({id_, step.counted, step.x_m, *step.basis_at, team_, places_, efforts});
}

void Guidance::set_team(const std::vector<RosterEntry>& roster, const AgentStep& step) {
  team_.clear();
  for (const RosterEntry& entry : roster) {
    if (entry.active_at(step.counted) && !entry.recalled_at(step.roster_revision) &&
        !entry.forgotten_at(step.counted, step.roster_revision))
      team_.push_back(entry.author.agent);
  }
  std::ranges::sort(team_);
}

void Guidance::set_places(const AgentStep& step) {
  places_.clear();
  for (const AgentId agent : team_) {
    const auto at = std::ranges::lower_bound(seen_, agent, {}, &TeamPlace::agent);
    if (agent == id_) {
      places_.push_back({id_, step.x_m});
    } else if (at != seen_.end() && at->agent == agent) {
      places_.push_back(*at);
    }
  }
}

void Guidance::foresee(const CoverageTable& table, const std::vector<RosterEntry>& roster,
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
  law_->set_coverage(foreseen_);
}

double Guidance::metric(const Coefficients& coverage, const TargetShift& shift,
                        Tick counted) const {
  const TargetShift::Change* const present = shift.of_coverage(counted);
  return metric_.of(present != nullptr ? coverage - present->by_mode : coverage);
}

}  // namespace ergocast
