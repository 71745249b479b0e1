// SPDX-License-Identifier: BSD-3-Clause
// What a new target changes: samples shift, nothing else.
//
// From the tick on from which a target μ holds, an agent adds (f(x) − (μ − μ₀)) dt to its row in the
// place of f(x) dt; μ₀ is the plan's target. So c − μ₀ over all rows is the average of f − μ(t): each
// moment counts against the target of its own time. Everybody goes on comparing c with μ₀, and rows
// of any age remain right. docs/law.md has the figures.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "core/base/ids.h"
#include "core/base/line_aligned.h"
#include "core/law/block_layout.h"
#include "core/mission/amendments.h"
#include "core/mission/mission.h"

namespace ergocast {

class TargetShift {
 public:
  explicit TargetShift(const Mission& mission);

  /// Takes in the newest list. Targets that it has no more still count for the ticks before the
  /// first one that it has.
  void note(const Amendments& list);

  /// Whether any target has changed.
  bool any() const { return !changes_.empty(); }
  /// μ − μ₀ at a tick, as numbered among those that count: one number for each slot. Null if it
  /// is 0.
  const double* at(Tick counted) const;
  /// The counted tick of the newest change up to `counted`; before every tick if there is none.
  Tick newest_change(Tick counted) const;

 private:
  struct Change {
    std::int32_t number;  // of the amendment
    Tick from;            // counted
    AlignedDoubles by_slot;
  };
  /// Forecasts refer to at most so many changes.
  static constexpr std::size_t kMostChanges = 4;

  const Change* find(Tick counted) const;
  AlignedDoubles in_slots(const Coefficients& target) const;

  BlockLayout layout_;
  Coefficients plan_target_;
  std::vector<Change> changes_;  // ascending
};

}  // namespace ergocast
