// SPDX-License-Identifier: BSD-3-Clause
// How far ahead an agent looks: the target's spread, the horizon and the weights of gains.
#include "core/law/look_ahead.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "target/target.h"

namespace ergocast {
namespace {

Mission mission_of(const TargetDensity& target, const Box& domain, int modes = 16) {
  Mission mission;
  mission.domain = domain;
  mission.basis.modes_x = mission.basis.modes_y = modes;
  mission.target_coefficients = target_coefficients(target, domain, mission.basis).values;
  mission.law.u_max_mps = 20;
  mission.law.anticipation = 2;
  mission.timing.dt_s = 0.1;
  mission.timing.tick_count = 6000;
  return mission;
}

TargetDensity bells(const std::vector<Gaussian>& gaussians, double uniform_weight = 0) {
  TargetDensity target;
  target.gaussians = gaussians;
  target.uniform_weight = uniform_weight;
  return target;
}

Eigen::Matrix3d round(double sigma_m) { return sigma_m * sigma_m * Eigen::Matrix3d::Identity(); }

Eigen::Matrix3d covariance_m2(const Mission& mission) {
  return target_covariance_m2(mission.target_coefficients, mission.basis, mission.domain);
}

double spread_m(const Mission& mission) { return target_spread_m(covariance_m2(mission)); }

/// From the definition: the density on a grid of 1000 × 1000 midpoints.
Eigen::Matrix3d integrated_covariance_m2(const TargetDensity& target, const Box& domain) {
  constexpr int kCells = 1000;
  double mass = 0;
  Eigen::Vector3d mean_m = Eigen::Vector3d::Zero();
  Eigen::Matrix3d square_m2 = Eigen::Matrix3d::Zero();
  for (int i = 0; i < kCells; ++i) {
    for (int j = 0; j < kCells; ++j) {
      const Eigen::Vector3d at_m =
          Eigen::Vector3d(i + 0.5, j + 0.5, 0).cwiseProduct(domain.size_m) / kCells;
      const double here = density_unscaled(target, domain, domain.origin_m + at_m);
      mass += here;
      mean_m += here * at_m;
      square_m2 += here * at_m * at_m.transpose();
    }
  }
  mean_m /= mass;
  return square_m2 / mass - mean_m * mean_m.transpose();
}

// ---- s, the target's spread ----

struct Case {
  const char* name;
  TargetDensity target;
  Box domain;
};

std::vector<Case> smooth_targets() {
  const Box square{{0, 0, 0}, {2000, 2000, 0}}, slab{{-300, 70, 0}, {4000, 500, 0}};
  Eigen::Matrix3d oblique = Eigen::Matrix3d::Identity();
  oblique.topLeftCorner<2, 2>() << 9e4, 3e4, 3e4, 4e4;
  return {
      {"uniform", bells({}, 1), square},
      {"uniform slab", bells({}, 1), slab},
      {"one Gaussian", bells({{1, {1000, 1000, 0}, round(200)}}), square},
      {"off the centre, cut off", bells({{1, {300, 1800, 0}, round(250)}}), square},
      {"oblique", bells({{1, {800, 1100, 0}, oblique}}), square},
      {"two, unequal", bells({{3, {400, 500, 0}, round(200)}, {1, {1600, 1500, 0}, round(150)}}),
       square},
      {"four",
       bells({{1, {500, 500, 0}, round(150)},
              {1, {500, 1500, 0}, round(150)},
              {1, {1500, 500, 0}, round(150)},
              {1, {1500, 1500, 0}, round(150)}}),
       square},
      {"a Gaussian on a slab", bells({{2, {500, 250, 0}, round(300)}}, 1), slab},
  };
}

TEST(TargetSpread, IsTheRmsDistanceFromTheMean) {
  for (const auto& [name, target, domain] : smooth_targets()) {
    const Mission mission = mission_of(target, domain, 24);
    const double expected_m = target_spread_m(integrated_covariance_m2(target, domain));
    EXPECT_NEAR(spread_m(mission), expected_m, 1e-3 * expected_m) << name;
  }
}

TEST(TargetSpread, OfAUniformTargetIsTheRectangles) {
  const Box slab{{5, 5, 0}, {4000, 500, 0}};
  const Mission mission = mission_of(bells({}, 1), slab, 3);
  EXPECT_NEAR(spread_m(mission), std::hypot(4000, 500) / std::sqrt(12), 1e-9);
}

TEST(TargetSpread, InSpaceCountsEachAxis) {
  // ρ = (1 + a cos(πx/L)) / L along each axis: μ_1 = a/2, and the variance is L² (1/12 − 4a²/π⁴).
  const Box box{{-3, 5, 40}, {300, 200, 80}};
  const Basis basis{.modes_x = 2, .modes_y = 3, .modes_z = 4};
  const auto deviation = [](double a) {
    return std::sqrt(1.0 / 12 - 4 * a * a / std::pow(std::numbers::pi, 4));
  };
  Coefficients target = Coefficients::Zero(basis.mode_count());
  target[0] = 1;
  target[3] = 0.3 / 2;   // m = 1
  target[1] = -0.6 / 2;  // n = 1
  target[6] = 0.9 / 2;   // l = 1
  EXPECT_NEAR(target_spread_m(target_covariance_m2(target, basis, box)),
              std::hypot(300 * deviation(0.3), 200 * deviation(0.6), 80 * deviation(0.9)), 1e-10);
}

// A Gaussian of 1 m is a point for these modes. Its spread is 1 m, so the rest of the result is the
// error of the modes.
TEST(TargetSpread, IsOffByWhatTheModesLeaveOutAndNoMore) {
  const Box square{{0, 0, 0}, {2000, 2000, 0}};
  for (const int modes : {2, 4, 16, 64}) {
    for (const Eigen::Vector2d& at_m :
         {Eigen::Vector2d(3, 5), Eigen::Vector2d(700, 1311), Eigen::Vector2d(1000, 1000)}) {
      const Mission mission = mission_of(bells({{1, on_ground(at_m), round(1)}}), square, modes);
      const double actual_m = spread_m(mission);
      ASSERT_TRUE(std::isfinite(actual_m));
      // The tail enters the mean square once, and the squared mean at most 2 + tail times.
      const double tail = 4 / (std::numbers::pi * std::numbers::pi * (modes - 0.5));
      EXPECT_LE(actual_m * actual_m, 2 * 2000 * 2000 * tail * (3 + tail) + 2) << modes << " modes";
    }
  }
}

TEST(TargetSpread, OfOneModeIsTheUniformTargets) {
  const Box square{{0, 0, 0}, {2000, 2000, 0}};
  const Mission mission = mission_of(bells({{1, {300, 400, 0}, round(100)}}), square, 1);
  EXPECT_NEAR(spread_m(mission), 2000 / std::sqrt(6), 1e-9);
}

// ---- d, the dimensions that a team shares out ----

double dimensions(const Mission& mission) { return shared_dimensions(covariance_m2(mission)); }

TEST(SharedDimensions, AreTwoOfASquareAndOneOfAStrip) {
  EXPECT_NEAR(dimensions(mission_of(bells({}, 1), {{0, 0, 0}, {2000, 2000, 0}})), 2, 1e-12);
  EXPECT_NEAR(dimensions(mission_of(bells({}, 1), {{7, 0, 0}, {20000, 200, 0}})), 1, 3e-4);
  EXPECT_NEAR(dimensions(mission_of(bells({}, 1), {{0, 3, 0}, {200, 20000, 0}})), 1, 3e-4);
  // (1 + ¼)² / (1 + 1/16)
  EXPECT_NEAR(dimensions(mission_of(bells({}, 1), {{0, 0, 0}, {2000, 1000, 0}})), 25. / 17, 1e-12);
}

// Two peaks on a diagonal lie along a line, so the team shares out one dimension.
TEST(SharedDimensions, FollowTheTargetAndNotTheDomain) {
  const Box square{{-40, 3, 0}, {2000, 2000, 0}};
  const auto two = [&](double y_m, double other_y_m) {
    return dimensions(
        mission_of(bells({{1, {300, y_m, 0}, round(100)}, {1, {1640, other_y_m, 0}, round(100)}}),
                   square, 32));
  };
  EXPECT_NEAR(two(333, 1673), two(1003, 1003), 0.2);
  EXPECT_NEAR(two(333, 1673), two(1673, 333), 1e-9);
  EXPECT_LT(two(333, 1673), 1.1);
}

TEST(SharedDimensions, AreThoseOfTheCovarianceOnAGrid) {
  for (const auto& [name, target, domain] : smooth_targets()) {
    const Eigen::Matrix3d expected_m2 = integrated_covariance_m2(target, domain);
    const Mission mission = mission_of(target, domain, 24);
    EXPECT_LE((covariance_m2(mission) - expected_m2).norm(), 3e-3 * expected_m2.norm()) << name;
    EXPECT_NEAR(dimensions(mission), shared_dimensions(expected_m2), 1e-2) << name;
  }
}

TEST(SharedDimensions, OfACubeOrAPointAreTwo) {
  EXPECT_EQ(shared_dimensions(Eigen::Matrix3d::Identity()), 2);
  EXPECT_EQ(shared_dimensions(Eigen::Matrix3d::Zero()), 2);
  EXPECT_NEAR(shared_dimensions(Eigen::Vector3d(1e-200, 1e-200, 0).asDiagonal()), 2, 1e-12);
}

// ---- h, the horizon ----

const Box kSquare{{0, 0, 0}, {2000, 2000, 0}};
/// s / u_max of a uniform target on kSquare at 20 m/s.
const double kCrossing_s = 2000 / std::sqrt(6) / 20;

Mission uniform() { return mission_of(bells({}, 1), kSquare); }

TEST(Horizon, IsAnticipationTimesSOverSpeedAndRootOfN) {
  Mission mission = uniform();
  for (const double anticipation : {0.5, 2.0, 7.0}) {
    mission.law.anticipation = anticipation;
    const LookAhead look_ahead(mission);
    EXPECT_TRUE(look_ahead.any());
    for (const int n : {1, 2, 4, 64}) {
      EXPECT_NEAR(look_ahead.horizon_s(n, 123), anticipation * kCrossing_s / std::sqrt(n), 1e-9);
    }
  }
}

TEST(Horizon, OfAStripIsThatOfAShareOfItsLength) {
  const LookAhead look_ahead(mission_of(bells({}, 1), {{0, 0, 0}, {1e6, 10, 0}}));
  const double alone_s = 2 * 1e6 / std::sqrt(12) / 20 / std::sqrt(2);
  for (const int n : {1, 2, 4, 64}) {
    EXPECT_NEAR(look_ahead.horizon_s(n, 123), alone_s / n, 1e-6 * alone_s) << n;
  }
}

TEST(Horizon, IsNoneWithoutAnticipation) {
  Mission mission = uniform();
  mission.law.anticipation = 0;
  EXPECT_FALSE(LookAhead(mission).any());
  EXPECT_EQ(LookAhead(mission).horizon_s(4, 0), 0);
}

TEST(Horizon, EndsWithThePlanOnlyIfTheScenarioChoosesIt) {
  Mission mission = uniform();
  const double full_s = LookAhead(mission).horizon_s(4, 0);
  EXPECT_EQ(LookAhead(mission).horizon_s(4, 5999), full_s);
  mission.law.ends_with_plan = true;
  const LookAhead look_ahead(mission);
  EXPECT_EQ(look_ahead.horizon_s(4, 0), full_s);
  EXPECT_EQ(look_ahead.horizon_s(4, 5000), full_s) << "100 s are left, more than it looks ahead";
  EXPECT_NEAR(look_ahead.horizon_s(4, 5900), 10, 1e-9);
  EXPECT_NEAR(look_ahead.horizon_s(4, 5999), 0.1, 1e-9);
  EXPECT_EQ(look_ahead.horizon_s(4, 7000), 0) << "after the end";
}

TEST(Horizon, IsAtMostWhatAWayAcrossTheTargetLeavesOfTheMission) {
  Mission mission = uniform();
  mission.law.ends_with_plan = true;
  const double full_s = LookAhead(mission).horizon_s(4, 0);
  const auto lasting = [&](double duration_s) {
    mission.timing.tick_count = static_cast<Tick>(std::llround(duration_s / mission.timing.dt_s));
    return LookAhead(mission).horizon_s(4, 0);
  };
  EXPECT_EQ(lasting(kCrossing_s + full_s + 1), full_s);
  EXPECT_NEAR(lasting(kCrossing_s + 5), 5, 0.1);
  EXPECT_EQ(lasting(kCrossing_s - 1), 0);
  mission.law.ends_with_plan = false;
  EXPECT_EQ(lasting(kCrossing_s - 1), full_s);
}

// ---- w, the weight of a gain ----

/// The longest period that the plan allows; eight of them are 4 s.
constexpr Tick kPeriod = 5;

LookAhead broadcasting_every(Tick period) {
  Mission mission = uniform();
  mission.timing.broadcast_period_ticks = static_cast<int>(period);
  return LookAhead(mission);
}

TEST(Weight, IsTheHorizonAndTheSpanAndTheAge) {
  const LookAhead look_ahead = broadcasting_every(kPeriod);
  EXPECT_EQ(look_ahead.longest_period(), kPeriod);
  EXPECT_NEAR(look_ahead.weight_s(30, 5, 0, kPeriod), 30.5, 1e-12);
  EXPECT_NEAR(look_ahead.weight_s(30, 5, 7, kPeriod), 31.2, 1e-12);
  EXPECT_NEAR(look_ahead.weight_s(30, 1, 0, 1), 30.1, 1e-12);
}

TEST(Weight, CountsAtMostEightPeriodsOfTheSpan) {
  const LookAhead look_ahead = broadcasting_every(kPeriod);
  EXPECT_NEAR(look_ahead.weight_s(30, 40, 0, kPeriod), 34, 1e-12);
  EXPECT_NEAR(look_ahead.weight_s(30, 41, 0, kPeriod), 34, 1e-12);
  EXPECT_NEAR(look_ahead.weight_s(30, 5000, 0, kPeriod), 34, 1e-12) << "a first block";
  EXPECT_NEAR(look_ahead.weight_s(30, 5000, 0, 2), 31.6, 1e-12)
      << "an agent that broadcasts more often than it must";
}

TEST(Weight, BelievesARarerPeriodOfHighModesIfThePlanHasIt) {
  Mission mission = uniform();
  mission.timing.broadcast_period_ticks = kPeriod;
  mission.timing.high_mode_period_factor = 3;
  const LookAhead look_ahead(mission);
  EXPECT_EQ(look_ahead.longest_period(), 3 * kPeriod);
  EXPECT_NEAR(look_ahead.weight_s(1, 15, 120, 3 * kPeriod), 14.5, 1e-12);
  EXPECT_EQ(look_ahead.weight_s(1, 15, 121, 3 * kPeriod), 0);
  EXPECT_EQ(look_ahead.weight_s(1, 5, 41, kPeriod), 0) << "of the first block";
}

TEST(Weight, OfAnAgentThatHasBeenSilentForLongIsNone) {
  const LookAhead look_ahead = broadcasting_every(kPeriod);
  // The horizon, 30 s, is longer than eight periods.
  EXPECT_NEAR(look_ahead.weight_s(30, 5, 300, kPeriod), 60.5, 1e-12);
  EXPECT_EQ(look_ahead.weight_s(30, 5, 301, kPeriod), 0);
  // Eight periods, 4 s, are longer than the horizon.
  EXPECT_NEAR(look_ahead.weight_s(1, 5, 40, kPeriod), 5.5, 1e-12);
  EXPECT_EQ(look_ahead.weight_s(1, 5, 41, kPeriod), 0);
  EXPECT_EQ(look_ahead.weight_s(1, 5, 41, 2), 0);
}

TEST(Weight, APeriodThatThePlanDoesNotAllowBuysNothing) {
  const LookAhead look_ahead = broadcasting_every(kPeriod);
  for (const Tick age : {0, 39, 41, 299, 301}) {
    for (const Tick span : {1, 39, 41, 100000}) {
      const double honest_s = look_ahead.weight_s(1, span, age, kPeriod);
      EXPECT_EQ(look_ahead.weight_s(1, span, age, 1000), honest_s) << span << ' ' << age;
      EXPECT_EQ(look_ahead.weight_s(1, span, age, Tick{1} << 48), honest_s) << span << ' ' << age;
    }
  }
}

// A sender may write any two ticks into a block: that of the block, and that of its next one.
TEST(Weight, AnAnnouncementOfThePastIsNone) {
  const LookAhead look_ahead = broadcasting_every(kPeriod);
  for (const Tick period : {Tick{0}, Tick{-1}, -(Tick{1} << 48)}) {
    EXPECT_NEAR(look_ahead.weight_s(30, 5, 0, period), 30, 1e-12) << period;
    EXPECT_NEAR(look_ahead.weight_s(30, 5, 300, period), 60, 1e-12) << period;
    EXPECT_EQ(look_ahead.weight_s(30, 5, 301, period), 0) << period;
  }
}

}  // namespace
}  // namespace ergocast
