// SPDX-License-Identifier: BSD-3-Clause
// The theorems in a cube with eight peaks. Its planes of symmetry are the midplanes, the faces
// (about which f is even) and the diagonal planes; a line or point is where several of them meet.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "studies/theorems/bounds.h"
#include "tests/support/simulated_team.h"

namespace ergocast::test {
namespace {

constexpr double kSide_m = 1000;

/// A set of Proposition 1 by a place on it, and the normals of the planes that meet there.
struct SymmetrySet {
  const char* name;
  Eigen::Vector3d x_m;
  std::vector<Eigen::Vector3d> normals;

  double distance_m(const Eigen::Vector3d& at_m) const {
    double farthest_m = 0;
    for (const Eigen::Vector3d& normal : normals)
      farthest_m = std::max(farthest_m, std::abs(normal.normalized().dot(at_m - x_m)));
    return farthest_m;
  }
};

const Eigen::Vector3d kX(1, 0, 0), kY(0, 1, 0), kZ(0, 0, 1);

const std::vector<SymmetrySet> kSets = {
    {"midplane", {500, 310, 170}, {kX}},
    {"face", {0, 310, 170}, {kX}},
    {"diagonal plane", {310, 310, 170}, {kX - kY}},
    {"other diagonal plane", {170, 310, 690}, {kY + kZ}},
    {"two midplanes", {500, 310, 500}, {kX, kZ}},
    {"edge", {0, 310, 1000}, {kX, kZ}},
    {"midplane and face", {500, 310, 0}, {kX, kZ}},
    {"space diagonal", {310, 310, 310}, {kX - kY, kY - kZ}},
    {"centre", {500, 500, 500}, {kX, kY, kZ}},
    {"corner", {0, 1000, 0}, {kX, kY, kZ}},
};

/// One agent that begins at `x_m`, by the law of the paper without noise.
Mission classical(const Eigen::Vector3d& x_m) {
  Mission mission = shipped_mission("cube_corners");
  ControlLaw law;
  law.u_max_mps = 20;
  law.contraction_center_m = mission.domain.center_m();
  mission.law = law;
  mission.starts_m = {x_m};
  return mission;
}

/// B of (6) after one sample at `x_m`.
Eigen::Vector3d first_b(const Eigen::Vector3d& x_m) {
  lab::IdealTeam team(classical(x_m));
  team.step();
  return team.b(0);
}

TEST(Proposition1InSpace, TheFieldPointsAlongEachSetOfSymmetry) {
  const double usual = first_b({337, 353, 171}).norm();
  for (const SymmetrySet& set : kSets) {
    for (const Eigen::Vector3d& normal : set.normals) {
      EXPECT_LE(std::abs(normal.dot(first_b(set.x_m))), 1e-12 * usual) << set.name;
      const Eigen::Vector3d inward = set.x_m.dot(normal) > 500 ? -normal : normal;
      EXPECT_GE(std::abs(normal.dot(first_b(set.x_m + inward))), 1e-6 * usual) << set.name;
    }
  }
}

// This holds while rounding errors have not grown. In a point they alone give the classical law its
// direction.
TEST(Proposition1InSpace, PlanesAndLinesOfSymmetryAreInvariant) {
  for (const SymmetrySet& set : kSets) {
    if (set.normals.size() == 3) continue;
    lab::IdealTeam team(classical(set.x_m));
    for (int i = 0; i < 10; ++i) {
      team.step();
      EXPECT_LE(set.distance_m(team.x_m(0)), 1e-6) << set.name << ", tick " << i;
    }
    EXPECT_GT((team.x_m(0) - set.x_m).norm(), 1) << set.name;
  }
}

TEST(Theorem1InSpace, TheDefaultLawLeavesEachSet) {
  constexpr int kSeeds = 4;
  for (const SymmetrySet& set : kSets) {
    for (int seed = 1; seed <= kSeeds; ++seed) {
      Mission mission = shipped_mission("cube_corners");
      mission.starts_m = {set.x_m};
      mission.seed = static_cast<std::uint64_t>(seed);
      lab::IdealTeam team(mission);
      double escaped_s = 0;
      while (set.distance_m(team.x_m(0)) <= 0.01 * kSide_m && escaped_s < 60) {
        team.step();
        escaped_s = team.t_s();
      }
      EXPECT_LT(escaped_s, 30) << set.name << ", seed " << seed;
    }
  }
}

// E‖x − c‖² ≤ max{‖x(0) − c‖², u_max²/k² + 3σ²/k}. Driven outward without edges, an agent comes
// close to it, and beyond what two dimensions allow.
TEST(Theorem2InSpace, MeanSquareStaysUnderTheBoundOfThreeDimensions) {
  constexpr int kSeeds = 1000;
  ControlLaw law;
  law.u_max_mps = 1;
  law.contraction_gain_per_s = 0.1;
  law.noise_intensity = 10;
  Mission mission = studies::driven_outward(law, 0.1, 60);
  mission.domain.size_m.z() = mission.domain.size_m.x();
  mission.law.contraction_center_m.z() = 0.5 * mission.domain.size_m.z();
  mission.starts_m = {mission.law.contraction_center_m};
  const double bound_m2 = studies::mean_square_bound_m2(mission, 0);
  EXPECT_DOUBLE_EQ(bound_m2, 100 + 3 * 100 / 0.1);
  const auto squares = studies::mean_squares(mission, lab::Edges::kNone, kSeeds, 1)[0][0];
  EXPECT_LE(squares.mean_m2 + 5 * squares.standard_error_m2, bound_m2);
  // Noise alone: dσ²/(k (2 − k dt)).
  const double noise_m2 = 3 * 100 / (0.1 * (2 - 0.01));
  EXPECT_GE(squares.mean_m2 + 5 * squares.standard_error_m2, noise_m2);
  EXPECT_GE(squares.mean_m2 - 5 * squares.standard_error_m2, 100 / 0.1);
}

}  // namespace
}  // namespace ergocast::test
