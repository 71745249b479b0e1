// SPDX-License-Identifier: BSD-3-Clause
// The claims of docs/law_theory.md about the law that looks ahead, on moving teams: the potential
// in time, Proposition 1 for symmetric teams, and boundedness.
#include <gtest/gtest.h>

#include <cmath>

#include "core/base/noise.h"
#include "core/law/look_ahead.h"
#include "studies/theorems/invariance.h"
#include "target/target.h"
#include "tests/support/simulated_team.h"

namespace ergocast::test {
namespace {

/// Without noise and contraction, under the input (8) alone.
Mission noiseless(Mission mission, double epsilon) {
  mission.law = {.u_max_mps = mission.law.u_max_mps,
                 .regularization = Regularization::kRelative,
                 .epsilon = epsilon,
                 .anticipation = 2};
  return mission;
}

// ---- the potential in time ----

/// E and its parts for a moving team, from the places of its agents.
class BusObserver {
 public:
  explicit BusObserver(const Mission& mission)
      : mission_(mission),
        weights_(sobolev_weights(mission.basis, mission.domain)),
        sums_(Coefficients::Zero(mission.basis.mode_count())) {
    const double n = static_cast<double>(mission.starts_m.size());
    weight_s_ = LookAhead(mission).horizon_s(static_cast<int>(n), 0) + mission.timing.dt_s;
  }

  /// Adds one step of all agents at their places.
  void sample(const lab::IdealTeam& team) {
    for (const Coefficients& f : values(team)) sums_ += mission_.timing.dt_s * f;
    covered_s_ += mission_.timing.dt_s * static_cast<double>(team.size());
  }

  double ahead_s(const lab::IdealTeam& team) const {
    return covered_s_ + (static_cast<double>(team.size()) - 1) * weight_s_;
  }

  double potential(const lab::IdealTeam& team) const {
    const auto f = values(team);
    const Coefficients residual = sums_ - ahead_s(team) * mission_.target_coefficients;
    double sum = 0;
    for (std::size_t i = 0; i < f.size(); ++i) {
      sum += product(residual, f[i]);
      for (std::size_t j = 0; j < i; ++j) sum += weight_s_ * product(f[i], f[j]);
    }
    return sum;
  }

  /// ⟨F − Nμ, F⟩: the change by time alone, independent of the motion.
  double inflow(const lab::IdealTeam& team) const {
    Coefficients all = Coefficients::Zero(sums_.size());
    for (const Coefficients& f : values(team)) all += f;
    return product(all - static_cast<double>(team.size()) * mission_.target_coefficients, all);
  }

 private:
  std::vector<Coefficients> values(const lab::IdealTeam& team) const {
    std::vector<Coefficients> f;
    for (std::size_t i = 0; i < team.size(); ++i) {
      f.push_back(basis_values(team.x_m(i), mission_.domain, mission_.basis));
    }
    return f;
  }
  double product(const Coefficients& a, const Coefficients& b) const {
    return (weights_.array() * a.array() * b.array()).sum();
  }

