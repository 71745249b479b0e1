// SPDX-License-Identifier: BSD-3-Clause
#include "core/motion/detour.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/base/geometry.h"
#include "core/motion/separation.h"
#include "core/motion/way_home.h"

namespace ergocast {
namespace {

using Places = std::vector<Eigen::Vector2d>;

/// Agent 0 goes from (48, 28) to its station at (10, 10), and others stand.
Mission with_station() {
  Mission mission;
  mission.domain.size_m = {60, 40, 0};
  mission.law.u_max_mps = 3;
  mission.speed_limit_mps = 4;
  mission.timing.dt_s = 0.1;
  mission.timing.tick_count = 1200;
  mission.separation.distance_m = 2;
  mission.starts_m = {{48, 28, 0}};
  mission.kinds = {{"a", 1, 3, 0, 0}};
  mission.kinds[0].stations_m = {{10, 10, 0}};
  return mission;
}

/// How far from its station agent 0 is after `duration_s`, if it knows that the others stand for
/// good or not.
double apart_m(const Places& standing_m, bool known, double duration_s) {
  const Mission mission = with_station();
  WayHome way(mission, 0);
  SeparationFilter filter(mission, 0);
  std::vector<Neighbour> others;
  way.detour().begin(standing_m.size());
  for (const Eigen::Vector2d& place_m : standing_m) {
    const auto id = static_cast<AgentId>(others.size() + 1);
    others.push_back({id, on_ground(place_m), 4});
    if (known) way.detour().add(place_m, filter.contact_m(0, id));
  }
  Eigen::Vector3d x_m = mission.starts_m[0];
  for (Tick tick = 0; static_cast<double>(tick) * mission.timing.dt_s < duration_s; ++tick) {
    const Mover self{0, tick, x_m, 4};
    x_m += mission.timing.dt_s *
           filter.safe(self, way.velocity_mps(x_m, {0, 0, 0}), others).velocity_mps;
  }
  return length_of(x_m - mission.kinds[0].stations_m[0]);
}

// The straight way takes 14 s.
TEST(Detour, LeadsOutOfAPocketOfTwoBodies) {
  const Places pocket = {{39, 26}, {41, 22.8}};
  EXPECT_GT(apart_m(pocket, false, 60), 30);
  EXPECT_LT(apart_m(pocket, true, 17), 1e-9);
}

TEST(Detour, LeadsOutOfADeepPocket) {
  const Places pocket = {{42, 30}, {39, 28}, {38, 25}, {39.5, 22}, {43, 20.5}};
  EXPECT_GT(apart_m(pocket, false, 60), 30);
  EXPECT_LT(apart_m(pocket, true, 25), 1e-9);
}

// It has to turn less to the north, where the fence ends at the edge of the domain.
TEST(Detour, TriesTheOtherSideWhereItGetsHardlyFurther) {
  const Places fence = {{40, 39},   {40, 35.5}, {40, 32}, {40, 28.5}, {40, 25},
                        {41.5, 22}, {44, 19.5}, {47, 18}, {50.5, 17}, {53.5, 17.5}};
  EXPECT_GT(apart_m(fence, false, 60), 30);
  EXPECT_LT(apart_m(fence, true, 45), 1e-9);
}

TEST(Detour, EndsBesideABodyThatStandsAtTheStation) {
  EXPECT_LT(apart_m({{10.5, 10}, {39, 26}, {41, 22.8}}, true, 25), 1.6);
}

TEST(Detour, LeavesAFreeWayAsItIs) {
  Detour detour(20, 0.3);
  const Eigen::Vector2d x_m(0, 0), way_m(10, 0.1);
  EXPECT_EQ(detour.round(x_m, way_m), way_m);
  detour.begin(3);
  detour.add({5, 2.2}, 2);   // beside the way
  detour.add({-1, 0}, 2);    // behind
  detour.add({13, 0.1}, 2);  // beyond the end
  EXPECT_EQ(detour.round(x_m, way_m), way_m);
  detour.add({5, 1.9}, 2);
  const Eigen::Vector2d round_m = detour.round(x_m, way_m);
  EXPECT_NEAR(round_m.norm(), way_m.norm(), 1e-12);
  EXPECT_LT(round_m.y(), 0);
}

}  // namespace
}  // namespace ergocast
