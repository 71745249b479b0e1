// SPDX-License-Identifier: BSD-3-Clause
// The projection on intersections of cones, against searches that know only the definition.
#include "core/motion/step_constraints.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

namespace ergocast {
namespace {

using Set = StepConstraints::Set;
constexpr double kReach_m = 4;
constexpr int kDirections = 41;

class Draws {
 public:
  explicit Draws(unsigned seed) : engine_(seed) {}
  double between(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }
  Eigen::Vector3d direction(bool planar) {
    std::normal_distribution<double> normal;
    Eigen::Vector3d d(normal(engine_), normal(engine_), planar ? 0 : normal(engine_));
    return d.normalized();
  }
  std::vector<Set> sets(int most, double lowest_bound_m, bool planar) {
    std::vector<Set> sets(static_cast<std::size_t>(between(1, most + 1)));
    for (Set& set : sets) {
      const double sine = between(0, 1) < 0.3 ? 0 : between(0, 0.95);
      set = {direction(planar), sine, between(lowest_bound_m, 0.5 * kReach_m)};
    }
    return sets;
  }

 private:
  std::mt19937 engine_;
};

StepConstraints::Room open_room(bool planar) {
  const Eigen::Vector3d high_m(100, 100, planar ? 0 : 100);
  return {kReach_m, -high_m, high_m};
}

StepConstraints constraints_of(const StepConstraints::Room& room, const std::vector<Set>& sets) {
  StepConstraints constraints(128);
  constraints.begin(room);
  for (const Set& set : sets) constraints.add(set);
  return constraints;
}

/// max u·d − b over many u within α of a, in the plane of a and d: there the maximum is.
double excess_by_definition(const Set& set, const Eigen::Vector3d& d) {
  const double angle = std::asin(set.sine);
  Eigen::Vector3d across = d - set.toward.dot(d) * set.toward;
  across = across.norm() > 1e-9 ? across.normalized() : set.toward.unitOrthogonal();
  double most = -1e300;
  for (int i = 0; i < kDirections; ++i) {
    const double phi = angle * (2.0 * i / (kDirections - 1) - 1);
    most = std::max(most, (std::cos(phi) * set.toward + std::sin(phi) * across).dot(d));
  }
  return most - set.bound_m;
}

double worst_by_definition(const std::vector<Set>& sets, const Eigen::Vector3d& d) {
  double worst = -1e300;
  for (const Set& set : sets) worst = std::max(worst, excess_by_definition(set, d));
  return worst;
}

/// The shortest distance from `wanted` to an allowed step: a search over a grid in the plane that
/// becomes finer around the best. The set is convex.
double search(const std::vector<Set>& sets, const Eigen::Vector3d& wanted_m) {
  Eigen::Vector3d best_m(0, 0, 0);
  double half_m = kReach_m, shortest_m = 1e300;
  for (int round = 0; round < 9; ++round, half_m *= 0.3) {
    const Eigen::Vector3d center_m = best_m;
    for (int i = -12; i <= 12; ++i) {
      for (int j = -12; j <= 12; ++j) {
        const Eigen::Vector3d d = center_m + half_m / 12 * Eigen::Vector3d(i, j, 0);
        const double distance_m = (d - wanted_m).norm();
        if (distance_m >= shortest_m || d.norm() > kReach_m) continue;
        if (worst_by_definition(sets, d) > 1e-3) continue;
        shortest_m = distance_m;
        best_m = d;
      }
    }
  }
  return shortest_m;
}

TEST(StepConstraints, ReturnEveryBitOfAnAllowedStep) {
  Draws draws(1);
  for (int i = 0; i < 2000; ++i) {
    StepConstraints constraints = constraints_of(open_room(false), draws.sets(4, 0, false));
    const Eigen::Vector3d wanted_m = draws.between(0, kReach_m) * draws.direction(false);
    if (!constraints.allow(wanted_m)) continue;
    EXPECT_EQ(constraints.nearest(wanted_m), wanted_m);
  }
}

TEST(StepConstraints, ProjectOnOneSetExactly) {
  Draws draws(2);
  for (int i = 0; i < 60; ++i) {
    const std::vector<Set> sets = draws.sets(1, -1, true);
    StepConstraints constraints = constraints_of(open_room(true), sets);
    const Eigen::Vector3d wanted_m = draws.between(0, kReach_m) * draws.direction(true);
    const Eigen::Vector3d step_m = constraints.nearest(wanted_m);
    if (step_m.norm() > 0.999 * kReach_m) continue;  // the ball is a second set
    EXPECT_LE(worst_by_definition(sets, step_m), 1e-8 * kReach_m);
    EXPECT_NEAR((step_m - wanted_m).norm(), search(sets, wanted_m), 0.01) << i;
  }
}

TEST(StepConstraints, AllowOnlyWhatTheDefinitionAllowsInAnyDimension) {
  Draws draws(3);
  for (int i = 0; i < 3000; ++i) {
    const bool planar = i % 2 == 0;
    const std::vector<Set> sets = draws.sets(i % 3 == 0 ? 60 : 6, 0, planar);
    StepConstraints constraints = constraints_of(open_room(planar), sets);
    const Eigen::Vector3d wanted_m = draws.between(0, 3 * kReach_m) * draws.direction(planar);
    const Eigen::Vector3d step_m = constraints.nearest(wanted_m);
    ASSERT_TRUE(constraints.allow(step_m)) << i;
    ASSERT_LE(worst_by_definition(sets, step_m), 1e-9 * kReach_m) << i;
    ASSERT_LE(step_m.norm(), kReach_m * (1 + 1e-12)) << i;
  }
}

TEST(StepConstraints, AreCloseToTheNearestOfManySets) {
  Draws draws(4);
  double sum_m = 0, worst_m = 0;
  constexpr int kProblems = 60;
  for (int i = 0; i < kProblems; ++i) {
    const std::vector<Set> sets = draws.sets(7, 0, true);
    StepConstraints constraints = constraints_of(open_room(true), sets);
    const Eigen::Vector3d wanted_m = draws.between(0, kReach_m) * draws.direction(true);
    const double distance_m = (constraints.nearest(wanted_m) - wanted_m).norm();
    const double further_m = std::max(0.0, distance_m - search(sets, wanted_m) - 0.01);
    sum_m += further_m;
    worst_m = std::max(worst_m, further_m);
  }
  EXPECT_LT(sum_m / kProblems, 5e-3 * kReach_m);
  EXPECT_LT(worst_m, 0.4 * kReach_m);
}

TEST(StepConstraints, NegativeBoundsThatHaveACommonStepGetOne) {
  Draws draws(5);
  int common = 0;
  for (int i = 0; i < 60; ++i) {
    const std::vector<Set> sets = draws.sets(3, -0.3 * kReach_m, true);
    StepConstraints constraints = constraints_of(open_room(true), sets);
    const Eigen::Vector3d wanted_m = draws.between(0, kReach_m) * draws.direction(true);
    const double nearest_m = search(sets, wanted_m);
    const Eigen::Vector3d step_m = constraints.nearest(wanted_m);
    ASSERT_LE(step_m.norm(), kReach_m * (1 + 1e-12));
    if (nearest_m > 1e200) continue;  // there is none
    ++common;
    EXPECT_LE(worst_by_definition(sets, step_m), 0.02 * kReach_m) << i;
  }
  EXPECT_GT(common, 40);
}

TEST(StepConstraints, WithoutACommonStepTheExcessIsSharedFairly) {
  const std::vector<Set> sets = {{{1, 0, 0}, 0, -1}, {{-1, 0, 0}, 0, -0.5}};
  StepConstraints constraints = constraints_of(open_room(true), sets);
  EXPECT_NEAR(constraints.nearest({0, 0, 0}).x(), -0.25, 1e-9);
}

TEST(StepConstraints, TheBoxIsNeverLeft) {
  Draws draws(6);
  for (int i = 0; i < 5000; ++i) {
    const Eigen::Vector3d low_m(-draws.between(0, 2), 0, 0), high_m(draws.between(0, 9), 1, 0);
    const std::vector<Set> sets = draws.sets(5, i % 2 == 0 ? 0 : -1, true);
    StepConstraints constraints = constraints_of({kReach_m, low_m, high_m}, sets);
    const Eigen::Vector3d wanted_m = draws.between(0, kReach_m) * draws.direction(true);
    const Eigen::Vector3d step_m = constraints.nearest(wanted_m);
    ASSERT_EQ(step_m, step_m.cwiseMax(low_m).cwiseMin(high_m)) << i;
    ASSERT_TRUE(i % 2 == 1 || constraints.allow(step_m)) << i;
  }
}

TEST(StepConstraints, NameTheSetThatIsExceededMost) {
  const std::vector<Set> sets = {{{1, 0, 0}, 0, 2}, {{0, 1, 0}, 0.5, 9}, {{0, 1, 0}, 0.5, 1}};
  const StepConstraints constraints = constraints_of(open_room(true), sets);
  EXPECT_EQ(constraints.most_exceeded({1, 0, 0}), -1);
  EXPECT_EQ(constraints.most_exceeded({3, 0.8, 0}), 2);
  EXPECT_EQ(constraints.most_exceeded({3, -2, 0}), 0);
  EXPECT_EQ(constraints.most_exceeded({0, 3, 0}), 2) << "numbers count sets that cost nothing";
}

/// On a contact the bound is 0 and the projection exceeds it by a rounding error. If a step were
/// shortened for that, it would be 0, and bodies would stop sliding along each other.
TEST(StepConstraints, LetABodySlideAlongAContact) {
  Draws draws(7);
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector3d toward = draws.direction(true);
    StepConstraints constraints = constraints_of(open_room(true), {{toward, 0, 0}});
    const Eigen::Vector3d along = Eigen::Vector3d(-toward.y(), toward.x(), 0);
    EXPECT_GT(constraints.nearest(2 * along + 2 * toward).dot(along), 1.9);
  }
}

}  // namespace
}  // namespace ergocast