  Mission mission_;
  Coefficients weights_, sums_;
  double weight_s_, covered_s_ = 0;
};

TEST(LookingAhead, ThePotentialFallsByTheTeamsDescentAndRisesByWhatTimeAdds) {
  // dE/dt = T_a Σ_i B_i·u_i + ⟨F − Nμ, F⟩: exact except for the step, so the error falls with the
  // step.
  double worst[2];
  for (const int finer : {0, 1}) {
    Mission mission = noiseless(shipped_mission("quadrimodal_corners"), 0.2);
    mission.starts_m = {
        {310, 420, 0}, {900, 1500, 0}, {1333, 222, 0}, {1700, 1650, 0}, {1000, 930, 0}};
    mission.timing.dt_s = finer ? 1e-3 : 1e-2;
    PaperTeam team(mission, lab::Edges::kNone);
    BusObserver observer(mission);
    double error = 0, scale = 0;
    for (double t_s = 0; t_s < 20; t_s += mission.timing.dt_s) {
      observer.sample(team);
      const double before = observer.potential(team), inflow = observer.inflow(team);
      const double ahead_s = observer.ahead_s(team);
      team.step();
      double descent = 0;
      for (std::size_t i = 0; i < team.size(); ++i)
        descent += ahead_s * team.b(i).dot(team.v_mps(i));
      ASSERT_LE(descent, 0);
      // One more step: the next sample's contribution is included.
      BusObserver next = observer;
      next.sample(team);
      const double rate = (next.potential(team) - before) / mission.timing.dt_s;
      error = std::max(error, std::abs(rate - descent - inflow));
      scale = std::max(scale, std::abs(descent) + std::abs(inflow));
    }
    worst[finer] = error / scale;
  }
  EXPECT_LT(worst[1], 0.01);
  EXPECT_LT(worst[1], 0.2 * worst[0]) << "of the order of the step";
}

// ---- Proposition 1 ----

/// A reflection of the square.
struct Mirror {
  const char* name;
  Eigen::Vector3d (*image)(const Eigen::Vector3d& x_m, double side_m);
};
const Mirror kMirrors[] = {
    {"midline x",
     [](const Eigen::Vector3d& x, double side) { return Eigen::Vector3d(side - x.x(), x.y(), 0); }},
    {"midline y",
     [](const Eigen::Vector3d& x, double side) { return Eigen::Vector3d(x.x(), side - x.y(), 0); }},
    {"diagonal", [](const Eigen::Vector3d& x, double) { return Eigen::Vector3d(x.y(), x.x(), 0); }},
    {"antidiagonal", [](const Eigen::Vector3d& x,
                        double side) { return Eigen::Vector3d(side - x.y(), side - x.x(), 0); }},
};

TEST(LookingAhead, AMirroredTeamStaysMirroredAndItsAgentsOnTheMirrorStayOnIt) {
  for (const Mirror& mirror : kMirrors) {
    for (std::uint64_t place = 1; place <= 20; ++place) {
      Mission mission = noiseless(shipped_mission("quadrimodal_corners"), 0.2);
      const double side_m = mission.domain.size_m.x();
      const auto anywhere = [&](std::uint32_t who) -> Eigen::Vector3d {
        return on_ground(side_m * uniform_pair(place, Purpose::kStart, who, 0));
      };
      const Eigen::Vector3d one = anywhere(0), two = anywhere(1), aside = anywhere(2);
      mission.starts_m = {one, mirror.image(one, side_m), two, mirror.image(two, side_m),
                          0.5 * (aside + mirror.image(aside, side_m))};
      PaperTeam team(mission);
      // The first deviation is rounding; it grows with time, as under the classical law.
      team.run_until(5, [&] {
        for (const std::size_t i : {0U, 2U}) {
          ASSERT_LT((team.x_m(i + 1) - mirror.image(team.x_m(i), side_m)).norm(), 1e-6)
              << mirror.name << ", place " << place << ", t = " << team.t_s();
        }
        ASSERT_LT((team.x_m(4) - mirror.image(team.x_m(4), side_m)).norm(), 1e-6)
            << mirror.name << ", place " << place << ", t = " << team.t_s();
      });
      EXPECT_GT((team.x_m(0) - one).norm(), 1) << "it moves";
    }
  }
}

TEST(LookingAhead, TheAxesHoldAnyTeamExactly) {
  Mission mission = noiseless(shipped_mission("quadrimodal_corners"), 0.2);
  mission.starts_m = {{700, 0, 0}, {0, 1234.5, 0}, {321, 1777, 0}, {0, 0, 0}};
  PaperTeam team(mission);
  team.run_until(60, [&team] {
    ASSERT_EQ(team.x_m(0).y(), 0);
    ASSERT_EQ(team.x_m(1).x(), 0);
    ASSERT_EQ(team.x_m(3), Eigen::Vector3d(0, 0, 0));
  });
}

TEST(LookingAhead, AgentsAtOnePlaceStayTogetherWithoutNoise) {
  Mission mission = noiseless(shipped_mission("quadrimodal_corners"), 0.2);
  mission.starts_m = {{700, 811, 0}, {700, 811, 0}, {1500, 300, 0}};
  PaperTeam team(mission);
  team.run_until(5, [&team] { ASSERT_LT((team.x_m(0) - team.x_m(1)).norm(), 1e-6); });
  EXPECT_GT((team.x_m(0) - mission.starts_m[0]).norm(), 1);
}

TEST(LookingAhead, WithoutTheMirrorsPremiseAnAgentLeavesIt) {
  Mission mission = noiseless(shipped_mission("quadrimodal_corners"), 0.2);
  mission.starts_m = {{1000, 700, 0}, {321, 1777, 0}};
  PaperTeam team(mission);
  team.run_until(5);
  EXPECT_GT(std::abs(team.x_m(0).x() - 1000), 1);
}

// ---- boundedness ----

TEST(LookingAhead, NoInputExceedsItsLimitAndEveryStepKeepsCorollary1) {
  // Only ‖u‖ ≤ u_max matters, not the forecast: ‖x_n − c‖ ≤ qⁿ ‖x_0 − c‖ + (u_max/k)(1 − qⁿ).
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    Mission mission = noiseless(shipped_mission("quadrimodal_corners"), 0.05);
    const double k = mission.law.contraction_gain_per_s = 0.5;
    const Eigen::Vector3d center_m = mission.law.contraction_center_m = mission.domain.center_m();
    mission.law.anticipation = 0.1 * static_cast<double>(seed);
    mission.starts_m.clear();
    for (std::uint32_t i = 0; i < 5; ++i) {
      mission.starts_m.push_back(on_ground(2000 * uniform_pair(seed, Purpose::kStart, i, 0)));
    }
    PaperTeam team(mission, lab::Edges::kNone);
    const double q = 1 - k * mission.timing.dt_s;
    std::vector<Eigen::Vector3d> x_m = mission.starts_m;
    std::vector<double> bound_m;
    for (const Eigen::Vector3d& start_m : mission.starts_m)
      bound_m.push_back((start_m - center_m).norm());
    team.run_until(60, [&] {
      for (std::size_t i = 0; i < team.size(); ++i) {
        const Eigen::Vector3d u_mps = team.v_mps(i) + k * (x_m[i] - center_m);
        ASSERT_LE(u_mps.norm(), mission.law.u_max_mps * (1 + 1e-12));
        bound_m[i] = q * bound_m[i] + mission.law.u_max_mps * mission.timing.dt_s;
        x_m[i] = team.x_m(i);
        ASSERT_LE((x_m[i] - center_m).norm(), bound_m[i] * (1 + 1e-12));
      }
    });
  }
}

}  // namespace
}  // namespace ergocast::test
