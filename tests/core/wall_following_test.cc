// SPDX-License-Identifier: BSD-3-Clause
// Agents that walls hold up find their way out of dead ends, and other agents are not affected.
#include "core/motion/wall_following.h"

#include <gtest/gtest.h>

#include "core/motion/separation.h"
#include "core/motion/walls.h"

namespace ergocast {
namespace {

Mission with_walls(const Rings& walls) {
  Mission mission;
  mission.domain.size_m = {200, 200, 0};
  mission.speed_limit_mps = 10;
  mission.walls = walls;
  mission.wall_clearance_m = 2;
  return mission;
}

/// A U that is open to the left.
const Rings kTrap = {
    {{60, 60}, {140, 60}, {140, 140}, {60, 140}, {60, 130}, {130, 130}, {130, 70}, {60, 70}}};

/// A body that is pulled straight to a goal.
class Seeker {
 public:
  Seeker(const Mission& mission, AgentId id, bool follows)
      : mission_(mission), id_(id), filter_(mission, 0), follower_(mission, id), uses_(follows) {}

  /// How long it takes to be within 5 m of `goal_m` [s]; `most_s` if it does not get there.
  double time_to_s(const Eigen::Vector3d& goal_m, double most_s) {
    const auto most = static_cast<Tick>(most_s / mission_.timing.dt_s);
    Tick tick = 0;
    for (; tick < most && (goal_m - x_m).norm() > 5; ++tick) {
      const Eigen::Vector3d wanted_mps = 8 * (goal_m - x_m).normalized();
      const Eigen::Vector3d aim_mps = uses_ ? follower_.aim(tick, x_m, wanted_mps) : wanted_mps;
      const SafeVelocity safe = filter_.safe({id_, tick, x_m, 10}, aim_mps, {});
      follower_.note(safe.wall);
      followed += follower_.follows() ? 1 : 0;
      x_m += safe.velocity_mps * mission_.timing.dt_s;
    }
    return static_cast<double>(tick) * mission_.timing.dt_s;
  }

  Eigen::Vector3d x_m{0, 0, 0};
  int followed = 0;  ///< ticks

 private:
  Mission mission_;
  AgentId id_;
  SeparationFilter filter_;
  WallFollower follower_;
  bool uses_;
};

TEST(WallFollower, FindsItsWayOutOfATrap) {
  const Mission mission = with_walls(kTrap);
  for (AgentId id = 0; id < 20; ++id) {
    Seeker stuck(mission, id, false), free(mission, id, true);
    stuck.x_m = free.x_m = {100, 95.0 + id, 0};
    EXPECT_EQ(stuck.time_to_s({190, 100, 0}, 600), 600) << "walls do hold it up";
    EXPECT_LT(free.time_to_s({190, 100, 0}, 600), 600) << id;
  }
}

// Posts that are smaller than a cell of the modes' grid hold agents up with either basis.
TEST(WallFollower, IsUsedWithModesOfTheFreeDomainToo) {
  Mission mission = with_walls(kTrap);
  EXPECT_TRUE(follows_walls(mission));
  mission.basis.free_domain = true;
  EXPECT_TRUE(follows_walls(mission));
  EXPECT_FALSE(follows_walls(with_walls({})));
}

TEST(WallFollower, FindsADoor) {
  const Mission mission = with_walls(
      {{{98, -5}, {102, -5}, {102, 90}, {98, 90}}, {{98, 110}, {102, 110}, {102, 205}, {98, 205}}});
  for (AgentId id = 0; id < 20; ++id) {
    Seeker seeker(mission, id, true);
    seeker.x_m = {40, 30, 0};
    EXPECT_LT(seeker.time_to_s({160, 25, 0}, 900), 900) << id;
  }
}

TEST(WallFollower, LetsThroughBitForBitWhatNoWallHoldsUp) {
  const Mission mission = with_walls(kTrap);
  Seeker seeker(mission, 0, true);
  seeker.x_m = {10, 20, 0};
  EXPECT_LT(seeker.time_to_s({190, 20, 0}, 600), 30);
  EXPECT_EQ(seeker.followed, 0);
  WallFollower follower(mission, 0);
  const Eigen::Vector3d wanted_mps(0.1, 0.2, 0);
  for (Tick tick = 0; tick < 1000; ++tick) {
    EXPECT_EQ(follower.aim(tick, {20, 20, 0}, wanted_mps), wanted_mps);
    follower.note(false);  // it stands, but not because of a wall
  }
}

TEST(WallFollower, TakesTwiceAsLongEachTime) {
  const Mission mission = with_walls(kTrap);
  WallFollower follower(mission, 0);
  std::vector<double> lengths_s;
  bool before = false;
  for (Tick tick = 0; tick < 10000; ++tick) {
    const Eigen::Vector3d aim_mps = follower.aim(tick, {100, 100, 0}, {5, 0, 0});
    follower.note(true);
    EXPECT_NEAR(aim_mps.norm(), 5, 1e-12);
    if (follower.follows() && !before) lengths_s.push_back(0);
    if (follower.follows()) lengths_s.back() += mission.timing.dt_s;
    before = follower.follows();
  }
  ASSERT_GT(lengths_s.size(), 7u);
  const double expected_s[] = {4, 8, 16, 32, 64, 120, 120};
  for (std::size_t i = 0; i < std::size(expected_s); ++i)
    EXPECT_NEAR(lengths_s[i], expected_s[i], 0.15) << i;
}

TEST(WallFollower, AsksForNoMoreThanTheSpeedLimit) {
  const Mission mission = with_walls(kTrap);
  WallFollower follower(mission, 0);
  for (Tick tick = 0; tick < 30; ++tick) {
    const Eigen::Vector3d aim_mps = follower.aim(tick, {127.9, 100, 0}, {50, 0, 0});
    follower.note(true);
    EXPECT_NEAR(aim_mps.norm(), follower.follows() ? 10 : 50, 1e-9);
  }
  EXPECT_TRUE(follower.follows());
}

TEST(WallFollower, IsAFunctionOfTheSeed) {
  int left = 0;
  for (AgentId id = 0; id < 40; ++id) {
    Mission mission = with_walls(kTrap);
    WallFollower one(mission, id), same(mission, id);
    Eigen::Vector3d aim_mps(0, 0, 0);
    for (Tick tick = 0; tick < 30; ++tick) {
      aim_mps = one.aim(tick, {127.9, 100, 0}, {5, 0, 0});
      EXPECT_EQ(same.aim(tick, {127.9, 100, 0}, {5, 0, 0}), aim_mps);
      one.note(true);
      same.note(true);
    }
    ASSERT_TRUE(one.follows());
    left += aim_mps.y() < 0 ? 1 : 0;
  }
  EXPECT_GT(left, 8);
  EXPECT_LT(left, 32);
}

}  // namespace
}  // namespace ergocast
