// SPDX-License-Identifier: BSD-3-Clause
// Counts the ticks of each node that are left.
#include "lab/studies/plans/plan_setting.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace ergocast::studies {

PlanClock::PlanClock(const Mission& mission, const PlanSetting& setting)
    : dt_s_(mission.timing.dt_s),
      node_ticks_(std::llround(setting.node_s / dt_s_)),
      last_tick_(mission.law.ends_with_plan ? mission.timing.tick_count - 1
                                            : std::numeric_limits<Tick>::max()) {
  const double ticks = setting.node_s / dt_s_;
  if (node_ticks_ < 1 || std::abs(ticks - static_cast<double>(node_ticks_)) > 1e-6) {
    throw std::runtime_error("a node must last for a number of whole ticks");
  }
}

void PlanClock::remaining_s(Tick tick, std::vector<double>& durations_s) const {
  Tick from = tick;
  for (double& duration_s : durations_s) {
    const Tick end = std::min((from / node_ticks_ + 1) * node_ticks_, last_tick_);
    duration_s = static_cast<double>(std::max<Tick>(0, end - from)) * dt_s_;
    from = std::max(from, end);
  }
}

}  // namespace ergocast::studies
