// The method without processes: every agent knows everything at once, as in the paper's equations.
// tests/paper/same_as_swarm_test.cc holds it to what the distributed team does.
#pragma once

#include <algorithm>
#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core/control.h"
#include "core/coverage_table.h"
#include "core/geometry.h"
#include "core/mission.h"
#include "scenario/scenario.h"

namespace ergocast::test {

/// A shipped scenario's mission; fails loudly if the file has problems.
inline Mission shipped_mission(const std::string& name, const Overrides& overrides = {}) {
  const auto file = std::filesystem::path(ERGOCAST_SCENARIO_DIR) / (name + ".textproto");
  return std::get<Scenario>(Scenario::load(file, overrides)).mission();
}

class PaperTeam {
 public:
  explicit PaperTeam(Mission mission)
      : mission_(std::move(mission)),
        x_m_(mission_.starts_m),
        table_(mission_.basis, mission_.timing.dt_s),
        coverage_(Coefficients::Zero(mission_.basis.modes_x, mission_.basis.modes_y)),
        controllers_(x_m_.size(), Controller(mission_)) {
    v_mps_.resize(x_m_.size(), {0, 0});
    b_.resize(x_m_.size(), {0, 0});
  }

  /// One tick: samples, commands from the common c_k, motion, reflection.
  void step() {
    std::vector<BasisAt> at;
    for (std::size_t i = 0; i < x_m_.size(); ++i) {
      at.emplace_back(x_m_[i], mission_.domain, mission_.basis);
      table_.add_sample({static_cast<AgentId>(i), 1}, at.back());
    }
    table_.average(coverage_);
    for (std::size_t i = 0; i < x_m_.size(); ++i) {
      v_mps_[i] = controllers_[i].command(static_cast<AgentId>(i), tick_, x_m_[i], at[i], coverage_);
      b_[i] = controllers_[i].spectral_gradient();
    }
    for (std::size_t i = 0; i < x_m_.size(); ++i) {
      x_m_[i] = reflect(x_m_[i] + v_mps_[i] * mission_.timing.dt_s, mission_.domain);
    }
    ++tick_;
  }

  /// Steps up to `t_s`, calling `each` after every one.
  void run_until(double t_s, const std::function<void()>& each = [] {}) {
    while (static_cast<double>(tick_) * mission_.timing.dt_s < t_s - 1e-9) {
      step();
      each();
    }
  }

  const Mission& mission() const { return mission_; }
  double t_s() const { return static_cast<double>(tick_) * mission_.timing.dt_s; }
  std::size_t size() const { return x_m_.size(); }
  const Eigen::Vector2d& x_m(std::size_t agent) const { return x_m_[agent]; }
  const Eigen::Vector2d& v_mps(std::size_t agent) const { return v_mps_[agent]; }
  /// B of (6) in the last step.
  const Eigen::Vector2d& b(std::size_t agent) const { return b_[agent]; }
  const Coefficients& coverage() const { return coverage_; }
  /// φ² of the coverage up to the last step.
  double metric() const { return controllers_.front().metric(coverage_); }

 private:
  Mission mission_;
  Tick tick_ = 0;
  std::vector<Eigen::Vector2d> x_m_, v_mps_, b_;
  CoverageTable table_;
  Coefficients coverage_;
  std::vector<Controller> controllers_;
};

inline double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace ergocast::test
