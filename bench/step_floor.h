// The control step as the leanest straightforward kernel on raw arrays: no blocks, no authors, no
// checks, one pass over the modes. What it costs is what the mathematics costs.
#pragma once

#include <vector>

#include "core/messages.h"
#include "core/mission.h"

namespace ergocast::bench {

class StepFloor {
 public:
  StepFloor(const Mission& mission, int agents);

  /// The teammates' sums: all their blocks, agent after agent.
  void take(const std::vector<Contribution>& news);

  /// Agent 0's command at `x_m`; the same as Controller's but for rounding.
  Eigen::Vector2d step(Tick tick, const Eigen::Vector2d& x_m);

 private:
  Mission mission_;
  int agents_, modes_;  // modes per axis
  std::vector<double> sums_;  // one table an agent, the own one first
  std::vector<double> target_, weight_, energy_;
  std::int64_t steps_ = 0;
};

}  // namespace ergocast::bench
