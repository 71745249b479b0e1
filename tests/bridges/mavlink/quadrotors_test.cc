// SPDX-License-Identifier: BSD-3-Clause
// Quadrotors of the physics engine MuJoCo as the vehicles of the mock autopilots. They tilt before
// they accelerate, so they follow as no formula of this project assumes, and they would touch.
#include <cstdio>

#include "examples/mujoco/mujoco_physics.h"
#include "tests/bridges/mavlink/fleet.h"

namespace ergocast::mavlink {
namespace {

constexpr double kDistance_m = 1.2, kHeight_m = 5;

/// Nine quadrotors in a room of 15 m × 15 m. All respond to the same deficit in its middle, so they
/// crowd.
Mission mission_of_9() {
  Mission mission = fleet_mission(15, 1, kDistance_m, 0.05, square_of_starts(3, 2.5, 5));
  mission.seed = 3;
  for (const int across : {2, 16}) mission.target_coefficients[across] = -0.6;
  mission.law.anticipation = 0;
  return mission;
}

VehicleOptions options() {
  VehicleOptions options;
  options.origin = EarthPlace{47.6535, 9.175, 0, false};
  options.altitude_m = kHeight_m;
  return options;
}

/// They begin just above the floor. A wanted climb moves the height that a quadrotor holds.
class Quadrotors {
 public:
  explicit Quadrotors(const Mission& mission)
      : starts_m_(mission.starts_m),
        held_m_(mission.starts_m.size(), kAboveFloor_m),
        physics_(in_steps_of_mocks(mission), mujoco::kQuadrotors) {
    for (std::size_t i = 0; i < starts_m_.size(); ++i) {
      bodies_.push_back({.id = static_cast<AgentId>(i)});
      physics_.place(bodies_[i].id, starts_m_[i], {0, 0, 0});
    }
    const std::vector<std::array<double, 3>> nothing(starts_m_.size());
    for (int i = 0; i < 500; ++i) pass_step(nothing);
  }
  std::vector<MockFleet::Body> pass_step(const std::vector<std::array<double, 3>>& wanted_mps) {
    std::vector<double> before_m(bodies_.size(), kAboveFloor_m);
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      const auto& [north_mps, east_mps, up_mps] = wanted_mps[i];
      held_m_[i] = std::max(kAboveFloor_m, held_m_[i] + up_mps * kStep_s);
      physics_.hold_height(bodies_[i].id, held_m_[i]);
      bodies_[i].wanted_mps = {east_mps, north_mps, 0};
      if (began_) before_m[i] = physics_.height_m(bodies_[i].id);
    }
    began_ = true;
    physics_.pass_tick(bodies_);
    std::vector<MockFleet::Body> out;
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      const Eigen::Vector3d way_m = bodies_[i].position_m - starts_m_[i];
      const Eigen::Vector3d& v_mps = bodies_[i].velocity_mps;
      const double up_m = physics_.height_m(bodies_[i].id);
      out.push_back(
          {way_m.y(), way_m.x(), up_m, v_mps.y(), v_mps.x(), (up_m - before_m[i]) / kStep_s});
    }
    return out;
  }
  const mujoco::Contacts& contacts() const { return physics_.contacts(); }

 private:
  static constexpr double kStep_s = 0.02, kAboveFloor_m = 0.1;
  static Mission in_steps_of_mocks(Mission mission) {
    mission.timing.dt_s = kStep_s;
    return mission;
  }
  std::vector<Eigen::Vector3d> starts_m_;
  std::vector<double> held_m_;
  bool began_ = false;
  mujoco::MujocoPhysics physics_;
  std::vector<PhysicalBody> bodies_;
};

/// Two minutes and a half of flight.
class QuadrotorFlight : public testing::Test {
 protected:
  QuadrotorFlight() {
    fleet_.set_bodies([this](const auto& wanted_mps) { return quadrotors_.pass_step(wanted_mps); });
  }
  void all_take_off() {
    for (std::size_t i = 0; i < fleet_.size(); ++i) {
      fleet_.pilot(i, "arm");
      fleet_.pilot(i, "takeoff " + std::to_string(kHeight_m));
    }
    fleet_.pass(10);
    for (std::size_t i = 0; i < fleet_.size(); ++i)
      fleet_.pilot(i, "mode " + fleet_.external_mode(i));
    fleet_.pass(5);
  }
  void expect_all_follow() {
    for (std::size_t i = 0; i < fleet_.size(); ++i) fleet_.way_m(i);
    fleet_.pass(45);
    for (std::size_t i = 0; i < fleet_.size(); ++i) {
      EXPECT_GT(fleet_.way_m(i), 2) << i << " " << fleet_.log(i);
      EXPECT_NEAR(fleet_.place_m(i).z(), kHeight_m, 0.5) << i;
    }
  }

  const Mission mission_ = mission_of_9();
  Quadrotors quadrotors_{mission_};
  Fleet fleet_{mission_, options(), ERGOCAST_NODE_MAVLINK, 1};
};

TEST_F(QuadrotorFlight, KeepsTheTimeOutsTheDistanceAndThePilotsWord) {
  fleet_.pass(20);
  for (std::size_t i = 0; i < fleet_.size(); ++i)
    EXPECT_LT(fleet_.way_m(i), 0.01) << i << " has moved before a pilot allowed it";
  all_take_off();
  expect_all_follow();

  // Two pilots take over; their vehicles stand, whatever their agents want.
  fleet_.pilot(4, "mode POSCTL");
  fleet_.pilot(5, "mode LOITER");
  fleet_.pass(5);
  for (const std::size_t i : {4, 5}) fleet_.way_m(i);
  fleet_.pass(20);
  for (const std::size_t i : {4, 5}) {
    EXPECT_LT(fleet_.way_m(i), 0.05) << i << " has moved after its pilot took over";
    fleet_.pilot(i, "mode " + fleet_.external_mode(i));
  }
  fleet_.pass(5);
  expect_all_follow();

  std::printf("least distance %.2f m, longest gap between setpoints %.2f s\n",
              fleet_.least_distance_m(), fleet_.longest_gap_s());
  EXPECT_GE(fleet_.least_distance_m(), kDistance_m);
  EXPECT_LE(fleet_.least_distance_m(), 3 * kDistance_m) << "they have not met";
  EXPECT_EQ(quadrotors_.contacts().robots, 0);
  EXPECT_EQ(quadrotors_.contacts().walls, 0);
  EXPECT_EQ(fleet_.disobeyed(), 0);
  for (std::size_t i = 0; i < fleet_.size(); ++i) {
    EXPECT_EQ(fleet_.state(i)["timeouts"], 0) << i << " " << fleet_.log(i);
    EXPECT_EQ(fleet_.state(i)["refused"], 0) << i;
    EXPECT_TRUE(fleet_.state(i)["orders"].empty()) << i;
  }
}

}  // namespace
}  // namespace ergocast::mavlink
