// SPDX-License-Identifier: BSD-3-Clause
// The control step against the paper's formulas written out term by term, and B against the slope
// of φ² itself.
#include "core/law/control.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "core/base/noise.h"
#include "core/law/coverage_table.h"
#include "tests/support/team.h"

namespace ergocast {
namespace {

constexpr double kRounding = 0x1p-53;
constexpr double kTiniest = std::numeric_limits<double>::denorm_min();

/// A mission on a domain with its own origin and unequal sides; μ without any pattern.
Mission uneven_mission() {
  Mission mission = test::small_mission(1);
  mission.domain = {{-300, 50, 0}, {2000, 1200, 0}};
  mission.basis.modes_x = 9;
  mission.basis.modes_y = 7;
  mission.target_coefficients = Coefficients::Zero(63);
  for (int m = 0; m < 9; ++m) {
    for (int n = 0; n < 7; ++n) {
      mission.target_coefficients[7 * m + n] = std::cos(1.0 + 2.3 * m + 0.7 * n * n) / (1 + m + n);
    }
  }
  mission.target_coefficients[0] = 1;
  mission.law.u_max_mps = 12;
  mission.timing.dt_s = 0.125;
  return mission;
}

Eigen::Vector3d place_in(const Box& domain, std::uint64_t i) {
  return uniform_in(domain, 5, Purpose::kStart, 0, i);
}

/// c_k of a path of `steps` places.
Coefficients coverage_of(const Mission& mission, int steps) {
  Coefficients sum = Coefficients::Zero(mission.basis.mode_count());
  for (int i = 0; i < steps; ++i) {
    sum += basis_values(place_in(mission.domain, static_cast<std::uint64_t>(i)), mission.domain,
                        mission.basis);
  }
  return sum / steps;
}

Eigen::Vector3d command_at(Controller& controller, const Mission& mission,
                           const Eigen::Vector3d& x_m, const Coefficients& coverage,
                           AgentId agent = 0, Tick tick = 0) {
  controller.set_coverage(coverage);
  return controller.command(agent, tick, x_m, BasisAt(x_m, mission.domain, mission.basis));
}

// ---- (8) by itself ----

TEST(SmoothInput, IsEquation8) {
  for (std::uint64_t i = 0; i < 200; ++i) {
    const Eigen::Vector3d b = on_ground(normal_pair(1, Purpose::kStart, 0, i) * 1e-4);
    const double epsilon = 1e-4 * uniform_pair(1, Purpose::kStart, 1, i).x();
    const Eigen::Vector3d expected = -12 * b / std::sqrt(b.squaredNorm() + epsilon * epsilon);
    // Fewer than ten roundings on either side, of numbers of at most 12.
    EXPECT_LE((smooth_input(b, epsilon, 12) - expected).norm(), 20 * 12 * kRounding);
  }
}

TEST(SmoothInput, WithoutEpsilonIsTheClassicalLaw) {
  EXPECT_EQ(smooth_input({3e-5, 0, 0}, 0, 12), Eigen::Vector3d(-12, 0, 0));
  EXPECT_EQ(smooth_input({0, -1e-9, 0}, 0, 12), Eigen::Vector3d(0, 12, 0));
  const Eigen::Vector3d u = smooth_input({3, -4, 0}, 0, 10);
  EXPECT_DOUBLE_EQ(u.x(), -6);
  EXPECT_DOUBLE_EQ(u.y(), 8);
}

TEST(SmoothInput, OfNoGradientIsNoInputAndNeverNan) {
  for (const double epsilon : {0.0, kTiniest, 1e-300, 1e-3}) {
    for (const Eigen::Vector3d& b : {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(-0.0, 0.0, 0)}) {
      EXPECT_EQ(smooth_input(b, epsilon, 12), Eigen::Vector3d(0, 0, 0)) << epsilon;
    }
  }
}

TEST(SmoothInput, OfNextToNoGradientIsADirectionAndNeverInfinite) {
  // An agent 1e-308 m off an edge has a gradient like that.
  for (const double tiny : {1e-150, 1e-300, 1e-307, 1e-310, 1e-320, kTiniest}) {
    EXPECT_EQ(smooth_input({tiny, 0, 0}, 0, 12), Eigen::Vector3d(-12, 0, 0)) << tiny;
    EXPECT_EQ(smooth_input({0, -tiny, 0}, 0, 12), Eigen::Vector3d(0, 12, 0)) << tiny;
    EXPECT_LE(smooth_input({tiny, tiny, 0}, 1e-3, 12).norm(), 12 * 2 * tiny / 1e-3) << tiny;
  }
}

TEST(SmoothInput, NeverExceedsItsLimit) {
  for (std::uint64_t i = 0; i < 100000; ++i) {
    // Every magnitude from 1e-300 to 1e+300, and ε as well.
    const Eigen::Vector2d u = uniform_pair(2, Purpose::kStart, 0, i);
    const Eigen::Vector3d b =
        on_ground(normal_pair(2, Purpose::kStart, 1, i) * std::pow(10, 600 * u.x() - 300));
    const double epsilon = i % 4 == 0 ? 0 : std::pow(10, 600 * u.y() - 300);
    const Eigen::Vector3d input = smooth_input(b, epsilon, 12);
    ASSERT_TRUE(input.allFinite()) << b.transpose() << ", " << epsilon;
    // A square root and two divisions round.
    ASSERT_LE(input.norm(), 12 * (1 + 8 * kRounding)) << b.transpose() << ", " << epsilon;
  }
}

// ---- the command, (6), (8) and (10), written out ----

/// B, term by term, with the library's cosines and sines.
Eigen::Vector3d reference_gradient(const Mission& mission, const Eigen::Vector3d& x_m,
                                   const Coefficients& coverage) {
  Eigen::Vector3d b(0, 0, 0);
  const Eigen::Vector3d x = x_m - mission.domain.origin_m, size = mission.domain.size_m;
  for (int m = 0; m < mission.basis.modes_x; ++m) {
    for (int n = 0; n < mission.basis.modes_y; ++n) {
      const double kx = m * std::numbers::pi / size.x(), ky = n * std::numbers::pi / size.y();
      const double k = std::sqrt(m * m + n * n), s = mission.basis.sobolev_exponent;
      const bool squared = mission.basis.sobolev_form == SobolevForm::kSquaredNorm;
      double lambda = squared ? std::pow(1 + k * k, -s) : std::pow(1 + k, -s);
      if (mission.basis.normalized) {
        lambda /= size.x() * (m > 0 ? 0.5 : 1) * size.y() * (n > 0 ? 0.5 : 1);
      }
      const double a = lambda * (in_plane(coverage, mission.basis)(m, n) -
                                 in_plane(mission.target_coefficients, mission.basis)(m, n));
      b.x() -= a * kx * std::sin(kx * x.x()) * std::cos(ky * x.y());
      b.y() -= a * ky * std::cos(kx * x.x()) * std::sin(ky * x.y());
    }
  }
  return b;
}

/// RMS of ‖Σ a ∇f‖ over the domain stretched to a square, by midpoints, of which twice the highest
/// mode are exact.
double reference_rms(const Mission& mission, const Coefficients& coverage) {
  constexpr int kPoints = 24;
  double sum = 0;
  for (int i = 0; i < kPoints; ++i) {
    for (int j = 0; j < kPoints; ++j) {
      const Eigen::Vector3d share((i + 0.5) / kPoints, (j + 0.5) / kPoints, 0);
      const Eigen::Vector3d x_m =
          mission.domain.origin_m + share.cwiseProduct(mission.domain.size_m);
      const Eigen::Vector3d gradient = reference_gradient(mission, x_m, coverage);
      sum += gradient.cwiseProduct(mission.domain.size_m).squaredNorm();
    }
  }
  return std::sqrt(sum) / kPoints / mission.domain.size_m.maxCoeff();
}

Eigen::Vector3d reference_command(const Mission& mission, AgentId agent, Tick tick,
                                  const Eigen::Vector3d& x_m, const Coefficients& coverage,
                                  double rms) {
  const ControlLaw& law = mission.law;
  const Eigen::Vector3d b = reference_gradient(mission, x_m, coverage);
  const bool relative = law.regularization == Regularization::kRelative;
  const double epsilon = law.epsilon * (relative ? rms : 1);
  const double length = std::sqrt(b.squaredNorm() + epsilon * epsilon);
  Eigen::Vector3d v =
      length == 0 ? Eigen::Vector3d(0, 0, 0) : Eigen::Vector3d(-law.u_max_mps * b / length);
  v -= law.contraction_gain_per_s * (x_m - law.contraction_center_m);
  v += law.noise_intensity / std::sqrt(mission.timing.dt_s) *
       on_ground(normal_pair(mission.seed, Purpose::kPerturbation,
                             static_cast<std::uint32_t>(agent), static_cast<std::uint64_t>(tick)));
  return v;
}

std::vector<Mission> every_law() {
  std::vector<Mission> missions;
  for (const SobolevForm form : {SobolevForm::kSquaredNorm, SobolevForm::kNorm}) {
    for (const bool normalized : {false, true}) {
      for (const Regularization how : {Regularization::kAbsolute, Regularization::kRelative}) {
        for (const double epsilon : {0.0, 0.25}) {
          Mission mission = uneven_mission();
          mission.basis.sobolev_form = form;
          mission.basis.sobolev_exponent = 1.25;
          mission.basis.normalized = normalized;
          mission.law.regularization = how;
          // Absolute: in the unit of B, which the norm of the modes changes too.
          mission.law.epsilon =
              how == Regularization::kRelative ? epsilon : epsilon * (normalized ? 1e-9 : 1e-3);
          mission.law.contraction_gain_per_s = 2e-3;
          mission.law.contraction_center_m = {40, 700, 0};
          mission.law.noise_intensity = 0.5;
          missions.push_back(mission);
        }
      }
    }
  }
  return missions;
}

TEST(Command, IsThePapersLawTermByTerm) {
  for (const Mission& mission : every_law()) {
    Controller controller(mission);
    const Coefficients coverage = coverage_of(mission, 50);
    const double rms = reference_rms(mission, coverage);
    for (std::uint64_t i = 0; i < 20; ++i) {
      const Eigen::Vector3d x_m = place_in(mission.domain, 1000 + i);
      const auto tick = static_cast<Tick>(i);
      const Eigen::Vector3d v = command_at(controller, mission, x_m, coverage, 3, tick);
      const Eigen::Vector3d b = reference_gradient(mission, x_m, coverage);
      // B is a sum of 63 terms of at most a few RMS, each with 20 roundings of its cosines; where
      // the terms nearly cancel, its direction is that much less certain.
      const double bound = 63 * 20 * kRounding * (1 + rms / b.norm());
      EXPECT_LE((controller.spectral_gradient() - b).norm(), bound * b.norm());
      EXPECT_LE((v - reference_command(mission, 3, tick, x_m, coverage, rms)).norm(), bound * 20);
    }
  }
}

TEST(Command, GradientIsTheSlopeOfPhiSquaredInTheNewestSample) {
  // With S the sum before the sample and T the time after it, c = (S + f(x) dt) / T, so that
  // ∂φ²/∂x = 2 dt/T Σ λ (c − μ) ∇f = 2 dt/T · B.
  for (Mission mission : every_law()) {
    mission.law = {};
    Controller controller(mission);
    constexpr int kBefore = 7;
    const Coefficients before = coverage_of(mission, kBefore) * kBefore;
    const auto coverage_with = [&](const Eigen::Vector3d& x_m) -> Coefficients {
      return (before + basis_values(x_m, mission.domain, mission.basis)) / (kBefore + 1);
    };
    const auto metric_with = [&](const Eigen::Vector3d& x_m) {
      return controller.metric(coverage_with(x_m));
    };
    const Eigen::Vector3d x_m(512.5, 640.25, 0);  // dyadic, so that x ± h is exact
    const double h = 0.0625;
    const Coefficients coverage = coverage_with(x_m);
    command_at(controller, mission, x_m, coverage);
    const Eigen::Vector3d slope = 2 * controller.spectral_gradient() / (kBefore + 1);

    // h²/6 of the third derivative, ≤ Σ λ (2 |c − μ| k³ + 6 k³)/8 with |c| changing by at most 1/8
    // for each k; and the rounding of φ², 63 terms, over h.
    const Coefficients weights = sobolev_weights(mission.basis, mission.domain);
    double third = 0;
    for (int m = 0; m < 9; ++m) {
      for (int n = 0; n < 7; ++n) {
        const double k = std::hypot(m * std::numbers::pi / 2000, n * std::numbers::pi / 1200);
        const int i = 7 * m + n;
        third += weights[i] * k * k * k *
                 (2 * std::abs(coverage[i] - mission.target_coefficients[i]) + 6.0 / 8) / 8;
      }
    }
    const double bound = h * h / 6 * third + 63 * 20 * kRounding * controller.metric(coverage) / h;
    ASSERT_LT(bound, 1e-4 * slope.norm()) << "the comparison is worth it";
    for (int axis = 0; axis < 2; ++axis) {
      const Eigen::Vector3d step = h * Eigen::Vector3d::Unit(axis);
      EXPECT_NEAR(slope[axis], (metric_with(x_m + step) - metric_with(x_m - step)) / (2 * h),
                  bound);
    }
  }
}

TEST(Command, LowersPhiSquaredOfTheNextSample) {
  Mission mission = uneven_mission();
  Controller controller(mission);
  const Coefficients before = coverage_of(mission, 10) * 10;
  const Eigen::Vector3d x_m(512.5, 640.25, 0);
  const auto metric_after = [&](const Eigen::Vector3d& next_m) {
    return controller.metric((before + basis_values(next_m, mission.domain, mission.basis)) / 11);
  };
  const Coefficients now = (before + basis_values(x_m, mission.domain, mission.basis)) / 11;
  const Eigen::Vector3d step = command_at(controller, mission, x_m, now) * mission.timing.dt_s;
  EXPECT_LT(metric_after(x_m + step), metric_after(x_m));
  EXPECT_GT(metric_after(x_m - step), metric_after(x_m));
}

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

// ---- relative regularization ----

TEST(RelativeEpsilon, IsAShareOfTheResidualGradientsRms) {
  for (Mission mission : every_law()) {
    mission.law.regularization = Regularization::kRelative;
    mission.law.epsilon = 0.2;
    Controller controller(mission);
    const Coefficients coverage = coverage_of(mission, 30);
    command_at(controller, mission, {100, 600, 0}, coverage);
    // 576 squares of 63 terms, 20 roundings each.
    const double expected = 0.2 * reference_rms(mission, coverage);
    EXPECT_NEAR(controller.epsilon(), expected, (576 + 63 * 20) * kRounding * expected);
  }
}

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
