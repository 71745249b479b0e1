// SPDX-License-Identifier: BSD-3-Clause
// The control step on a box: the law term by term, teams that move in it, and the plane as the case
// without a height or without a second mode.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/noise.h"
#include "core/law/control.h"
#include "core/motion/starts.h"
#include "lab/ideal_team.h"

namespace ergocast {
namespace {

/// Four agents in a box of 300 m × 200 m × 80 m. The target is that of many places, most of them
/// near one corner.
Mission space_mission() {
  Mission mission;
  mission.seed = 3;
  mission.domain = {{-30, 50, 10}, {300, 200, 80}};
  mission.basis = {.modes_x = 6, .modes_y = 5, .modes_z = 4};
  mission.target_coefficients = Coefficients::Zero(mission.basis.mode_count());
  constexpr int kPlaces = 200;
  for (std::uint64_t i = 0; i < kPlaces; ++i) {
    const Eigen::Vector3d share =
        uniform_in({{0, 0, 0}, {1, 1, 1}}, 9, Purpose::kStart, 0, i).cwiseAbs2();
    const Eigen::Vector3d x_m = mission.domain.origin_m + share.cwiseProduct(mission.domain.size_m);
    mission.target_coefficients += basis_values(x_m, mission.domain, mission.basis) / kPlaces;
  }
  mission.law.u_max_mps = 12;
  mission.law.regularization = Regularization::kRelative;
  mission.law.epsilon = 0.05;
  mission.law.contraction_gain_per_s = 1e-3;
  mission.law.contraction_center_m = {100, 120, 40};
  mission.timing.dt_s = 0.125;
  mission.timing.tick_count = 2000;
  for (AgentId id = 0; id < 4; ++id)
    mission.starts_m.push_back(random_start(mission.domain, 5, id));
  return mission;
}

Mission pushed(Mission mission) {
  mission.law.perturbation = Perturbation::kAdaptive;
  mission.law.noise_intensity = 0.5;
  mission.law.noise_ceiling = 10;
  return mission;
}

TEST(CommandInSpace, IsTheLawTermByTerm) {
  Mission mission = space_mission();
  mission.law.noise_intensity = 0.5;
  Controller controller(mission);
  const Coefficients coverage = basis_values({10, 80, 30}, mission.domain, mission.basis);
  controller.set_coverage(coverage);
  const Coefficients residual = sobolev_weights(mission.basis, mission.domain)
                                    .cwiseProduct(coverage - mission.target_coefficients);
  for (std::uint64_t i = 0; i < 50; ++i) {
    const Eigen::Vector3d x_m = uniform_in(mission.domain, 1, Purpose::kStart, 0, i);
    const BasisAt at(x_m, mission.domain, mission.basis);
    const Eigen::Vector3d b = weighted_gradient(at, mission.basis, residual.data());
    const Eigen::Vector3d xi =
        normal_in(mission.domain, mission.seed, Purpose::kPerturbation, 2, i);
    const Eigen::Vector3d expected =
        -12 * b / std::sqrt(b.squaredNorm() + std::pow(controller.epsilon(), 2)) -
        1e-3 * (x_m - Eigen::Vector3d(100, 120, 40)) + 0.5 / std::sqrt(0.125) * xi;
    const Eigen::Vector3d v_mps = controller.command(2, static_cast<Tick>(i), x_m, at);
    EXPECT_LT((v_mps - expected).norm(), 1e-11) << i;
    EXPECT_LT((controller.spectral_gradient() - b).norm(), 1e-13 * b.norm());
  }
}

// The RMS is taken as if all sides were as long as the longest.
TEST(CommandInSpace, RelativeEpsilonIsAShareOfTheResidualGradientsRms) {
  const Mission mission = space_mission();
  Controller controller(mission);
  const Coefficients coverage = basis_values({10, 80, 30}, mission.domain, mission.basis);
  controller.set_coverage(coverage);
  double square = 0;
  constexpr int kPoints = 12;  // exact for products of two modes
  for (int i = 0; i < kPoints * kPoints * kPoints; ++i) {
    const Eigen::Vector3d share(i % kPoints + 0.5, i / kPoints % kPoints + 0.5,
                                i / kPoints / kPoints + 0.5);
    const Eigen::Vector3d x_m =
        mission.domain.origin_m + share.cwiseProduct(mission.domain.size_m) / kPoints;
    controller.command(0, 0, x_m, BasisAt(x_m, mission.domain, mission.basis));
    const Eigen::Vector3d stretched = mission.domain.size_m / mission.domain.size_m.maxCoeff();
    square += controller.spectral_gradient().cwiseProduct(stretched).squaredNorm();
  }
  EXPECT_NEAR(controller.epsilon() / (0.05 * std::sqrt(square / std::pow(kPoints, 3))), 1, 1e-12);
}

// A team is chaotic: at one tick of one seed, the last bit of a sine decides by how much φ² has
// fallen.
TEST(TeamInSpace, CoversTheBoxAndNeverLeavesIt) {
  for (const double anticipation : {0.0, 2.0}) {
    Mission mission = pushed(space_mission());
    mission.law.anticipation = anticipation;
    std::vector<double> left;
    for (mission.seed = 1; mission.seed <= 7; ++mission.seed) {
      lab::IdealTeam team(mission);
      team.step();
      const double at_first = team.metric();
      Eigen::Vector3d low = mission.domain.center_m(), high = low;
      team.run_until(200, [&] {
        for (std::size_t i = 0; i < team.size(); ++i) {
          ASSERT_TRUE(mission.domain.contains(team.x_m(i))) << team.x_m(i).transpose();
          low = low.cwiseMin(team.x_m(i));
          high = high.cwiseMax(team.x_m(i));
        }
      });
      left.push_back(team.metric() / at_first);
      EXPECT_GT(((high - low).cwiseQuotient(mission.domain.size_m)).minCoeff(), 0.9);
    }
    std::ranges::nth_element(left, left.begin() + 3);
    EXPECT_LT(left[3], 1.0 / 50) << anticipation;
  }
}

/// The same team above the ground of a box and on the ground alone.
TEST(TeamInAPlane, MovesAsInABoxWithOneModeAlongZBitForBit) {
  Mission high = pushed(space_mission());
  high.basis.modes_z = 1;
  high.target_coefficients = high.target_coefficients.head(high.basis.mode_count()).eval();
  Mission flat = high;
  flat.domain.origin_m.z() = flat.domain.size_m.z() = flat.law.contraction_center_m.z() = 0;
  for (Eigen::Vector3d& x_m : flat.starts_m) x_m.z() = 0;
  lab::IdealTeam above(high), below(flat);
  for (int tick = 0; tick < 500; ++tick) {
    above.step();
    below.step();
    for (std::size_t i = 0; i < below.size(); ++i) {
      ASSERT_EQ(above.x_m(i).head<2>(), below.x_m(i).head<2>()) << tick;
      ASSERT_EQ(below.x_m(i).z(), 0);
      ASSERT_EQ(below.v_mps(i).z(), 0);
      ASSERT_FALSE(std::signbit(below.v_mps(i).z())) << "messages carry 0 and not −0";
    }
  }
}

TEST(TeamInAPlane, SendsNoNegativeZeroUpwards) {
  for (const double gain_per_s : {0.0, 1e-3}) {
    for (const double intensity : {0.0, 0.5}) {
      Mission mission = space_mission();
      mission.basis.modes_z = 1;
      mission.target_coefficients = mission.target_coefficients.head(30).eval();
      mission.domain.origin_m.z() = mission.domain.size_m.z() = 0;
      mission.law.contraction_center_m.z() = 0;
      mission.law.contraction_gain_per_s = gain_per_s;
      mission.law.noise_intensity = intensity;
      Controller controller(mission);
      controller.set_coverage(basis_values({10, 80, 0}, mission.domain, mission.basis));
      const Eigen::Vector3d x_m(40, 70, 0);
      const auto v_mps = controller.command(0, 1, x_m, BasisAt(x_m, mission.domain, mission.basis));
      EXPECT_EQ(v_mps.z(), 0);
      EXPECT_FALSE(std::signbit(v_mps.z()));
    }
  }
}

}  // namespace
}  // namespace ergocast
