// SPDX-License-Identifier: BSD-3-Clause
// What a new target changes: samples shift, or with law.history KEEP the coverage; nothing else.
//
// From the tick on from which a target μ holds, an agent adds (f(x) − (μ − μ₀)) dt to its row in
// the place of f(x) dt; μ₀ is the plan's target. So c − μ₀ over all rows is the average of f −
// μ(t): each moment counts against the target of its own time. Everybody goes on comparing c with
// μ₀, and rows of any age remain right. docs/law.md has the figures.
//
// With law.history KEEP samples stay f(x) dt, and c − (μ − μ₀) is compared with μ₀ in the place of
// c: all moments count against the present target.
#pragma once

#include <cstddef>
#include <cstdint>
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
  /// A target that holds from a tick on.
  struct Change {
    std::int32_t number;     ///< of the amendment
    Tick from;               ///< as numbered among those that count
    AlignedDoubles by_slot;  ///< μ − μ₀
    Coefficients by_mode;    ///< the same
  };
  /// The most changes that are kept. A list has at most two targets; the older ones serve
  /// forecasts.
  static constexpr std::size_t kMostChanges = 6;

  explicit TargetShift(const Mission& mission);

  /// Takes in the newest list. Targets that it has no more still count for the ticks before the
  /// first one that it has.
  void note(const Amendments& list);

  /// Whether samples shift at any tick.
  bool any_of_samples() const { return !keeps_ && !changes_.empty(); }
  /// Ascending by `from`.
  std::span<const Change> changes() const { return changes_; }
  /// The change that shifts the sample of a counted tick; null: it does not shift.
  const Change* of_sample(Tick counted) const { return keeps_ ? nullptr : at(counted); }
  /// The change that shifts the coverage at a counted tick; null: it does not shift.
  const Change* of_coverage(Tick counted) const { return keeps_ ? at(counted) : nullptr; }

 private:
  /// The change whose target holds; null: the plan's target holds.
  const Change* at(Tick counted) const;
  AlignedDoubles in_slots(const Coefficients& shift) const;

  BlockLayout layout_;
  bool keeps_;
  Coefficients plan_target_;
  std::vector<Change> changes_;
};

}  // namespace ergocast
