// SPDX-License-Identifier: BSD-3-Clause
// When an agent that starts on a set of Proposition 1 leaves it: measured, and as predicted.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/mission/mission.h"
#include "studies/theorems/linearised.h"

namespace ergocast::studies {

/// A place on one of the sets, and a centre of contraction that lies on the set as well.
struct Start {
  std::string name;
  std::string set;  ///< as Proposition 1 writes it
  Eigen::Vector3d x_m, center_m;
};
/// A start on each set of Proposition 1, in the square of the paper's figures.
std::span<const Start> starts();

/// `mission` with one agent, at `start`.
Mission from(const Start& start, Mission mission);

/// When the mission's first agent is first farther off its set than `far_m` [s]; nothing if it is
/// not by `until_s`.
std::optional<double> escape_time_s(const Mission& mission, double far_m, double until_s);

/// The same for each seed from 1 on; infinite where it does not escape.
std::vector<double> escape_times_s(Mission mission, int seeds, double far_m, double until_s);

/// The distribution of the escape time by the linearised recursion. While the spread grows, an
/// agent's distance is its standard deviation times one number z drawn at the beginning. The agent
/// escapes when spread · |z| reaches `far_m`.
class EscapeLaw {
 public:
  /// @param spread  standard deviation of δ for σ = 1, step by step
  EscapeLaw(std::vector<double> spread, const Mission& mission, double far_m);

  /// Probability to have escaped by `t_s`.
  double probability(double t_s) const;
  /// The time by which the share `p` has escaped; infinite if that is after the last step.
  double quantile_s(double p) const;

 private:
  double dt_s_, far_m_;
  int dimensions_;
  std::vector<double> spread_m_;  // the largest so far, σ included
};

}  // namespace ergocast::studies
