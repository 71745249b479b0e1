// SPDX-License-Identifier: BSD-3-Clause
// Keeps the newest changes of the target, each as numbers by slot.
#include "core/law/target_shift.h"

#include <algorithm>
#include <utility>

#include "core/mission/hold.h"

namespace ergocast {

TargetShift::TargetShift(const Mission& mission)
    : layout_(mission),
      keeps_(mission.law.history == TargetHistory::kKeep),
      plan_target_(mission.target_coefficients) {}

AlignedDoubles TargetShift::in_slots(const Coefficients& shift) const {
  AlignedDoubles slots(static_cast<std::size_t>(layout_.slot_count()));
  if (layout_.in_basis_order()) {
    std::ranges::copy(shift, slots.begin());
  } else {
    layout_.to_slots(shift.data(), slots.data());
  }
  return slots;
}

void TargetShift::note(const Amendments& list) {
  if (list.targets.empty()) return changes_.clear();  // those that were known are void
  const std::int32_t first = list.targets.front().number;
  const Tick from = counted_ticks(list.holds, list.targets.front().from);
  // A coordinator that did not know of a change names another one, possibly for an earlier tick.
  std::erase_if(changes_, [first, from](const Change& change) {
    return change.number >= first || change.from >= from;
  });
  for (const TargetChange& change : list.targets) {
    const Coefficients shift = change.target - plan_target_;
    changes_.push_back(
        {change.number, counted_ticks(list.holds, change.from), in_slots(shift), shift});
  }
  if (changes_.size() > kMostChanges)
    changes_.erase(changes_.begin(), changes_.end() - static_cast<std::ptrdiff_t>(kMostChanges));
}

const TargetShift::Change* TargetShift::at(Tick counted) const {
  const auto found =
      std::find_if(changes_.rbegin(), changes_.rend(),
                   [counted](const Change& change) { return change.from <= counted; });
  return found == changes_.rend() ? nullptr : &*found;
}

}  // namespace ergocast
