// SPDX-License-Identifier: BSD-3-Clause
// Bodies that keep a distance: attacks on the filter, each with the flaws that it detects.
#include "core/motion/separation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "core/motion/filter_rules.h"
#include "core/motion/starts.h"
#include "core/motion/vehicle.h"
#include "tests/core/crowd.h"

namespace ergocast {
namespace {

using test::Attack;
using test::Crowd;
using test::Flaw;

double spare_m(Attack attack, Flaw flaw = Flaw::kNone) {
  attack.flaw = flaw;
  return Crowd(attack).least_spare_m();
}

Mission team_mission() {
  Mission mission;
  mission.seed = 7;
  mission.domain.size_m = {2000, 2000, 0};
  mission.speed_limit_mps = 40;
  mission.separation.distance_m = 30;
  return mission;
}

TEST(Separation, HoldsInACrowd) {
  const Attack attack;
  EXPECT_GE(spare_m(attack), 0);
  EXPECT_LT(spare_m(attack, Flaw::kWholeGap), -1);
  EXPECT_LT(spare_m(attack, Flaw::kFirstTwo), -10);
}

TEST(Separation, HoldsAtTheEdges) {
  Attack attack;
  attack.beyond_edges = true;
  EXPECT_GE(spare_m(attack), 0);
  EXPECT_LT(spare_m(attack, Flaw::kEdgesAfterwards), -1);
}

TEST(Separation, HoldsInSpace) {
  Attack attack;
  attack.in_space = true;
  attack.bodies = 30;
  attack.ticks = 600;
  EXPECT_GE(spare_m(attack), 0);
  EXPECT_LT(spare_m(attack, Flaw::kWholeGap), -1);
}

TEST(Separation, HoldsWherePositionsAreLost) {
  Attack attack;
  attack.loss = 0.5;
  attack.compute_each = 1;
  EXPECT_GE(spare_m(attack), 0);
  EXPECT_LT(spare_m(attack, Flaw::kNoAge), -1);
  EXPECT_LT(spare_m(attack, Flaw::kHalfAge), -0.5);
  attack.loss = 0.9;
  EXPECT_GE(spare_m(attack), 0);
}

TEST(Separation, HoldsWhileCommandsAreHeldOrLate) {
  Attack attack;
  attack.max_speed_mps = 15;
  attack.hold_ticks = 3;
  attack.compute_each = 3;
  attack.side_m = 300;
  EXPECT_GE(spare_m(attack), 0);
  EXPECT_LT(spare_m(attack, Flaw::kNoHold), -1);
  attack.compute_each = 1;
  attack.late = 0.3;
  attack.loss = 0.3;
  EXPECT_GE(spare_m(attack), 0);
  EXPECT_LT(spare_m(attack, Flaw::kNoHold), -0.3);
}

TEST(Separation, HoldsWithPositionErrors) {
  Attack attack;
  attack.error_m = 1;
  EXPECT_GE(spare_m(attack), 0);
  EXPECT_LT(spare_m(attack, Flaw::kNoError), -0.5);
}

TEST(Separation, HoldsForBodiesOfDifferentSpeeds) {
  Attack attack;
  attack.slowest_mps = 4;
  EXPECT_GE(spare_m(attack), 0);
  EXPECT_LT(spare_m(attack, Flaw::kWholeGap), -0.5);
}

TEST(Separation, HoldsWhereBodiesForgetEachOther) {
  Attack attack;
  attack.forget = 0.05;
  attack.loss = 0.3;
  EXPECT_GE(spare_m(attack), 0);
  EXPECT_LT(spare_m(attack, Flaw::kUnknownIgnored), -1);
}

TEST(Separation, HoldsWhereAllWantOnePlace) {
  Attack attack;
  attack.bodies = 40;
  attack.side_m = 600;
  attack.ticks = 600;
  attack.all_to_one = true;
  EXPECT_GE(spare_m(attack), 0);
}

TEST(Separation, HoldsUnderRandomDisturbances) {
  Attack attack;
  attack.disturbance_m = 0.5;
  EXPECT_GE(spare_m(attack), 0);
  EXPECT_LT(spare_m(attack, Flaw::kNoMargin), -0.5);
}

// ---- the function itself ----

const std::vector<Neighbour> kFar = {{1, {900, 500, 0}, 40}, {2, {500, 900, 0}, 40}};

TEST(Separation, ChangesNoBitOfACommandWithNoBodyNear) {
  SeparationFilter filter(team_mission(), 0);
  const Mover self{0, 3, {500, 500, 0}, 40};
  for (const Eigen::Vector3d& v : {Eigen::Vector3d(0.1, 0.7, 0), {-40, 0, 0}, {300, -200, 0}}) {
    const SafeVelocity safe = filter.safe(self, v, kFar);
    EXPECT_EQ(safe.velocity_mps, v) << "the world cuts it, as it does without a distance";
    EXPECT_FALSE(safe.blocked);
  }
}

TEST(Separation, StandsIfANeighbourIsUnknownOrMayBeAnywhereAround) {
  SeparationFilter filter(team_mission(), 0);
  const Mover self{0, 3, {500, 500, 0}, 40};
  std::vector<Neighbour> others = kFar;
  others[1].known = false;
  SafeVelocity safe = filter.safe(self, {10, 0, 0}, others);
  EXPECT_TRUE(safe.velocity_mps.isZero(0));
  EXPECT_TRUE(safe.blind && safe.blocked);
  EXPECT_EQ(safe.by, 2);
  others[1].known = true;
  others[1].age_ticks = 101;  // 404 m; it was 400 m away
  safe = filter.safe(self, {10, 0, 0}, others);
  EXPECT_TRUE(safe.velocity_mps.isZero(0));
  EXPECT_EQ(safe.by, 2);
}

TEST(Separation, ReportsWhichBodyBlocks) {
  SeparationFilter filter(team_mission(), 0);
  const Mover self{0, 3, {500, 500, 0}, 40};
  std::vector<Neighbour> others;  // all around
  for (AgentId id = 4; id < 10; ++id) {
    const double angle = (id - 7) * std::numbers::pi / 3;
    others.push_back({id, {500 + 30 * std::cos(angle), 500 + 30 * std::sin(angle), 0}, 40});
  }
  const SafeVelocity safe = filter.safe(self, {20, 0, 0}, others);
  EXPECT_EQ(safe.by, 7);
  EXPECT_TRUE(safe.blocked);
  EXPECT_FALSE(safe.blind);
}

TEST(Separation, NeverLeavesTheDomain) {
  SeparationFilter filter(team_mission(), 0);
  const SafeVelocity safe = filter.safe({0, 3, {1999, 500, 0}, 40}, {30, 20, 0}, kFar);
  EXPECT_NEAR(safe.velocity_mps.x(), 10, 1e-9);
  EXPECT_NEAR(safe.velocity_mps.y(), 20, 1e-9);
  EXPECT_EQ(safe.by, kUnassigned);
}

/// The world executes the result unchanged: a later cut would be counted. How near a body that
/// follows as a low pass comes to the edges, towards which it moves. Below 0 it is outside.
/// @param wall  in place of the domain's right edge
double nearest_edge_m(double response_s, double position_error_m, bool wall = false) {
  Mission mission = team_mission();
  mission.domain = {{0, 0, 0}, {100, 80, 0}};
  mission.timing.pace = Pace::kLockstep;
  mission.separation.response_s = response_s;
  mission.separation.position_error_m = position_error_m;
  if (wall) {
    mission.domain.size_m.x() = 300;
    mission.walls = {{{100, -10}, {110, -10}, {110, 70}, {100, 70}}};
  }
  SeparationFilter filter(mission, 0);
  Eigen::Vector3d x_m(50, 40, 0), v_mps(0, 0, 0);
  double least_m = 100;
  for (Tick tick = 0; tick < 200; ++tick) {
    const Eigen::Vector3d reported_m = x_m - Eigen::Vector3d(position_error_m, position_error_m, 0);
    const Eigen::Vector3d safe_mps =
        filter.safe({0, tick, reported_m, 20}, {16, 12, 0}, {}).velocity_mps;
    for (int step = 0; step < 100; ++step) {
      v_mps += (safe_mps - v_mps) * 1e-3 / 0.4;
      x_m += v_mps * 1e-3;
    }
    least_m = std::min({least_m, 100 - x_m.x(), 80 - x_m.y()});
  }
  return least_m;
}

TEST(Separation, ABodyThatFollowsLateStopsBeforeTheEdges) {
  EXPECT_LT(nearest_edge_m(0, 0), -1) << "one that is believed to follow at once leaves";
  EXPECT_GE(nearest_edge_m(0.45, 0), 0.45 * 20 - 0.1) << "T V";
  EXPECT_GE(nearest_edge_m(0.45, 0.5), 0.45 * 20 + 0.5 - 0.1) << "T V + 2 e, of which it errs e";
  EXPECT_LT(nearest_edge_m(0, 0, true), -1) << "and so it does where there is a wall";
  EXPECT_GE(nearest_edge_m(0.45, 0, true), 0.45 * 20 - 0.1);
  EXPECT_GE(nearest_edge_m(0.45, 0.5, true), 0.45 * 20 + 0.5 - 0.1);
}

TEST(Separation, BodiesThatFollowLateBeginAwayFromTheEdges) {
  Mission mission = team_mission();
  mission.domain = {{0, 0, 0}, {100, 80, 0}};
  mission.separation.response_s = 0.45;
  mission.speed_limit_mps = 20;
  EXPECT_EQ(late_edge_margin_m(mission, 0), 9);
  for (AgentId id = 0; id < 200; ++id) {
    const Eigen::Vector3d x_m = start_beside(mission, id, {}, start_distance_m);
    ASSERT_GE(std::min(x_m.x(), x_m.y()), 9);
    ASSERT_LE(std::max(x_m.x() - 100, x_m.y() - 80), -9);
  }
  mission.separation.response_s = 5;
  EXPECT_EQ(room_to_begin(mission, 0).size_m, Eigen::Vector3d(60, 40, 0)) << "a quarter at most";
}

TEST(Separation, ResultsAreWithinTheSpeedLimit) {
  const Mission mission = team_mission();
  SeparationFilter filter(mission, 0);
  for (int i = 0; i < 360; ++i) {
    const double angle = i / 57.3;
    const Eigen::Vector3d wanted(60 * std::cos(angle), 60 * std::sin(angle), 0);
    const SafeVelocity safe =
        filter.safe({0, i, {500, 500, 0}, 40}, wanted, {{{1, {531, 502, 0}, 40}}});
    if (safe.velocity_mps == wanted) continue;
    EXPECT_EQ(within_speed_limit(motion_of(mission, 0), safe.velocity_mps), safe.velocity_mps);
  }
}

/// In a mission in lockstep the agent filters its command, and the world does so once more.
TEST(Separation, LeavesWhatItHasAllowed) {
  const VehicleLimits kinds[] = {{},
                                 {.kind = VehicleKind::kAcceleration, .max_acceleration_mps2 = 20},
                                 {.kind = VehicleKind::kUnicycle, .max_turn_radps = 2},
                                 {VehicleKind::kFixedWing, 0, 2, 10}};
  for (const VehicleLimits& vehicle : kinds) {
    Mission mission = team_mission();
    mission.vehicle = vehicle;
    SeparationFilter filter(mission, 0);
    std::mt19937 random(1);
    std::uniform_real_distribution<double> within(-1, 1);
    const auto drawn = [&](double most) -> Eigen::Vector3d {
      return {most * within(random), most * within(random), 0};
    };
    for (int i = 0; i < 3000; ++i) {
      const bool stands = i % 2 == 0;  // at the edge
      Mover self{0, i, {stands ? 0 : 6 + 4 * within(random), 500, 0}, 40};
      self.velocity_mps = drawn(stands ? 2e-8 : 4);
      self.velocity_mps =
          executed(motion_of(mission, self.id), self.velocity_mps, self.velocity_mps);
      const Eigen::Vector3d away_m = Eigen::Vector3d(50, 0, 0) + drawn(15);
      const std::vector<Neighbour> others = {{1, self.position_m + away_m, 40}};
      const Eigen::Vector3d allowed_mps = filter.safe(self, drawn(60), others).velocity_mps;
      ASSERT_EQ(filter.safe(self, allowed_mps, others).velocity_mps, allowed_mps)
          << "vehicle " << static_cast<int>(vehicle.kind) << ", case " << i;
    }
  }
}

/// Two bodies on one line pass each other, and a crowd of goal seekers is not blocked for long.
/// Without a step sideways the two would stand for ever.
TEST(Separation, BodiesPassEachOther) {
  SeparationFilter filter(team_mission(), 0);
  Eigen::Vector3d x_m[2] = {{500, 500, 0}, {700, 500, 0}};
  const Eigen::Vector3d goals_m[2] = {x_m[1], x_m[0]};
  Tick tick = 0;
  for (; tick < 600 && (x_m[0] - goals_m[0]).norm() > 4; ++tick) {
    Eigen::Vector3d v_mps[2];
    const std::vector<Neighbour> all = {{0, x_m[0], 40}, {1, x_m[1], 40}};
    for (AgentId i = 0; i < 2; ++i) {
      const Eigen::Vector3d wanted = (goals_m[i] - x_m[i]).normalized() * 20;
      v_mps[i] = filter.safe({i, tick, x_m[i], 40}, wanted, all).velocity_mps;
    }
    for (AgentId i = 0; i < 2; ++i) x_m[i] += v_mps[i] * 0.1;
    ASSERT_GE((x_m[0] - x_m[1]).norm(), 30);
  }
  EXPECT_LT(tick, 600);

  Attack attack;
  attack.side_m = 300;
  Crowd crowd(attack);
  EXPECT_GE(crowd.least_spare_m(), 0);
  EXPECT_LT(crowd.blocked_share(), 0.15);
  EXPECT_GT(crowd.arrivals(), 12 * 5);
  EXPECT_GT(crowd.contacts(), 1000) << "a crowd that never touches proves nothing";
}

TEST(Separation, PackingCountsDiscsInAPlaneAndBallsInABox) {
  Mission mission = team_mission();
  mission.separation = {};
  mission.separation.distance_m = 10;
  mission.timing.pace = Pace::kLockstep;
  mission.domain.size_m = {100, 200, 0};
  EXPECT_NEAR(packing(mission, 8), 8 * 78.54 / 2e4, 1e-4);
  mission.domain.size_m.z() = 50;
  EXPECT_NEAR(packing(mission, 8), 8 * 523.6 / 1e6, 1e-5);
}

TEST(Separation, HoldTicksAreThoseOfTheWorld) {
  Mission mission = team_mission();
  mission.separation.guard = true;
  EXPECT_EQ(command_hold_ticks(mission.timing), 5);
  mission.timing.command_hold_s = 0.3;
  EXPECT_EQ(command_hold_ticks(mission.timing), 3) << "0.3 / 0.1 < 3";
  mission.timing.pace = Pace::kLockstep;
  EXPECT_EQ(unguarded_hold_ticks(mission), 0);
  mission.timing.pace = Pace::kRealtime;
  EXPECT_EQ(unguarded_hold_ticks(mission), 0) << "the world guards";
  mission.separation.guard = false;
  EXPECT_EQ(unguarded_hold_ticks(mission), 3);
  EXPECT_FALSE(world_guards(mission));
}

}  // namespace
}  // namespace ergocast
