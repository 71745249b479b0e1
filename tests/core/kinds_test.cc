// SPDX-License-Identifier: BSD-3-Clause
// What a kind's sensor sees, how its rows count, and by which modes it steers.
#include "core/mission/kinds.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/law/control.h"
#include "core/law/coverage_table.h"
#include "core/motion/vehicle.h"
#include "plan/mission_limits.h"

namespace ergocast {
namespace {

constexpr double kDt_s = 0.5;

Mission mission_of(bool planar) {
  Mission mission;
  mission.name = "kinds";
  mission.domain = {{-3, 4, 0}, {40, 25, planar ? 0.0 : 30.0}};
  mission.basis.modes_x = 6;
  mission.basis.modes_y = 5;
  mission.basis.modes_z = planar ? 1 : 4;
  mission.target_coefficients = Coefficients::Zero(mission.basis.mode_count());
  mission.target_coefficients[0] = 1;
  mission.law.u_max_mps = 3;
  mission.timing.dt_s = kDt_s;
  mission.timing.tick_count = 100;
  mission.starts_m = {{0, 5, 0}, {1, 6, 0}, {2, 7, 0}};
  mission.kinds = {{"fast", 2, 3, 0, 0, 4, 0.5}, {"fine", 1, 1, 0, 0, 0, 2, 2, 4}};
  return mission;
}

/// The mean of f over a Gaussian of deviation `sigma_m` around a place, with sides that reflect.
Coefficients blurred(const Mission& mission, const Eigen::Vector3d& x_m, double sigma_m) {
  constexpr int kSteps = 24;
  constexpr double kReach = 7;  // deviations
  const int steps_z = mission.domain.planar() ? 0 : kSteps;
  Coefficients sum = Coefficients::Zero(mission.basis.mode_count());
  double weight = 0;
  for (int i = -kSteps; i <= kSteps; ++i) {
    for (int j = -kSteps; j <= kSteps; ++j) {
      for (int k = -steps_z; k <= steps_z; ++k) {
        const Eigen::Vector3d away = kReach / kSteps * Eigen::Vector3d(i, j, k);
        const double share = std::exp(-0.5 * away.squaredNorm());
        const Eigen::Vector3d seen_m = reflect(x_m + sigma_m * away, mission.domain);
        sum += share * basis_values(seen_m, mission.domain, mission.basis);
        weight += share;
      }
    }
  }
  return sum / weight;
}

TEST(Kinds, AFootprintIsAGaussianBetweenReflectingSides) {
  for (const bool planar : {true, false}) {
    const Mission mission = mission_of(planar);
    const double sigma_m = 4;
    const Eigen::Vector3d x_m(-1, 27, planar ? 0 : 2);  // near the sides
    const Coefficients g = footprint_of(mission.basis, mission.domain, sigma_m);
    const Coefficients seen = basis_values(x_m, mission.domain, mission.basis).cwiseProduct(g);
    EXPECT_LT((seen - blurred(mission, x_m, sigma_m)).cwiseAbs().maxCoeff(), 1e-9);
    EXPECT_EQ(g[0], 1);
  }
}

TEST(Kinds, ASampleOfAFootprintIsScaledAndItsTimeIsNot) {
  const Mission mission = mission_of(false);
  const Sensors sensors(mission);
  CoverageTable table(mission.basis, kDt_s);
  const Author author{0, 7};
  const BasisAt at({5, 6, 7}, mission.domain, mission.basis);
  table.add_row(author);
  table.add_sample(author, at, sensors.of(0).footprint());
  table.add_sample(author, at, sensors.of(0).footprint());
  const Coefficients f = basis_values({5, 6, 7}, mission.domain, mission.basis);
  const double* sums = table.sums_of(author);
  EXPECT_EQ(sums[0], 2 * kDt_s);
  for (Eigen::Index k = 0; k < f.size(); ++k)
    EXPECT_NEAR(sums[k], 2 * kDt_s * f[k] * sensors.of(0).g[k], 1e-12);
  CoverageTable other(mission.basis, kDt_s);
  for (int b = 0; b < table.block_count(); ++b)
    EXPECT_EQ(other.merge(table.block(author, b), 10), Merge::kNewer);
}

TEST(Kinds, RowsCountByTimeAndQuality) {
  const Mission mission = mission_of(true);
  CoverageTable table(mission.basis, kDt_s);
  const Author author[] = {{0, 7}, {0, 8}, {1, 9}};
  const double quality[] = {0.5, 2, 1};
  const Eigen::Vector3d place_m[] = {{5, 6, 0}, {20, 20, 0}, {30, 10, 0}};
  Coefficients sums = Coefficients::Zero(mission.basis.mode_count());
  double time_s = 0;
  for (int i = 0; i < 3; ++i) {
    table.add_row(author[i]);
    table.set_quality(author[i], quality[i]);
    for (int n = 0; n <= i; ++n) {
      table.add_sample(author[i], BasisAt(place_m[i], mission.domain, mission.basis));
      sums += quality[i] * kDt_s * basis_values(place_m[i], mission.domain, mission.basis);
      time_s += quality[i] * kDt_s;
    }
  }
  Coefficients c = Coefficients::Zero(mission.basis.mode_count());
  table.average(c);
  EXPECT_LT((c - sums / time_s).cwiseAbs().maxCoeff(), 1e-14);
  EXPECT_DOUBLE_EQ(table.covered_s(), time_s);
  EXPECT_NEAR(c[0], 1, 1e-15);
}

TEST(Kinds, AnAgentSteersByTheModesOfItsBandAsFarAsItSeesThem) {
  const Mission mission = mission_of(false);
  const Coefficients all = sobolev_weights(mission.basis, mission.domain);
  const Coefficients g = footprint_of(mission.basis, mission.domain, 4);
  EXPECT_EQ(steering_weights(mission, 0), all.cwiseProduct(g));
  const Coefficients banded = steering_weights(mission, 1);
  int k = 0;
  for (int l = 0; l < 4; ++l) {
    for (int m = 0; m < 6; ++m) {
      for (int n = 0; n < 5; ++n, ++k) {
        const int squared = l * l + m * m + n * n;
        EXPECT_EQ(banded[k], squared >= 4 && squared <= 16 ? all[k] : 0) << l << m << n;
      }
    }
  }
}

TEST(Kinds, EachHasItsOwnSpeedAndPhiIsOfAllModes) {
  Mission mission = mission_of(true);
  for (const int kind : {0, 1}) {
    Controller controller(mission, kind);
    Coefficients c = mission.target_coefficients;
    c[6] = 0.5;    // |k| = √2, which the second kind does not steer by
    c[12] = 0.25;  // |k| = √8, which it does
    controller.set_coverage(c);
    const Eigen::Vector3d x_m(7, 8, 0);
    const Eigen::Vector3d v_mps =
        controller.command(0, 3, x_m, BasisAt(x_m, mission.domain, mission.basis));
    EXPECT_NEAR(v_mps.norm(), mission.kinds[static_cast<std::size_t>(kind)].u_max_mps, 1e-12);
    const Coefficients weights = sobolev_weights(mission.basis, mission.domain);
    EXPECT_EQ(controller.metric(c), ergodic_metric(c, mission.target_coefficients, weights));
  }
}

TEST(Kinds, ThePlanGivesNumbersInTheOrderOfTheKinds) {
  const Mission mission = mission_of(true);
  EXPECT_EQ(planned_kind(mission, 0), 0);
  EXPECT_EQ(planned_kind(mission, 1), 0);
  EXPECT_EQ(planned_kind(mission, 2), 1);
  EXPECT_EQ(planned_kind(mission, 3), 0) << "beyond the plan";
  EXPECT_EQ(kind_named(mission, "fine"), 1);
  EXPECT_EQ(why_not_of_kind(mission, "fine", 0), std::nullopt);
  EXPECT_EQ(why_not_of_kind(mission, "", kUnassigned), std::nullopt);
  EXPECT_EQ(why_not_of_kind(mission, "slow", kUnassigned),
            "the mission has no kind \"slow\": its kinds are fast, fine");
  EXPECT_EQ(why_not_of_kind(Mission(), "slow", 0),
            "the mission has no kind \"slow\": all its agents are alike, so name none");
}

TEST(Kinds, DriveOnlyBodiesThatMoveAsTheirs) {
  Mission mission = mission_of(true);
  mission.speed_limit_mps = 20;
  EXPECT_TRUE(can_drive(mission, 1, 0)) << "both move alike";
  mission.kinds[1].speed_limit_mps = 10;
  EXPECT_EQ(motion_of(mission, 0).speed_limit_mps, 20);
  EXPECT_EQ(motion_of(mission, 2).speed_limit_mps, 10);
  EXPECT_EQ(motion_of(mission, 3).speed_limit_mps, 20) << "beyond the plan";
  EXPECT_EQ(fastest_mps(mission), 20);
  EXPECT_FALSE(can_drive(mission, 1, 0));
  EXPECT_FALSE(can_drive(mission, 1, 3));
  EXPECT_EQ(why_not_of_kind(mission, "fine", 2), std::nullopt);
  EXPECT_EQ(why_not_of_kind(mission, "fine", kUnassigned), std::nullopt);
  EXPECT_EQ(
      why_not_of_kind(mission, "fine", 0),
      "an agent of the kind \"fine\" cannot drive number 0: that is a vehicle of the kind fast");
  mission.kinds[1] = {"fine", 1, mission.kinds[1].u_max_mps};
  mission.kinds[1].vehicle = {VehicleKind::kAcceleration, 5};
  EXPECT_TRUE(any_but_points(mission));
  EXPECT_TRUE(motion_of(mission, 0).is_point());
  EXPECT_TRUE(motion_of(mission, 2).has_inertia());
  EXPECT_EQ(motion_of(mission, 2).speed_limit_mps, 20);
  EXPECT_FALSE(can_drive(mission, 0, 2));
}

TEST(Kinds, AMissionHasNoImpossibleOnes) {
  EXPECT_TRUE(within_limits(mission_of(true)));
  const auto refused = [](auto spoil) {
    Mission mission = mission_of(true);
    spoil(mission.kinds);
    return !within_limits(mission);
  };
  using Kinds = std::vector<AgentKind>;
  EXPECT_TRUE(refused([](Kinds& kinds) { kinds[0].count = 1; }));
  EXPECT_TRUE(refused([](Kinds& kinds) { kinds[1].name = "fast"; }));
  EXPECT_TRUE(refused([](Kinds& kinds) { kinds[1].name = ""; }));
  EXPECT_TRUE(refused([](Kinds& kinds) { kinds[1].name = std::string(32, 'a'); }));
  EXPECT_TRUE(refused([](Kinds& kinds) { kinds[0].footprint_sigma_m = 41; }));
  EXPECT_TRUE(refused([](Kinds& kinds) { kinds[0].footprint_sigma_m = -1; }));
  EXPECT_TRUE(refused([](Kinds& kinds) { kinds[0].quality = 0; }));
  EXPECT_TRUE(refused([](Kinds& kinds) { kinds[1].band_from = 50, kinds[1].band_to = 0; }));
  EXPECT_TRUE(refused([](Kinds& kinds) { kinds[1].band_from = 4, kinds[1].band_to = 3; }));
  EXPECT_TRUE(refused([](Kinds& kinds) { kinds[1].u_max_mps = 51; }));
  EXPECT_TRUE(refused([](Kinds& kinds) {
    kinds[0].count = 1;
    for (int i = 0; i < kMaxKinds; ++i) kinds.push_back({"k" + std::to_string(i), 1, 1});
  }));
}

}  // namespace
}  // namespace ergocast
