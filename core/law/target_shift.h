// SPDX-License-Identifier: BSD-3-Clause
// What a new target changes: samples shift, nothing else.
//
// From the tick on from which a target μ holds, an agent adds (f(x) − (μ − μ₀)) dt to its row in
// the place of f(x) dt; μ₀ is the plan's target. So c − μ₀ over all rows is the average of f −
// μ(t): each moment counts against the target of its own time. Everybody goes on comparing c with
// μ₀, and rows of any age remain right. docs/law.md has the figures.
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
  };
  /// The most changes that are kept. A list has at most two targets; the older ones serve
  /// forecasts.
  static constexpr std::size_t kMostChanges = 6;

  explicit TargetShift(const Mission& mission);

  /// Takes in the newest list. Targets that it has no more still count for the ticks before the
  /// first one that it has.
  void note(const Amendments& list);

  /// Whether any target has changed.
  bool any() const { return !changes_.empty(); }
  /// Ascending by `from`.
  std::span<const Change> changes() const { return changes_; }
  /// The change whose target holds at a counted tick; null: the plan's target holds.
  const Change* at(Tick counted) const;

 private:
  AlignedDoubles in_slots(const Coefficients& target) const;

  BlockLayout layout_;
  Coefficients plan_target_;
  std::vector<Change> changes_;
};

}  // namespace ergocast
