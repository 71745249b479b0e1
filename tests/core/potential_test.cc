// SPDX-License-Identifier: BSD-3-Clause
// The potential that a team with fresh rows descends, docs/law_theory.md:
//   E(x) = Σ_i ⟨S − T_a μ, f(x_i)⟩_λ + w Σ_{i<j} G(x_i, x_j),   G(x, y) = ⟨f(x), f(y)⟩_λ
// with T_a = T + (N − 1) w. Its slope in x_i is exactly T_a B_i.
#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "core/base/noise.h"
#include "core/law/control.h"
#include "core/law/forecast.h"
#include "target/target.h"

namespace ergocast {
namespace {

constexpr double kDt = 0.1;
constexpr std::uint64_t kTeams = 60;

Author author_of(std::size_t agent) { return {static_cast<AgentId>(agent), 1}; }

/// A team of 2 … 9 agents with random places at each tick; all agents know all of them.
class FreshTeam {
 public:
  explicit FreshTeam(std::uint64_t seed) : seed_(seed) {
    draw_mission();
    table_.emplace(mission_.basis, kDt);
    const auto agents = static_cast<std::size_t>(2 + 8 * number());
    last_tick_ = 1 + static_cast<Tick>(60 * number());
    for (std::size_t i = 0; i < agents; ++i) draw_life(author_of(i));
    weights_ = sobolev_weights(mission_.basis, mission_.domain);
    residual_ = Coefficients::Zero(mission_.basis.mode_count());
    table_->average(residual_);
    residual_ = covered_s() * residual_ - ahead_s() * mission_.target_coefficients;
  }

  std::size_t size() const { return x_m_.size(); }
  const std::vector<Eigen::Vector3d>& x_m() const { return x_m_; }
  double ahead_s() const { return covered_s() + (static_cast<double>(size()) - 1) * weight_s(); }

  /// E at other places than theirs, with the same coverage [s], by its formula.
  double potential(const std::vector<Eigen::Vector3d>& x_m) const {
    double sum = 0;
    for (std::size_t i = 0; i < x_m.size(); ++i) {
      const Coefficients f = basis_values(x_m[i], mission_.domain, mission_.basis);
      sum += product(residual_, f);
      for (std::size_t j = 0; j < i; ++j) {
        sum += weight_s() * product(f, basis_values(x_m[j], mission_.domain, mission_.basis));
      }
    }
    return sum;
  }

  /// E from the φ² that the team forecasts for itself: (‖S − T_a μ + wF‖² − ‖S − T_a μ‖²) / 2w less
  /// the agents' own share, w/2 Σ G(x_i, x_i), F = Σ f(x_i).
  double potential_by_metric(const std::vector<Eigen::Vector3d>& x_m) const {
    Coefficients foreseen = residual_;
    double own = 0;
    for (const Eigen::Vector3d& x : x_m) {
      const Coefficients f = basis_values(x, mission_.domain, mission_.basis);
      foreseen += weight_s() * f;
      own += product(f, f);
    }
    return (product(foreseen, foreseen) - product(residual_, residual_)) / (2 * weight_s()) -
           weight_s() / 2 * own;
  }

  /// B of an agent by the law as the agent computes it: rows, forecast, control step.
  Eigen::Vector3d b(std::size_t agent) const {
    Forecast forecast(mission_, author_of(agent));
    for (std::size_t j = 0; j < size(); ++j) {
      forecast.see(static_cast<AgentId>(j), last_tick_, x_m_[j]);
    }
    Coefficients foreseen(mission_.basis.mode_count());
    forecast.look_ahead(*table_, roster_, last_tick_, foreseen);
    Controller controller(mission_);
    controller.set_coverage(foreseen);
    controller.command(0, last_tick_, x_m_[agent],
                       BasisAt(x_m_[agent], mission_.domain, mission_.basis));
    return controller.spectral_gradient();
  }

 private:
  double number() { return uniform_pair(seed_, Purpose::kStart, 1, ++draws_).x(); }
  Eigen::Vector3d anywhere() {
    const Eigen::Vector3d share(number(), number(), 0);
    return mission_.domain.origin_m + share.cwiseProduct(mission_.domain.size_m);
  }

