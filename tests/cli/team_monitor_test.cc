// SPDX-License-Identifier: BSD-3-Clause
// The processes of a run that still run, as known to a command that has just started to listen.
#include "cli/team/team_monitor.h"

#include <gtest/gtest.h>

#include "tests/support/team.h"

namespace ergocast::cli {
namespace {

using namespace test;
using Names = std::vector<std::string>;

class Monitored : public ::testing::Test {
 protected:
  Monitored() { announce(small_mission(2)); }
  void receive(const Message& message, Instant now) { give(run_, message, now); }
  void hear_mission(MissionState state, Instant now) {
    receive(mission_part(state == MissionState::kRunning ? 0 : 1, state, roster_of(2), "stopped"),
            now);
  }
  static AgentStatus status(AgentId id, AgentPhase phase) {
    AgentStatus status = status_of(id, next_sequence());
    status.phase = phase;
    return status;
  }
  static WorldState moving(Tick tick, AgentId vehicle, double speed_mps, Incarnation driver) {
    WorldState state = world_state(tick, {{1, 1, 0}});
    state.header.incarnation = driver;
    state.vehicles[0].id = vehicle;
    state.vehicles[0].velocity_mps = {speed_mps, 0, 0};
    return state;
  }

  MonitoredRun run_{kRun, at(0s)};
};

TEST_F(Monitored, AnAgentWithoutAMessageYetIsThereForAsLongAsItMayBeSilent) {
  hear_mission(MissionState::kEnded, at(10ms));
  EXPECT_EQ(run_.still_there(at(20ms)), (Names{"agent 0", "agent 1"}))
      << "their last words may come next";
  EXPECT_EQ(run_.lost(at(20ms)), Names());
  receive(status(0, AgentPhase::kFinished), at(30ms));
  EXPECT_EQ(run_.still_there(at(40ms)), Names{"agent 1"});
  EXPECT_EQ(run_.still_there(at(3s)), Names());
  EXPECT_EQ(run_.lost(at(3s)), Names{"agent 1"});
}

TEST_F(Monitored, AProcessThatHasReportedItsEndIsNotAwaited) {
  TeamStatus team;
  team.header = {kRun, kCoordinator, kCoordinatorLife, next_sequence(), 5};
  receive(team, at(1ms));
  receive(world_state(5, {{1, 1, 0}}), at(1ms));
  receive(RecordAck{{kRun, kLogger, kLoggerLife, next_sequence(), 4}}, at(1ms));
  EXPECT_EQ(run_.still_there(at(2ms)), (Names{"the logger", "the world", "the coordinator"}));
  WorldState farewell = world_state(5, {{1, 1, 0}});
  farewell.last = true;
  receive(farewell, at(3ms));
  EXPECT_EQ(run_.still_there(at(3ms)), (Names{"the logger", "the coordinator"}));
  // On the world's bus; an earlier message on another bus may be read later.
  const RecordAck before{{kRun, kLogger, kLoggerLife, next_sequence(), 5}};
  run_.receive(RecordAck{{kRun, kLogger, kLoggerLife, next_sequence(), 5}, true}, Bus::kWorld,
               kLogger, at(4ms));
  receive(before, at(4ms));
  EXPECT_EQ(run_.still_there(at(4ms)), Names{"the coordinator"});
  hear_mission(MissionState::kEnded, at(5ms));
  EXPECT_EQ(run_.still_there(at(5ms)), (Names{"agent 0", "agent 1"}));
}

TEST_F(Monitored, AllVehiclesOfAllDriversStandBeforeTheTeamDoes) {
  receive(moving(100, 1, 2, 0xb), at(1ms));
  receive(moving(101, 0, 0, 0xa), at(2ms));
  EXPECT_FALSE(run_.stands_still()) << "the other driver is a tick behind";
  EXPECT_EQ(run_.still_moving(at(3ms)), Names{"the world"});
  receive(moving(101, 1, 0, 0xb), at(4ms));
  EXPECT_TRUE(run_.stands_still());
  EXPECT_EQ(run_.still_moving(at(5ms)), Names());
  EXPECT_EQ(run_.still_there(at(5ms)), Names{"the world"});
}

TEST_F(Monitored, ReportsMissionTimeAndLeavesOutWhatDoesNotCount) {
  EXPECT_EQ(run_.mission_time(40), "tick 40") << "no mission is known";
  auto part = mission_part(0, MissionState::kRunning, roster_of(2));
  part.amendments = pauses({{10, 30}});
  receive(part, at(1ms));
  EXPECT_EQ(run_.mission_time(10), "tick 10, t = 1.0 s");
  EXPECT_EQ(run_.mission_time(30), "tick 10, t = 1.0 s");
  EXPECT_EQ(run_.mission_time(40), "tick 20, t = 2.0 s");
}

}  // namespace
}  // namespace ergocast::cli
