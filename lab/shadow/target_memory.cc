// SPDX-License-Identifier: BSD-3-Clause
// Replaces what a newer list replaces.
#include "lab/shadow/target_memory.h"

#include "core/law/target_shift.h"
#include "core/mission/hold.h"

namespace ergocast::lab {

void TargetMemory::note(const Mission& mission, const Amendments& list) {
  if (list.targets.empty()) return targets_.clear();
  const TargetChange& first = list.targets.front();
  std::erase_if(targets_, [&](const auto& known) {
    return known.first >= first.number ||
           known.second.first >= counted_ticks(list.holds, first.from);
  });
  for (const TargetChange& change : list.targets) {
    targets_[change.number] = {counted_ticks(list.holds, change.from),
                               change.target - mission.target_coefficients};
  }
  while (targets_.size() > TargetShift::kMostChanges) targets_.erase(targets_.begin());
}

Coefficients TargetMemory::shift_s(const Mission& mission, Tick counted) const {
  const bool kept = mission.law.history == TargetHistory::kKeep;
  return (kept ? 0 : mission.timing.dt_s) * change_at(mission, counted);
}

Coefficients TargetMemory::coverage_shift(const Mission& mission, Tick counted) const {
  const bool kept = mission.law.history == TargetHistory::kKeep;
  return (kept ? 1 : 0) * change_at(mission, counted);
}

Coefficients TargetMemory::change_at(const Mission& mission, Tick counted) const {
  Coefficients change = Coefficients::Zero(mission.basis.mode_count());
  for (const auto& [number, target] : targets_)
    if (target.first <= counted) change = target.second;
  return change;
}

}  // namespace ergocast::lab
