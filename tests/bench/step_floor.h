// SPDX-License-Identifier: BSD-3-Clause
// The control step as a minimal kernel written by hand: raw arrays, no blocks, no authors, no
// checks. It makes one pass over the modes, with AVX2 and fused multiply-add if the processor has
// them. Its time is that of the mathematics.
#pragma once

#include <array>
#include <vector>

#include "core/law/look_ahead.h"
#include "core/law/perturbation.h"
#include "core/mission/mission.h"
#include "team/messages.h"

namespace ergocast::bench {

class StepFloor {
 public:
  StepFloor(const Mission& mission, int agents);

  /// The teammates' messages: all blocks of some of them, agent after agent.
  void take(const std::vector<Contribution>& news);

  /// Agent 0's command; all positions [m] are known if the mission requires it. Equals Agent's
  /// command except for rounding.
  Eigen::Vector3d step(Tick tick, const std::vector<Eigen::Vector3d>& places_m);

  /// One axis: cos(m·k·x) for every mode m, its first derivative and its second.
  struct Waves {
    using Table = std::array<double, kMaxModesPerAxis>;
    alignas(32) Table value, slope, bend;
  };
  /// The forecast gains of teammates.
  enum class Ahead { kNothing, kGains, kPlaces };
  /// One agent of the team.
  struct Mate {
    Waves along_x, along_y;  ///< at its position, if positions are known
    double step_s = 0;       ///< the gain of its sums at that position
    double share = 0;        ///< of the forecast
    std::int64_t steps = 0, gained_steps = 0;
    Tick tick = -1, period = 1;
  };
  /// The modes' tables. Rows are padded with zeros to whole vectors.
  struct Tables {
    int agents, modes, stride;
    double* sums;         ///< one table for each agent, the own one first
    const double* gains;  ///< likewise
    const double *target, *weight, *energy;
    const Mate* mates;  ///< the own one first
  };
  /// The result of one pass over the modes: Σ of the residual over the modes with its derivatives.
  struct Totals {
    double power = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0;
  };

 private:
  double per_second(Tick tick);
  void see(Tick tick, const std::vector<Eigen::Vector3d>& places_m);
  Totals totals(const Eigen::Vector3d& x_m, double per_second);

  Mission mission_;
  LookAhead look_ahead_;
  Ahead ahead_;
  int agents_, modes_, stride_;  // modes per axis
  std::vector<double> sums_, gains_, target_, weight_, energy_;
  std::vector<Mate> mates_;
  PerturbationScale scale_;
  Tick push_ticks_, push_ = -1;
  Eigen::Vector3d eta_{0, 0, 0};
};

}  // namespace ergocast::bench
