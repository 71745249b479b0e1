// SPDX-License-Identifier: BSD-3-Clause
// Scenarios of a box: what their fields mean, and what a plane and a box refuse.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "core/motion/starts.h"
#include "lab/ideal_team.h"
#include "target/target.h"
#include "tests/scenario/scenarios.h"
#include "tests/support/temp_folder.h"

namespace ergocast {
namespace {

using namespace test;

const std::string kBoxScenario = R"(
domain { size_x_m: 100 size_y_m: 50 size_z_m: 40 origin_z_m: -40 }
target { uniform_weight: 1 }
law { u_max_mps: 5 }
time { duration_s: 60 }
agents { starts { x_m: 10 y_m: 20 z_m: -5 } random_count: 2 }
)";

std::string box_with(const std::string& from, const std::string& to) {
  std::string text = kBoxScenario;
  return text.replace(text.find(from), from.size(), to);
}

TEST(Space, HasItsDefaults) {
  const Mission mission = good(kBoxScenario).mission();
  EXPECT_EQ(mission.domain.origin_m, Eigen::Vector3d(0, 0, -40));
  EXPECT_EQ(mission.domain.size_m, Eigen::Vector3d(100, 50, 40));
  EXPECT_EQ(mission.basis.modes_x, 10);
  EXPECT_EQ(mission.basis.modes_y, 10);
  EXPECT_EQ(mission.basis.modes_z, 10);
  EXPECT_EQ(mission.basis.sobolev_exponent, 2);
  EXPECT_DOUBLE_EQ(mission.law.noise_ceiling, std::sqrt(5 * 0.01 * 40));
  EXPECT_EQ(mission.law.contraction_center_m, Eigen::Vector3d(50, 25, -20));
  ASSERT_EQ(mission.starts_m.size(), 3u);
  EXPECT_EQ(mission.starts_m[0], Eigen::Vector3d(10, 20, -5));
  EXPECT_EQ(mission.starts_m[2], random_start(mission.domain, mission.seed, 2));
}

TEST(Space, ReadsBackWhatItPrints) {
  const Scenario scenario = good(box_with(
      "uniform_weight: 1",
      "uniform_weight: 1 gaussians { mean_x_m: 5 mean_y_m: 6 mean_z_m: -7 sigma_m: 8 sigma_z_m: 3 }"
      "gaussians { mean_x_m: 5 mean_y_m: 6 mean_z_m: -7 covariance { xx_m2: 25 yy_m2: 25 zz_m2: 9 "
      "xz_m2: 3 yz_m2: -2 } } regions { polygon { low_z_m: -30 vertices { x_m: 10 y_m: 10 } "
      "vertices { x_m: 40 y_m: 10 } vertices { x_m: 40 y_m: 40 } } } keep_outs { high_z_m: -20 "
      "vertices { x_m: 60 y_m: 10 } vertices { x_m: 70 y_m: 10 } vertices { x_m: 70 y_m: 20 } }"));
  EXPECT_EQ(plan_of(good(Scenario::parse(scenario.print(), "again"))), plan_of(scenario));
  EXPECT_EQ(good(Scenario::parse(scenario.print(), "again")).print(), scenario.print());
}

TEST(Space, TargetAndItsCoefficientsBelongTogether) {
  const Mission mission = good(box_with("uniform_weight: 1",
                                        "uniform_weight: 0.5 gaussians { mean_x_m: 30 mean_y_m: 20 "
                                        "mean_z_m: -10 sigma_m: 9 sigma_z_m: 4 }"))
                              .mission();
  TargetDensity target;
  target.uniform_weight = 0.5;
  target.gaussians = {{1, {30, 20, -10}, Eigen::Vector3d(81, 81, 16).asDiagonal()}};
  EXPECT_EQ(mission.target_coefficients,
            target_coefficients(target, mission.domain, mission.basis).values);
}

// A map in layers is a stack of regions.
TEST(Space, AMapTimesAProfileIsTheSumOfItsLayers) {
  const TempFolder folder;
  std::ofstream(folder.path() / "half.csv") << "1,0\n";
  const std::string map =
      "maps { file: \"" + (folder.path() / "half.csv").string() +
      "\" origin_x_m: 0 origin_y_m: 0 size_x_m: 100 size_y_m: 50 "
      "layers { low_z_m: -40 high_z_m: -30 value: 3 } layers { low_z_m: -10 high_z_m: 20 } }";
  const std::string half =
      "vertices { x_m: 0 y_m: 0 } vertices { x_m: 50 y_m: 0 } vertices { x_m: 50 y_m: 50 } "
      "vertices { x_m: 0 y_m: 50 } } }";
  const std::string regions = "regions { weight: 30 polygon { low_z_m: -40 high_z_m: -30 " + half +
                              "regions { weight: 30 polygon { low_z_m: -10 high_z_m: 20 " + half;
  const auto mu = [](const std::string& target) {
    return good(box_with("uniform_weight: 1", target)).mission().target_coefficients;
  };
  EXPECT_LE((mu(map) - mu(regions)).cwiseAbs().maxCoeff(), 1e-13);
}

struct MistakeInSpace {
  std::string from, to, printed;
};

std::string all_said_of(const std::string& text) {
  const Loaded loaded = Scenario::parse(text, "f");
  if (loaded) return "nothing";
  std::string all;
  for (const Problem& problem : loaded.error()) all += to_string(problem) + '\n';
  return all;
}

TEST(Space, RefusesEachMistakeOnceWithItsLine) {
  const std::string uniform = "uniform_weight: 1", bell = "gaussians { mean_x_m: 5 mean_y_m: 5 ";
  const std::string prism =
      "vertices { x_m: 10 y_m: 10 } vertices { x_m: 40 y_m: 10 } vertices { x_m: 40 y_m: 40 } } }";
  const std::vector<MistakeInSpace> mistakes = {
      {"size_z_m: 40", "size_z_m: 0", "f:2:37: domain.size_z_m: 0 is below the limit 0.001"},
      {"origin_z_m: -40", "origin_z_m: -4.1e6",
       "f:2:50: domain.origin_z_m: -4100000 is more than 4000000 m"},
      {" z_m: -5", "",
       "f:6:10: agents.starts[0].z_m: is missing (add z_m, in the domain, -40 to 0"},
      {"z_m: -5", "z_m: 1", "f:6:35: agents.starts[0].z_m: 1 is outside the domain"},
      {"law {", "basis { modes_x: 17 modes_y: 17 modes_z: 17 } law {",
       "basis: 4913 modes are above the limit 4096"},
      {"u_max_mps: 5", "u_max_mps: 401", "makes u_max_mps · dt_s 40.1 m, above the limit"},
      {uniform, bell + "sigma_m: 5 }", "target.gaussians[0].mean_z_m: is missing"},
      {uniform, bell + "mean_z_m: -5 covariance { xx_m2: 9 yy_m2: 9 } }",
       "target.gaussians[0].covariance.zz_m2: is missing"},
      {uniform, bell + "mean_z_m: -5 sigma_m: 5 sigma_z_m: 1e-3 }",
       "target.gaussians[0].sigma_z_m: 0.001 is below"},
      {uniform, bell + "mean_z_m: -5 sigma_z_m: 5 covariance { xx_m2: 9 yy_m2: 9 zz_m2: 9 } }",
       "target.gaussians[0].sigma_z_m: has no effect with covariance"},
      {uniform, bell + "mean_z_m: -5 covariance { xx_m2: 9 yy_m2: 9 zz_m2: 9 xz_m2: -9 } }",
       "target.gaussians[0].covariance.xz_m2: -9 leaves too little"},
      {uniform,
       bell +
           "mean_z_m: -5 covariance { xx_m2: 9 yy_m2: 9 zz_m2: 9 xy_m2: 6 xz_m2: 6 yz_m2: -6 } }",
       "target.gaussians[0].covariance: is not positive definite enough"},
      {uniform, "regions { polygon { low_z_m: -10 high_z_m: -20 " + prism,
       "target.regions[0].polygon: its heights -10 to -20 m enclose nothing"},
      {uniform, "regions { polygon { low_z_m: 10 high_z_m: 20 " + prism,
       "target.regions[0].polygon: its heights 10 to 20 m are outside the domain"},
  };
  for (const MistakeInSpace& mistake : mistakes) {
    const std::string printed = all_said_of(box_with(mistake.from, mistake.to));
    EXPECT_NE(printed.find(mistake.printed), std::string::npos)
        << mistake.to << " says " << printed;
    EXPECT_EQ(std::ranges::count(printed, '\n'), 1) << printed;
  }
}

TEST(Space, APlaneRefusesEachFieldOfABox) {
  const std::string bell = "gaussians { mean_x_m: 5 mean_y_m: 5 ";
  const std::vector<MistakeInSpace> mistakes = {
      {"domain { ", "domain { origin_z_m: 5 ", "domain.origin_z_m: the domain is a plane"},
      {"law {", "basis { modes_z: 2 } law {", "basis.modes_z: the domain is a plane"},
      {"law {", "law { contraction_z_m: 2 ", "law.contraction_z_m: the domain is a plane"},
      {"y_m: 20", "y_m: 20 z_m: 3", "agents.starts[0].z_m: the domain is a plane"},
      {"uniform_weight: 1", bell + "mean_z_m: 5 sigma_m: 5 }",
       "target.gaussians[0].mean_z_m: the domain is a plane"},
      {"uniform_weight: 1", bell + "covariance { xx_m2: 9 yy_m2: 9 zz_m2: 9 } }",
       "target.gaussians[0].covariance.zz_m2: the domain is a plane"},
  };
  for (const MistakeInSpace& mistake : mistakes) {
    const std::string printed = all_said_of(small_with(mistake.from, mistake.to));
    EXPECT_NE(printed.find(mistake.printed + " (remove it, or add size_z_m to the domain)"),
              std::string::npos)
        << printed;
    EXPECT_EQ(std::ranges::count(printed, '\n'), 1) << printed;
  }
}

// With one mode along z the field has no part along z: only noise and contraction move an agent up
// and down, and x and y are those of the plane. (A forecast's horizon counts the box's height.)
TEST(Space, AFlatBoxHasThePlanesTrajectory) {
  const std::string plane = R"(
domain { size_x_m: 100 size_y_m: 50 }
target {
  uniform_weight: 0.3
  regions { polygon { vertices { x_m: 10 y_m: 5 } vertices { x_m: 40 y_m: 8 } vertices { x_m: 15 y_m: 40 } } }
}
basis { modes_x: 8 modes_y: 8 sobolev_exponent: 1.5 }
law {
  u_max_mps: 5 noise_intensity: 0.1 noise_ceiling: 0.5 contraction_gain_per_s: 1e-3 anticipation: 0
}
time { duration_s: 120 }
agents { starts { x_m: 0 y_m: 0 } starts { x_m: 50 y_m: 25 } }
)";
  std::string box = plane;
  const auto put = [&box](const std::string& before, const std::string& text) {
    box.insert(box.find(before), text);
  };
  put("size_y_m", "size_z_m: 4 ");
  put("sobolev", "modes_z: 1 ");
  put("} starts { x_m: 50", "z_m: 1 ");
  put("x_m: 50 y_m: 25", "z_m: 3 ");
  lab::IdealTeam flat(good(box).mission()), twin(good(plane).mission());
  double farthest_m = 0;
  while (twin.tick() < twin.mission().timing.tick_count) {
    flat.step();
    twin.step();
    for (std::size_t i = 0; i < 2; ++i)
      farthest_m = std::max(farthest_m, (flat.x_m(i) - twin.x_m(i)).head<2>().norm());
  }
  EXPECT_EQ(farthest_m, 0);
  EXPECT_NE(flat.x_m(0).z(), 1);
}

}  // namespace
}  // namespace ergocast
