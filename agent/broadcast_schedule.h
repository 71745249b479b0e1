// When an agent speaks: at a fixed period, or as seldom as the residual allows.
//
// What is not said yet, D = S(now) − S(last said) over d seconds, changes the team's
//   c = S/T  by  Δc = (D − d c) / (T − d),  D and d counted in S and T.
// With an error budget b, silences may last while all of them together cost at most a share b of
// the residual: √(Σ λ Δc²) ≤ b φ / N for each of N agents. The next broadcast is announced in the
// present one, because a lockstep tick waits for every block that is due, so Δc is foreseen to grow
// as it did since the last one.
#pragma once

#include "core/basis.h"
#include "core/coverage_table.h"
#include "core/ids.h"
#include "core/mission.h"

namespace ergocast {

class BroadcastSchedule {
 public:
  BroadcastSchedule(const Mission& mission, const Author& self);

  /// The tick after `tick` at which to speak next; to be asked once for each broadcast.
  /// @param coverage  c as this agent knows it
  /// @param agents    members of the team, this one included
  Tick next_after(Tick tick, const CoverageTable& table, const Coefficients& coverage, int agents);

 private:
  Tick fixed_next(Tick tick) const;
  Tick affordable(Tick silent, const CoverageTable& table, const Coefficients& coverage, int agents);
  double unsaid_error(const CoverageTable& table, const Coefficients& coverage);

  Author self_;
  Basis basis_;
  double dt_s_;
  Tick shortest_, longest_, phase_;
  double budget_;
  Coefficients weights_, target_;
  std::vector<double> said_;  // own sums at the last broadcast
  Tick said_tick_ = -1, period_ = 0;
};

}  // namespace ergocast
