// SPDX-License-Identifier: BSD-3-Clause
// Properties of the command, one term at a time: where the gradient vanishes, with either ε, noise,
// contraction, and under a symmetric target.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "tests/core/uneven_mission.h"

namespace ergocast {
namespace {

// ---- where the gradient vanishes ----

TEST(Command, OfTheClassicalLawIsExactlyZeroAtTheOriginsCorner) {
  // Every slope is exactly 0 there; 0/0 would poison the team.
  Mission mission = uneven_mission();
  Controller controller(mission);
  const Coefficients coverage = coverage_of(mission, 5);
  EXPECT_EQ(command_at(controller, mission, mission.domain.origin_m, coverage),
            Eigen::Vector3d(0, 0, 0));
}

TEST(Command, OfAnyLawIsExactlyZeroWhereNothingIsLeftToDo) {
  for (const Regularization how : {Regularization::kAbsolute, Regularization::kRelative}) {
    for (const double epsilon : {0.0, 0.2}) {
      Mission mission = uneven_mission();
      mission.law.regularization = how;
      mission.law.epsilon = epsilon;
      Controller controller(mission);
      const Eigen::Vector3d v =
          command_at(controller, mission, {100, 600, 0}, mission.target_coefficients);
      EXPECT_EQ(v, Eigen::Vector3d(0, 0, 0)) << epsilon;
      EXPECT_EQ(controller.metric(mission.target_coefficients), 0);
    }
  }
}

TEST(Command, NextToAnEdgeIsFiniteHoweverClose) {
  Mission mission = uneven_mission();
  mission.domain.origin_m = {0, 0, 0};
  Controller controller(mission);
  const Coefficients coverage = coverage_of(mission, 5);
  for (const double tiny : {1e-13, 1e-100, 1e-300, 1e-306, 1e-308, 1e-312, kTiniest}) {
    for (const Eigen::Vector3d& x_m : {Eigen::Vector3d(tiny, 0, 0), Eigen::Vector3d(0, tiny, 0),
                                       Eigen::Vector3d(tiny, tiny, 0)}) {
      const Eigen::Vector3d v = command_at(controller, mission, x_m, coverage);
      EXPECT_TRUE(v.allFinite()) << tiny;
      EXPECT_LE(v.norm(), 12 * 1.5) << tiny;  // the last denormals round by half of themselves
    }
  }
}

// ---- ε ----

TEST(RelativeEpsilon, KeepsTheInputAsTheResidualShrinksWhereAnAbsoluteOneThrottlesIt) {
  Mission mission = uneven_mission();
  const Coefficients residual = coverage_of(mission, 30) - mission.target_coefficients;
  const auto speed = [&](Regularization how, double epsilon, double scale) {
    mission.law.regularization = how;
    mission.law.epsilon = epsilon;
    Controller controller(mission);
    // Powers of two, so that scaling rounds nothing in the residual beyond μ's own bits.
    const Coefficients coverage = mission.target_coefficients + scale * residual;
    return command_at(controller, mission, {100, 600, 0}, coverage).norm();
  };
  const double full = speed(Regularization::kRelative, 0.2, 1);
  // c − μ keeps 53 − 20 of its bits.
  EXPECT_NEAR(speed(Regularization::kRelative, 0.2, 0x1p-20), full, full * 63 * 0x1p-30);
  EXPECT_LT(speed(Regularization::kAbsolute, 1e-4, 0x1p-20), 1e-2);
}

TEST(AbsoluteEpsilon, IsTheValueOfTheScenario) {
  Mission mission = uneven_mission();
  mission.law.epsilon = 1.5e-3;
  Controller controller(mission);
  command_at(controller, mission, {100, 600, 0}, coverage_of(mission, 3));
  EXPECT_EQ(controller.epsilon(), 1.5e-3);
}

// ---- noise and contraction ----

TEST(Command, AddsTheNoiseOfItsAgentAndTickAsAVelocity) {
  Mission mission = uneven_mission();
  const Coefficients coverage = mission.target_coefficients;  // u = 0, so the noise stands alone
  mission.law.noise_intensity = 0.75;
  Controller noisy(mission);
  for (const AgentId agent : {0, 5}) {
    for (const Tick tick : {Tick{0}, Tick{1}, Tick{1} << 40}) {
      const Eigen::Vector2d xi =
          normal_pair(mission.seed, Purpose::kPerturbation, static_cast<std::uint32_t>(agent),
                      static_cast<std::uint64_t>(tick));
      const Eigen::Vector3d v = command_at(noisy, mission, {100, 600, 0}, coverage, agent, tick);
      EXPECT_EQ(v, on_ground((0.75 / std::sqrt(0.125)) * xi));
    }
  }
}

TEST(Command, PushesTwoOfAPairInOppositeWays) {
  Mission mission = uneven_mission();
  mission.law.regularization = Regularization::kRelative;
  mission.law.epsilon = 0.05;
  mission.law.perturbation = Perturbation::kAdaptive;
  mission.law.noise_ceiling = 10;
  const Coefficients coverage = coverage_of(mission, 50);
  const Eigen::Vector3d x_m = mission.domain.origin_m;  // a corner, where B vanishes
  const auto pushed = [&](AgentId agent, Tick tick, bool paired) {
    mission.law.paired_pushes = paired;
    Controller controller(mission);
    return command_at(controller, mission, x_m, coverage, agent, tick);
  };
  for (Tick tick = 0; tick < 100; tick += 10) {
    ASSERT_GT(pushed(0, tick, true).norm(), 0);
    EXPECT_EQ(pushed(1, tick, true), -pushed(0, tick, true));
    EXPECT_EQ(pushed(3, tick, true), -pushed(2, tick, true));
    EXPECT_NE(pushed(2, tick, true), pushed(0, tick, true));
    EXPECT_NE(pushed(1, tick, false), -pushed(0, tick, false));
    EXPECT_EQ(pushed(2, tick, true), pushed(2, tick, false))
        << "the first of a pair mirrors no other";
  }
}

TEST(Command, OfAnotherLawIsThatOfAMissionWithItsNumbers) {
  Mission mission = uneven_mission();
  mission.law.regularization = Regularization::kRelative;
  mission.law.epsilon = 0.05;
  mission.law.perturbation = Perturbation::kAdaptive;
  mission.law.noise_intensity = 0.5;
  mission.law.noise_ceiling = 10;
  Mission other = mission;
  other.law.u_max_mps /= 4;
  other.law.noise_intensity = 0.25;
  other.law.noise_ceiling = 8;
  const Coefficients coverage = coverage_of(mission, 50);
  Controller changed(mission), plans(mission), others(other);
  const LawNumbers before{mission.law.u_max_mps, 0.5, 10}, then{other.law.u_max_mps, 0.25, 8};
  for (Tick tick = 0; tick < 90; tick += 10) {
    const bool is_changed = tick >= 30 && tick < 60;
    changed.set_law(is_changed ? then : before);
    const auto command = [&](Controller& controller) {
      return command_at(controller, mission, {100, 600, 0}, coverage, 1, tick);
    };
    EXPECT_EQ(command(changed), command(is_changed ? others : plans)) << tick;
  }
}

TEST(Command, PullsTowardsTheCentreOfContraction) {
  Mission mission = uneven_mission();
  mission.law.contraction_gain_per_s = 0.5;
  mission.law.contraction_center_m = {20, 100, 0};
  Controller controller(mission);
  EXPECT_EQ(command_at(controller, mission, {100, 600, 0}, mission.target_coefficients),
            Eigen::Vector3d(-40, -250, 0));
}

// ---- symmetry ----

/// Four agents, mirrored in both midlines, under a target that is mirrored too.
using Team = std::array<Eigen::Vector3d, 4>;

TEST(Symmetry, OfPlacesIsKeptUnderASymmetricTarget) {
  Mission mission = test::small_mission(4);
  mission.basis.modes_x = mission.basis.modes_y = 15;
  mission.basis.sobolev_exponent = 1;
  mission.target_coefficients = Coefficients::Zero(225);
  for (int m = 0; m < 15; m += 2) {
    for (int n = 0; n < 15; n += 2) {
      mission.target_coefficients[15 * m + n] = std::cos(1.0 * m * n) / (1 + m * m + n * n);
    }
  }
  mission.target_coefficients[0] = 1;
  mission.law.epsilon = 1e-3;
  Controller controller(mission);
  const double size = 2000, dt_s = mission.timing.dt_s;
  const double x = 310, y = 420;
  Team team{{{x, y, 0}, {size - x, y, 0}, {x, size - y, 0}, {size - x, size - y, 0}}};
  const Team start = team;
  Coefficients sums = Coefficients::Zero(225);
  constexpr int kTicks = 200;
  for (int tick = 0; tick < kTicks; ++tick) {
    for (const Eigen::Vector3d& x_m : team)
      sums += basis_values(x_m, mission.domain, mission.basis) / 4;
    Team next;
    for (std::size_t i = 0; i < 4; ++i) {
      next[i] = team[i] + dt_s * command_at(controller, mission, team[i], sums / (tick + 1));
    }
    team = next;
  }
  EXPECT_GT((team[0] - start[0]).norm(), 50) << "they have moved";
  // A step's rounding, at most 1e-12 m (a few ulps of 2000 m), is carried on by u's slope: the
  // largest gradient of u is u_max |∇B|/ε ≤ 10·1e-5/1e-3 = 0.1/s, so at most e^(0.1·20 s) = 8
  // times.
  const double bound = kTicks * 1e-12 * 8;
  EXPECT_LE((team[1] - Eigen::Vector3d(size - team[0].x(), team[0].y(), 0)).norm(), bound);
  EXPECT_LE((team[2] - Eigen::Vector3d(team[0].x(), size - team[0].y(), 0)).norm(), bound);
  EXPECT_LE((team[3] - Eigen::Vector3d(size - team[0].x(), size - team[0].y(), 0)).norm(), bound);
}

TEST(ControllerDeathTest, StopsACallerWhoseTargetHasAnotherSize) {
  Mission mission = uneven_mission();
  mission.target_coefficients = Coefficients::Zero(9);
  EXPECT_DEATH(Controller{mission}, "broken precondition");
}

}  // namespace
}  // namespace ergocast
