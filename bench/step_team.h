// Agent 0 of a team, with what its teammates say at hand, for timing what it does with it.
#pragma once

#include <vector>

#include "core/control.h"
#include "core/coverage_table.h"
#include "core/mission.h"

namespace ergocast::bench {

class StepTeam {
 public:
  StepTeam(int modes_per_axis, int agents);

  const Mission& mission() const { return mission_; }
  Tick tick() const { return tick_; }
  /// Where agent 0 is at tick().
  const Eigen::Vector2d& x_m() const { return x_m_; }
  /// Every block of every teammate at tick().
  const std::vector<Contribution>& news() const { return news_; }

  /// The next tick: everybody moves; the teammates add their samples and make the news.
  void teammates_step();
  /// Agent 0 takes in the news.
  void merge_news();
  /// What agent 0 does between knowing where it is and saying how it moves.
  Eigen::Vector2d step();

 private:
  Mission mission_;
  CoverageTable own_;
  Controller controller_;
  Coefficients coverage_;
  std::vector<CoverageTable> teammates_;
  std::vector<Contribution> news_;
  Eigen::Vector2d x_m_{0, 0};
  Tick tick_ = -1;
};

}  // namespace ergocast::bench
