// SPDX-License-Identifier: BSD-3-Clause
// The record of robots that each have a driver of their own.
#include <map>

#include "tests/logger/record.h"

namespace ergocast {
namespace {

using namespace test;

Mission driven(int agents) {
  Mission mission = small_mission(agents);
  mission.timing.pace = Pace::kRealtime;
  mission.timing.tick_count = 40;
  mission.timing.command_hold_s = 0;
  mission.speed_limit_mps = 40;
  mission.separation.distance_m = 30;
  mission.separation.lease_s = 2;
  return mission;
}

/// The part that the driver of robot `id` sends.
WorldState part_of(AgentId id, int robots, Tick tick) {
  WorldState state = world_state(tick, {{100.0 * (id + 1), 500 + static_cast<double>(tick), 0}});
  state.header.incarnation = 100 + static_cast<Incarnation>(id);
  state.vehicles[0].id = id;
  state.part = id;
  state.parts = robots;
  return state;
}

class RecordOfDrivers : public ::testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(With, RecordOfDrivers, ::testing::Bool(), [](const auto& leased) {
  return leased.param ? "Leases" : "NoSeparation";
});

TEST_P(RecordOfDrivers, JoinsTheirStates) {
  Mission mission = driven(3);
  if (!GetParam()) mission.separation = {};
  Record record(mission);
  for (Tick tick = 0; tick < 10; ++tick) {
    for (const AgentId id : {2, 0, 1}) record.deliver(part_of(id, 3, tick), at(tick * 100ms));
  }
  const auto rows = record.trajectory_rows();
  ASSERT_EQ(rows.size(), 9u * 3);
  EXPECT_EQ(number(rows[5], 0), 1);
  EXPECT_EQ(number(rows[5], 2), 2);
  EXPECT_EQ(number(rows[5], 3), 300);
  EXPECT_EQ(number(rows[5], 4), 501);
}

TEST_P(RecordOfDrivers, HasTheOthersRowsWhereThePartsOfOneAreMissing) {
  Mission mission = driven(3);
  if (!GetParam()) mission.separation = {};
  Record record(mission);
  for (Tick tick = 0; tick < 40; ++tick) {
    for (const AgentId id : {2, 0, 1}) {
      if (id != 1 || tick < 10 || tick >= 20)
        record.deliver(part_of(id, 3, tick), at(tick * 100ms));
    }
  }
  record.recorder.stop("enough");
  std::map<AgentId, int> rows;
  for (const std::string& row : record.trajectory_rows())
    ++rows[static_cast<AgentId>(number(row, 2))];
  EXPECT_EQ(rows[0], 39);
  EXPECT_EQ(rows[2], 39);
  EXPECT_EQ(rows[1], 39 - 11) << "its last row before needs the state after, too";
  EXPECT_EQ(record.recorder.facts().gaps, 0);
  EXPECT_EQ(record.recorder.facts().missing_positions, 11);
}

TEST_P(RecordOfDrivers, HasLostPositionsOnTheLineBetweenOthers) {
  Mission mission = driven(2);
  if (!GetParam()) mission.separation = {};
  Record record(mission);
  const auto is_lost = [](Tick tick) { return tick == 5 || (tick > 10 && tick <= 18); };
  for (Tick tick = 0; tick < 40; ++tick) {
    for (const AgentId id : {1, 0}) {
      if (id == 0 || !is_lost(tick)) record.deliver(part_of(id, 2, tick), at(tick * 100ms));
    }
  }
  record.recorder.stop("enough");
  const auto rows = record.trajectory_rows();
  ASSERT_EQ(rows.size(), 39u * 2);
  for (std::size_t i = 1; i < rows.size(); i += 2) {
    EXPECT_EQ(number(rows[i], 2), 1);
    EXPECT_NEAR(number(rows[i], 4), 500 + number(rows[i], 0), 1e-9) << rows[i];
  }
  EXPECT_EQ(record.recorder.facts().lost_positions, 9);
  EXPECT_EQ(record.recorder.facts().missing_positions, 0);
}

TEST(RecordOfDriversThatKeepADistance, TakesItFromReportedPlacesOnly) {
  // Robot 1 goes around robot 0 while its positions are lost, and the line leads through robot 0.
  Record record(driven(2));
  for (Tick tick = 0; tick < 30; ++tick) {
    WorldState still = part_of(0, 2, tick), around = part_of(1, 2, tick);
    still.vehicles[0].position_m = {500, 500, 0};
    around.vehicles[0].position_m = {tick < 10 ? 400.0 : 600.0, 500, 0};
    record.deliver(still, at(tick * 100ms));
    if (tick < 10 || tick > 14) record.deliver(around, at(tick * 100ms));
  }
  record.recorder.stop("enough");
  EXPECT_EQ(record.recorder.facts().lost_positions, 5);
  EXPECT_EQ(record.recorder.facts().nearest_m, 100);
}

}  // namespace
}  // namespace ergocast