  void draw_mission() {
    mission_.domain = {{-50, 20, 0}, {300 + 3000 * number(), 300 + 1000 * number(), 0}};
    Basis& basis = mission_.basis;
    basis.modes_x = 2 + static_cast<int>(16 * number());
    basis.modes_y = 2 + static_cast<int>(16 * number());
    basis.normalized = number() < 0.5;
    basis.sobolev_exponent = 1 + number();
    TargetDensity target;
    target.uniform_weight = number();
    for (int bells = 0; bells < 3; ++bells) {
      const double sigma_m = 30 + 200 * number();
      target.gaussians.push_back(
          {number(), anywhere(), sigma_m * sigma_m * Eigen::Matrix3d::Identity()});
    }
    mission_.target_coefficients = target_coefficients(target, mission_.domain, basis).values;
    mission_.law.u_max_mps = 20;
    mission_.law.anticipation = 0.2 + 4 * number();
    mission_.timing.dt_s = kDt;
    mission_.dead_reckoning = number() < 0.5;
  }

  /// Its last two messages: rates come from the last tick.
  void draw_life(const Author& author) {
    CoverageTable own(mission_.basis, kDt);
    for (Tick tick = 0; tick <= last_tick_; ++tick) {
      x_m_.resize(static_cast<std::size_t>(author.agent) + 1);
      x_m_.back() = anywhere();
      own.add_sample(author, BasisAt(x_m_.back(), mission_.domain, mission_.basis));
      if (tick + 1 < last_tick_) continue;
      for (int b = 0; b < own.block_count(); ++b) {
        Contribution sent = own.block(author, b);
        sent.header.tick = tick;
        sent.next_broadcast_tick = tick + 1;
        EXPECT_EQ(table_->merge(sent, tick + 1), Merge::kNewer);
      }
    }
    roster_.push_back({author, 0, -1});
  }

  double covered_s() const { return table_->covered_s(); }
  /// For how long each teammate's gains are assumed to continue: h, and the tick that they took.
  double weight_s() const {
    return LookAhead(mission_).horizon_s(static_cast<int>(size()), 0) + kDt;
  }
  double product(const Coefficients& a, const Coefficients& b) const {
    return (weights_.array() * a.array() * b.array()).sum();
  }

  std::uint64_t seed_, draws_ = 0;
  Mission mission_;
  std::optional<CoverageTable> table_;
  std::vector<RosterEntry> roster_;
  std::vector<Eigen::Vector3d> x_m_;
  Tick last_tick_ = 0;
  Coefficients weights_, residual_;  // λ; S − T_a μ [s]
};

TEST(Potential, SlopesByEachAgentsBTimesTheTimeForeseen) {
  constexpr double kStep_m = 1e-3;
  double worst = 0;
  for (std::uint64_t seed = 1; seed <= kTeams; ++seed) {
    const FreshTeam team(seed);
    double scale = 0, error = 0;
    for (std::size_t i = 0; i < team.size(); ++i) {
      const Eigen::Vector3d expected = team.ahead_s() * team.b(i);
      for (int axis = 0; axis < 2; ++axis) {
        auto ahead_m = team.x_m(), behind_m = team.x_m();
        ahead_m[i][axis] += kStep_m;
        behind_m[i][axis] -= kStep_m;
        const double slope = (team.potential(ahead_m) - team.potential(behind_m)) / (2 * kStep_m);
        error = std::max(error, std::abs(slope - expected[axis]));
        scale = std::max(scale, std::abs(expected[axis]));
      }
    }
    worst = std::max(worst, error / scale);
  }
  EXPECT_LT(worst, 1e-6);
}

TEST(Potential, IsTheMetricThatTheTeamForeseesLessWhatEachAddsToItself) {
  for (std::uint64_t seed = 1; seed <= kTeams; ++seed) {
    const FreshTeam team(seed);
    const double expected = team.potential(team.x_m());
    EXPECT_NEAR(team.potential_by_metric(team.x_m()), expected, 1e-9 * team.ahead_s())
        << "team " << seed;
  }
}

TEST(Potential, FallsByWhatItsSlopePredictsWhenEachAgentTakesAStepAlongMinusB) {
  constexpr double kStep_m = 1e-4;
  for (std::uint64_t seed = 1; seed <= kTeams; ++seed) {
    const FreshTeam team(seed);
    auto all_m = team.x_m();
    double slope = 0;
    for (std::size_t i = 0; i < team.size(); ++i) {
      const Eigen::Vector3d b = team.b(i);
      auto alone_m = team.x_m();
      alone_m[i] -= kStep_m * b.normalized();
      all_m[i] = alone_m[i];
      slope += b.norm();
      EXPECT_LT(team.potential(alone_m), team.potential(team.x_m()))
          << "team " << seed << ", agent " << i;
    }
    const double fall = team.potential(team.x_m()) - team.potential(all_m);
    const double expected = team.ahead_s() * slope * kStep_m;
    EXPECT_NEAR(fall, expected, 0.01 * expected) << "team " << seed;
  }
}

}  // namespace
}  // namespace ergocast
