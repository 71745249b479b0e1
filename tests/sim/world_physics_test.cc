// SPDX-License-Identifier: BSD-3-Clause
// A world whose bodies are not moved by core/motion/vehicle.h.
#include <gtest/gtest.h>

#include <map>

#include "tests/sim/driven_world.h"

namespace ergocast::test {
namespace {

/// Bodies that move at half the commanded speed, and roll on for a tick.
class Sluggish : public Physics {
 public:
  void place(AgentId id, const Eigen::Vector3d& x_m, const Eigen::Vector3d& v_mps) override {
    places_[id] = {id, {0, 0, 0}, x_m, v_mps};
  }
  void pass_tick(std::span<PhysicalBody> bodies) override {
    for (PhysicalBody& body : bodies) {
      PhysicalBody& known = places_.at(body.id);
      known.velocity_mps = (known.velocity_mps + body.wanted_mps) / 2;
      known.position_m += known.velocity_mps * 0.1;
      body.position_m = known.position_m;
      body.velocity_mps = known.velocity_mps;
    }
  }

 private:
  std::map<AgentId, PhysicalBody> places_;
};

const PhysicsMaker kSluggish = [](const Mission&) { return std::make_unique<Sluggish>(); };

World sluggish_world(const Mission& mission) {
  announce(mission);
  World world(kRun, kWorldLife, kSluggish);
  give(world, mission_part(0, MissionState::kRunning, roster_of(2)), at(0s));
  nobody_has_moved(world, 2, at(0s));
  return world;
}

TEST(WorldWithPhysics, SendsWhereThePhysicsPutsBodies) {
  World world = sluggish_world(small_mission(2));
  const Eigen::Vector3d start_m = place(state_after(world, at(0s)), 1);
  give(world, command_of(0, 0, {0, 0, 0}), at(1ms));
  give(world, command_of(1, 0, {4, 0, 0}), at(1ms));
  const WorldState state = state_after(world, at(1ms));
  EXPECT_EQ(state.header.tick, 1);
  EXPECT_EQ(applied(state, 1), Eigen::Vector3d(2, 0, 0));
  EXPECT_NEAR((place(state, 1) - start_m).x(), 0.2, 1e-12);
  EXPECT_EQ(applied(state, 0), Eigen::Vector3d(0, 0, 0));
}

TEST(WorldWithPhysics, AgentsThatKeepNoDistanceReceiveOnlyPlacesInTheDomain) {
  for (const double distance_m : {0.0, 30.0}) {
    Mission mission = small_mission(2);
    mission.speed_limit_mps = 5000;
    mission.separation.distance_m = distance_m;
    mission.separation.guard = distance_m > 0;
    World world = sluggish_world(mission);
    state_after(world, at(0s));
    give(world, command_of(0, 0, {-5000, 0, 0}), at(1ms));
    give(world, command_of(1, 0, {0, 0, 0}), at(1ms));
    const double x_m = place(state_after(world, at(1ms)), 0).x();
    EXPECT_EQ(x_m, distance_m > 0 ? -150 : 0) << "from 100 m, 250 m to the left";
  }
}

TEST(WorldWithPhysics, AMemberThatJoinsIsPlaced) {
  World world = sluggish_world(small_mission(2));
  state_after(world, at(0s));
  give(world, mission_part(1, MissionState::kRunning, roster_of(3)), at(1ms));
  for (AgentId id = 0; id < 3; ++id) give(world, command_of(id, 0, {2, 0, 0}), at(2ms));
  const WorldState state = state_after(world, at(2ms));
  ASSERT_EQ(state.vehicle_count, 3);
  EXPECT_EQ(applied(state, 2), Eigen::Vector3d(1, 0, 0));
}

TEST(WorldWithPhysics, AfterAStopAtOnceThePhysicsStillMovesBodies) {
  World world = sluggish_world(small_mission(2));
  state_after(world, at(0s));
  for (AgentId id = 0; id < 2; ++id) give(world, command_of(id, 0, {8, 0, 0}), at(1ms));
  state_after(world, at(1ms));
  give(world, Stop{{kRun, kOperator, 1, 1, 0}, false, "enough", true}, at(2ms));
  const WorldState last = states_after(world, at(2ms)).back();
  EXPECT_EQ(last.header.tick, 2);
  EXPECT_EQ(applied(last, 0), Eigen::Vector3d(2, 0, 0));
}

TEST(WorldWithPhysics, EndsWhereThereIsNoneForTheMission) {
  const Mission mission = small_mission(2);
  announce(mission);
  World world(kRun, kWorldLife, [](const Mission&) { return failure(std::string("fly cars")); });
  give(world, mission_part(0, MissionState::kRunning, roster_of(2)), at(0s));
  EXPECT_TRUE(world.finished());
  EXPECT_TRUE(world.failed());
  EXPECT_EQ(world.reason(), "fly cars");
}

}  // namespace
}  // namespace ergocast::test
