// The control step as the leanest kernel we can write by hand: raw arrays, no blocks, no authors,
// no checks, everything in one pass over the modes, with AVX2 and fused multiply-add where the
// processor has them. What it costs is what the mathematics costs.
#pragma once

#include <array>
#include <vector>

#include "core/messages.h"
#include "core/mission.h"
#include "core/perturbation.h"

namespace ergocast::bench {

class StepFloor {
 public:
  StepFloor(const Mission& mission, int agents);

  /// The teammates' sums: all their blocks, agent after agent.
  void take(const std::vector<Contribution>& news);

  /// Agent 0's command at `x_m`; the same as Controller's but for rounding.
  Eigen::Vector2d step(Tick tick, const Eigen::Vector2d& x_m);

  /// One axis: cos(m·k·x) for every mode m, its first derivative and its second.
  struct Waves {
    using Table = std::array<double, kMaxModesPerAxis>;
    alignas(32) Table value, slope, bend;
  };
  /// The modes' tables. Rows are padded with zeros to whole vectors.
  struct Tables {
    int agents, modes, stride;
    double* sums;  ///< one table an agent, the own one first
    const double *target, *weight, *energy;
  };
  /// What one pass over the modes yields: Σ of the residual over the modes with its derivatives.
  struct Totals {
    double power = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0;
  };

 private:
  Mission mission_;
  int agents_, modes_, stride_;  // modes per axis
  std::vector<double> sums_, target_, weight_, energy_;
  std::int64_t steps_ = 0;
  Tick push_ticks_, push_ = -1;
  Eigen::Vector2d eta_{0, 0};
};

}  // namespace ergocast::bench
