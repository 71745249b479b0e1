#include "agent/broadcast_schedule.h"

#include <algorithm>
#include <cmath>

namespace ergocast {

BroadcastSchedule::BroadcastSchedule(const Mission& mission, const Author& self)
    : self_(self),
      basis_(mission.basis),
      dt_s_(mission.timing.dt_s),
      shortest_(mission.timing.broadcast_period_ticks),
      longest_(mission.timing.broadcast_heartbeat_ticks),
      budget_(mission.timing.broadcast_error_budget),
      weights_(sobolev_weights(mission.basis, mission.domain)),
      target_(mission.target_coefficients) {
  const Tick team = std::max<Tick>(1, static_cast<Tick>(mission.starts_m.size()));
  phase_ = self.agent * shortest_ / team % shortest_;
  said_.resize(static_cast<std::size_t>(basis_.mode_count()));
}

Tick BroadcastSchedule::fixed_next(Tick tick) const {
  const Tick since = ((tick - phase_) % shortest_ + shortest_) % shortest_;
  return tick + shortest_ - since;
}

Tick BroadcastSchedule::next_after(Tick tick, const CoverageTable& table,
                                   const Coefficients& coverage, int agents) {
  if (budget_ <= 0) return fixed_next(tick);
  const Tick next =
      said_tick_ < 0 ? fixed_next(tick)
                     : tick + affordable(tick - said_tick_, table, coverage, agents);
  period_ = next - tick;
  said_tick_ = tick;
  std::copy_n(table.sums_of(self_), said_.size(), said_.begin());
  return next;
}

/// How long to be silent after a silence of `silent` ticks.
Tick BroadcastSchedule::affordable(Tick silent, const CoverageTable& table,
                                   const Coefficients& coverage, int agents) {
  // Doubling at most: the next stretch may not be like the last.
  const Tick most = std::max(shortest_, std::min(longest_, 2 * period_));
  const double error = unsaid_error(table, coverage);
  const double allowed = budget_ * std::sqrt(ergodic_metric(coverage, target_, weights_)) / agents;
  if (error * static_cast<double>(most) <= allowed * static_cast<double>(silent)) return most;
  return std::max(shortest_, static_cast<Tick>(allowed / error * static_cast<double>(silent)));
}

double BroadcastSchedule::unsaid_error(const CoverageTable& table, const Coefficients& coverage) {
  const double* sums = table.sums_of(self_);
  const double unsaid_s = sums[0] - said_[0];  // S_00 is the time covered
  const double known_s = table.covered_s() - unsaid_s;
  if (known_s <= 0) return 0;
  double squares = 0;
  for (int k = 0; k < basis_.mode_count(); ++k) {
    const auto at = static_cast<std::size_t>(k);
    const double change = (sums[k] - said_[at] - unsaid_s * coverage.data()[k]) / known_s;
    squares += weights_.data()[k] * change * change;
  }
  return std::sqrt(squares);
}

}  // namespace ergocast
