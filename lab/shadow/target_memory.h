// SPDX-License-Identifier: BSD-3-Clause
// The targets of a mission as an agent has received them: the laboratory's own account of what
// core/law/target_shift.h keeps.
#pragma once

#include <cstdint>
#include <map>
#include <utility>

#include "core/base/ids.h"
#include "core/basis/basis.h"
#include "core/mission/amendments.h"
#include "core/mission/mission.h"

namespace ergocast::lab {

class TargetMemory {
 public:
  /// The agent has received this list. Targets that it has no more still count for earlier ticks.
  void note(const Mission& mission, const Amendments& list);

  /// Whether the plan's target has always held.
  bool empty() const { return targets_.empty(); }
  /// (μ − μ₀) dt at a tick, as numbered among those that count; 0 with law.history KEEP.
  Coefficients shift_s(const Mission& mission, Tick counted) const;
  /// What the coverage is less at a tick: μ − μ₀ with law.history KEEP, else 0.
  Coefficients coverage_shift(const Mission& mission, Tick counted) const;

 private:
  /// μ − μ₀ at a tick.
  Coefficients change_at(const Mission& mission, Tick counted) const;

  /// By the number of the amendment: the counted tick from which a target holds, and μ − μ₀.
  std::map<std::int32_t, std::pair<Tick, Coefficients>> targets_;
};

}  // namespace ergocast::lab
