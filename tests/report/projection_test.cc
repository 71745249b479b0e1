// SPDX-License-Identifier: BSD-3-Clause
// A view of a box is a mission in a plane: its coverage and target are averages along the third
// axis.
#include "report/projection.h"

#include <gtest/gtest.h>

#include "report/figures.h"

namespace ergocast {
namespace {

Mission box_mission() {
  Mission mission;
  mission.domain = {{-3, 5, 40}, {300, 200, 80}};
  mission.basis = {.modes_x = 4, .modes_y = 3, .modes_z = 5};
  mission.target_coefficients = Coefficients::Unit(mission.basis.mode_count(), 0);
  mission.starts_m = {{10, 20, 50}};
  return mission;
}

// For any samples, the mean of f along an axis without waves is f in the plane.
TEST(Projection, KeepsTheCoverageInItsPlane) {
  const Mission mission = box_mission();
  const Eigen::Vector3d x_m(17, 90, 61);
  const Coefficients coverage = basis_values(x_m, mission.domain, mission.basis);
  for (const View& view : views_of(mission.domain)) {
    const Mission seen = projected(mission, view);
    const Eigen::Vector3d seen_m(x_m[view.across], x_m[view.up], 0);
    const Coefficients expected = basis_values(seen_m, seen.domain, seen.basis);
    EXPECT_LE((projected(coverage, mission.basis, view) - expected).cwiseAbs().maxCoeff(), 1e-14)
        << view.ending();
    EXPECT_EQ(seen.starts_m[0].x(), mission.starts_m[0][view.across]);
  }
}

TEST(Projection, GivesAFigureForEachView) {
  RunData run;
  run.tracks[0] = {{0, 0, {10, 20, 50}, {1, 0, 0}}, {1, 0.1, {11, 20, 50}, {1, 0, 0}}};
  const Mission mission = box_mission();
  std::vector<std::string> names;
  for (const Figure& figure : draw_figures(run, mission, {})) names.push_back(figure.name);
  EXPECT_EQ(names, (std::vector<std::string>{"trajectories", "trajectories_xz", "trajectories_yz",
                                             "ergodic_metric", "coverage", "coverage_xz",
                                             "coverage_yz", "coefficients", "coefficients_xz",
                                             "coefficients_yz", "speeds", "communication"}));
  Mission plane = mission;
  plane.domain.size_m.z() = plane.domain.origin_m.z() = 0;
  plane.basis.modes_z = 1;
  plane.target_coefficients.conservativeResize(12);
  EXPECT_EQ(draw_figures(run, plane, {}).size(), 6u);
}

}  // namespace
}  // namespace ergocast
