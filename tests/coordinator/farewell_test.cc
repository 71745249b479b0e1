// SPDX-License-Identifier: BSD-3-Clause
// When a coordinator leaves: as soon as all others have reported that they leave, else after 1 s.
#include <gtest/gtest.h>

#include "tests/coordinator/driven_coordinator.h"

namespace ergocast {
namespace {

using namespace test;

/// A coordinator whose mission of two agents has just reached its last tick, at 1 s.
class Farewell : public ::testing::Test {
 protected:
  Farewell() {
    mission_.timing.tick_count = 7;
    coordinator_ = running_coordinator(mission_);
    give(coordinator_, world_where(7, {6, 6}), at(1s));
    advance(coordinator_, at(1s));
  }

  void agent_leaves(AgentId id, Incarnation incarnation) {
    AgentStatus status = status_of(id, next_sequence());
    status.header.incarnation = incarnation;
    status.phase = AgentPhase::kFinished;
    status.header.tick = 7;
    give(coordinator_, status, at(1s));
  }
  void agent_leaves(AgentId id) { agent_leaves(id, incarnation_of(id)); }
  void world_leaves() {
    WorldState last = world_where(7, {6, 6});
    last.last = true;
    give(coordinator_, last, at(1s));
  }
  void logger_leaves(bool last = true) {
    const RecordAck ack{{kRun, kLogger, kLoggerLife, next_sequence(), 6}, last};
    coordinator_.receive(ack, Bus::kWorld, kLogger, at(1s));
  }
  bool leaves_at(Instant now) {
    said_ = advance(coordinator_, now);
    return coordinator_.finished();
  }

  Mission mission_ = small_mission(2);
  Coordinator coordinator_ = coordinator_of(mission_);
  Outbox said_;
};

TEST_F(Farewell, AtOnceWhenAllOthersLeaveWithTheEndSentOnceMore) {
  agent_leaves(0), agent_leaves(1), world_leaves(), logger_leaves();
  EXPECT_TRUE(leaves_at(at(1001ms)));
  const auto parts = only<MissionPart>(said_);
  ASSERT_FALSE(parts.empty());
  EXPECT_EQ(parts[0].state, MissionState::kEnded);
}

TEST_F(Farewell, AfterASecondIfTheReportOfAnyOfThemIsMissing) {
  for (const int unheard : {0, 1, 2, 3}) {
    coordinator_ = running_coordinator(mission_);
    give(coordinator_, world_where(7, {6, 6}), at(1s));
    if (unheard != 0) agent_leaves(0);
    if (unheard != 1) agent_leaves(1);
    if (unheard != 2) world_leaves();
    logger_leaves(unheard != 3);
    EXPECT_FALSE(leaves_at(at(1s))) << unheard;
    EXPECT_FALSE(leaves_at(at(1999ms))) << unheard;
    EXPECT_TRUE(leaves_at(at(2s))) << unheard;
  }
}

TEST_F(Farewell, AfterASecondIfAnotherWorldOrLoggerSendsAfterwards) {
  agent_leaves(0), agent_leaves(1), world_leaves(), logger_leaves();
  WorldState successor = world_where(7, {6, 6});
  successor.header.incarnation = kWorldLife + 1;
  give(coordinator_, successor, at(1s));
  EXPECT_FALSE(leaves_at(at(1999ms)));
  EXPECT_TRUE(leaves_at(at(2s)));
}

TEST_F(Farewell, AfterASecondIfAProcessThatIsNoMemberAsksToJoin) {
  agent_leaves(0), agent_leaves(1), world_leaves(), logger_leaves();
  give(coordinator_, hello_of(5), at(1001ms));
  EXPECT_FALSE(leaves_at(at(1001ms))) << "it must receive the end, too";
  EXPECT_TRUE(leaves_at(at(2s)));
}

TEST_F(Farewell, AFormerIncarnationThatIsSilentNeedNotSendAnything) {
  coordinator_ = running_coordinator(mission_);
  give(coordinator_, status_of(1, next_sequence()), at(1s));
  give(coordinator_, hello_of(1, 99), at(4s));
  give(coordinator_, world_where(7, {6, 6}), at(4s));
  agent_leaves(0), agent_leaves(1, 99), world_leaves(), logger_leaves();
  EXPECT_TRUE(leaves_at(at(4s)));
}

TEST_F(Farewell, NoMissionEndsByItBeforeItsEnd) {
  coordinator_ = running_coordinator(small_mission(2));
  agent_leaves(0), agent_leaves(1), logger_leaves();
  WorldState last = world_where(7, {6, 6});
  last.last = true;
  give(coordinator_, last, at(1s));
  EXPECT_FALSE(leaves_at(at(1s)));
}

}  // namespace
}  // namespace ergocast
