// SPDX-License-Identifier: BSD-3-Clause
// Gathers the numbers of study_run.h tick by tick.
#pragma once

#include <optional>
#include <vector>

#include "core/measure/objects.h"
#include "core/measure/team_measures.h"
#include "core/mission/mission.h"
#include "core/search/confirmations.h"
#include "core/search/reports.h"
#include "lab/manifolds.h"
#include "studies/study_run.h"

namespace ergocast::studies {

class StudyMeasure {
 public:
  explicit StudyMeasure(const Mission& mission);

  /// Agent `agent` was at `x_m` at `tick`; all of a tick before those of the next.
  /// @param covers  whether it does not rest
  void position(std::size_t agent, Tick tick, const Eigen::Vector3d& x_m, bool covers = true);
  /// All positions of `tick` are known.
  void pass(Tick tick) { team_.pass(tick); }
  /// One command of one agent, as its vehicle executes it.
  void command(const Eigen::Vector3d& v_mps);
  /// Whether φ² at `tick` is wanted. Then metric() has to be called for it.
  bool wants_metric(Tick tick) const { return next_ < ticks_.size() && tick >= ticks_[next_]; }
  void metric(Tick tick, double metric);

  StudyFigures figures() const;

 private:
  double t_s(Tick tick) const { return static_cast<double>(tick) * mission_.timing.dt_s; }
  double sampled_metric(Tick tick) const;
  double slope() const;

  const Mission& mission_;
  TeamMeasures team_;
  Objects objects_;
  Reports reports_;
  Confirmations confirmations_;
  Finds finds_;
  double escape_distance_m_, at_edge_m_;
  std::vector<std::optional<lab::Manifold>> manifolds_;
  std::vector<Tick> ladder_, decade_;  // first ticks at or after kLadder_s; ticks of the slope
  std::vector<Tick> ticks_;            // all at which φ² is wanted, ascending
  std::vector<double> metrics_;        // φ² at ticks_
  std::size_t next_ = 0;
  StudyFigures figures_;
  double offset2_sum_m2_ = 0, speed_sum_mps_ = 0;
  std::int64_t positions_ = 0, at_edge_ = 0, commands_ = 0;
};

}  // namespace ergocast::studies
