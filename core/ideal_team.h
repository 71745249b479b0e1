// SPDX-License-Identifier: BSD-3-Clause
// The method without messages: every agent knows everything at once, as in the paper's equations.
//
// What a distributed team in lockstep does that tells or knows everything each tick, bit for bit
// (tests/lab/studies/same_as_simulate_test.cc), and several times as fast: for statistics over many
// seeds.
#pragma once

#include <functional>
#include <vector>

#include "core/control.h"
#include "core/coverage_table.h"
#include "core/look_ahead.h"
#include "core/mission.h"

namespace ergocast::lab {

/// What happens to a vehicle that crosses the domain's edge.
enum class Edges {
  kReflect,
  kNone,  ///< it goes on: the paper's theorems know no edges
};

class IdealTeam {
 public:
  explicit IdealTeam(Mission mission, Edges edges = Edges::kReflect);

  /// Whether a distributed team would do the same: lockstep, all heard by all, and everything told
  /// each tick, or else known from where teammates are.
  static bool stands_for(const Mission& mission);

  /// One tick: samples, commands from the common c_k, motion. Does not allocate.
  void step();

  /// Steps up to `t_s`, calling `each` after every one.
  void run_until(
      double t_s, const std::function<void()>& each = [] {});

  const Mission& mission() const { return mission_; }
  /// Steps done, and the time they took.
  Tick tick() const { return tick_; }
  double t_s() const { return static_cast<double>(tick_) * mission_.timing.dt_s; }
  std::size_t size() const { return agents_.size(); }
  /// Where an agent is now.
  const Eigen::Vector2d& x_m(std::size_t agent) const { return agents_[agent].x_m; }
  /// Its velocity in the last step: the command, as far as the speed limit allows.
  const Eigen::Vector2d& v_mps(std::size_t agent) const { return agents_[agent].v_mps; }
  /// B of (6) in the last step.
  const Eigen::Vector2d& b(std::size_t agent) const { return agents_[agent].b; }
  /// c_k of the last step, and its φ².
  Coefficients coverage() const;
  double metric() const { return controller_.metric(coverage()); }

 private:
  struct Agent {
    Author author;
    Eigen::Vector2d x_m{0, 0}, v_mps{0, 0}, b{0, 0};
    BasisAt at;
    std::vector<double> said;   // its sums a tick ago
    std::vector<double> gain;   // since then
    std::vector<double> later;  // what all later agents will have covered
  };

  void sample();
  void look_ahead();
  void foresee(const Agent& agent);

  Mission mission_;
  Edges edges_;
  Tick tick_ = 0;
  CoverageTable table_;
  LookAhead look_ahead_;
  Coefficients coverage_;              // known or foreseen
  std::vector<double> earlier_;        // what all earlier agents will have covered
  double share_ = 0, per_second_ = 0;  // of gains, and of all
  Controller controller_;
  std::vector<Agent> agents_;
};

}  // namespace ergocast::lab
