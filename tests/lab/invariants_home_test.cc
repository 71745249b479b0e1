// SPDX-License-Identifier: BSD-3-Clause
// Agents are home in time: last states of missions that violate it, and others that do not.
#include <string>
#include <vector>

#include "tests/lab/invariants_fixture.h"

namespace ergocast::test {
namespace {

/// The invariant that the last state of a mission violates. In this state agent 0 is at `x_m`, and
/// its station is at (10, 10). The other agents are at `others_m`. If `sent_out`, they have left
/// the mission, and their vehicles stand there for good.
std::string violated_at_home(const Eigen::Vector2d& x_m,
                             const std::vector<Eigen::Vector2d>& others_m, bool sent_out = true) {
  const int agents = 1 + static_cast<int>(others_m.size());
  Mission mission = small_mission(agents);
  mission.domain.size_m = {60, 40, 0};
  mission.law.u_max_mps = 3;
  mission.speed_limit_mps = 4;
  mission.timing.dt_s = 0.1;
  mission.separation.distance_m = 2;
  for (int i = 0; i < agents; ++i) mission.starts_m[static_cast<std::size_t>(i)] = {5.0 * i, 5, 0};
  mission.kinds = {{"a", 1, 3, 0, 0}, {"b", agents - 1, 3, 0, 0}};
  mission.kinds[0].stations_m = {{10, 10, 0}};
  mission.kinds[0].reserve_s = 1;
  announce(mission);
  std::vector<RosterEntry> roster = roster_of(agents);
  std::vector<Eigen::Vector3d> places_m = {{x_m.x(), x_m.y(), 0}};
  for (std::size_t i = 0; i < others_m.size(); ++i) {
    places_m.emplace_back(others_m[i].x(), others_m[i].y(), 0);
    if (!sent_out) continue;
    roster[i + 1].recall_revision = 0;
    roster[i + 1].active_until = 50;
    roster[i + 1].leaves = true;
  }
  Invariants team(mission);
  team.sent(0, {Bus::kSwarm, mission_part(0, MissionState::kRunning, roster)}, nullptr);
  team.sent(1, {Bus::kWorld, world_state(mission.timing.tick_count, places_m)}, nullptr);
  return violated_by(team);
}

TEST(InvariantsOfHome, AnAgentIsAtItsStationInTheEnd) {
  EXPECT_EQ(violated_at_home({10.5, 10}, {{40, 30}}), "");
  EXPECT_EQ(violated_at_home({10.7, 10}, {{40, 30}}), "agents are home in time");
}

TEST(InvariantsOfHome, OrAsNearAsItCanGetIfAVehicleStandsThereForGood) {
  EXPECT_EQ(violated_at_home({8.7, 10}, {{10.7, 10}}), "");
  EXPECT_EQ(violated_at_home({7.9, 10}, {{10.7, 10}}), "agents are home in time");
  EXPECT_EQ(violated_at_home({8.7, 10}, {{10.7, 10}}, false), "agents are home in time")
      << "that vehicle could go away";
}

TEST(InvariantsOfHome, OrEnclosedByVehiclesThatStandForGood) {
  const std::vector<Eigen::Vector2d> fence = {{55.6, 38.6}, {56, 36.2}, {58.4, 35.6}};
  EXPECT_EQ(violated_at_home({57.5, 37.8}, fence), "");
  EXPECT_EQ(violated_at_home({58.5, 38.5}, fence), "agents are home in time")
      << "it could be nearer";
  EXPECT_EQ(violated_at_home({57.5, 37.8}, {{55, 38.6}, {58.4, 35}}), "agents are home in time")
      << "there is a gap";
}

}  // namespace
}  // namespace ergocast::test
