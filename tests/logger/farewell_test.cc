// SPDX-License-Identifier: BSD-3-Clause
// When a logger leaves: as soon as it has all messages that the others will send, else after 1 s.
#include <gtest/gtest.h>

#include "tests/logger/record.h"

namespace ergocast {
namespace {

using namespace test;

class LastWords : public ::testing::Test {
 protected:
  void record_until(Tick last) {
    for (Tick tick = 0; tick <= last; ++tick) record_.deliver(state_of(tick), at(1s));
  }
  void mission_ends(MissionState state = MissionState::kEnded) {
    record_.deliver(mission_part(1, state, roster_of(1), "why"), at(1s));
  }
  void agent_leaves() {
    AgentStatus status = status_of(0, next_sequence());
    status.phase = AgentPhase::kFinished;
    said_ = record_.deliver(status, at(1s));
  }
  void world_leaves(Tick tick) {
    WorldState last = state_of(tick);
    last.last = true;
    said_ = record_.deliver(last, at(1s));
  }
  bool left() const { return record_.recorder.finished(); }

  Mission mission_ = small_mission(1);
  Record record_{[this] {
    mission_.timing.tick_count = 2;
    return mission_;
  }()};
  Outbox said_;
};

TEST_F(LastWords, AtOnceWhenAllOthersHaveLeftAndItReportsThatToTheCoordinator) {
  record_until(2), mission_ends(), agent_leaves();
  EXPECT_FALSE(left());
  world_leaves(2);
  EXPECT_TRUE(left());
  EXPECT_STREQ(record_.recorder.result(), "done");
  ASSERT_FALSE(said_.empty());
  EXPECT_EQ(said_.back().bus, Bus::kWorld);
  EXPECT_TRUE(std::get<RecordAck>(said_.back().message).last);
}

TEST_F(LastWords, InWhateverOrderTheyLeave) {
  const WorldState overtaken[] = {state_of(0), state_of(1)};
  world_leaves(2), agent_leaves(), mission_ends();
  EXPECT_FALSE(left()) << "it lacks states";
  for (const WorldState& state : overtaken) record_.deliver(state, at(1s));
  EXPECT_TRUE(left());
  EXPECT_EQ(record_.trajectory_rows().size(), 2u);
}

TEST_F(LastWords, TheLastRowIsAcknowledgedAtOnce) {
  for (Tick tick = 0; tick < 2; ++tick) record_.deliver(state_of(tick), at(1s));
  EXPECT_EQ(acks(record_.deliver(state_of(2), at(1s))), (std::vector<Tick>{1}));
}

TEST_F(LastWords, AfterASecondIfTheReportOfAnyOfThemIsMissing) {
  for (const int unheard : {0, 1, 2}) {
    Record record(mission_);
    for (Tick tick = 0; tick <= 2; ++tick) record.deliver(state_of(tick), at(1s));
    AgentStatus status = status_of(0, next_sequence());
    status.phase = unheard == 0 ? AgentPhase::kRunning : AgentPhase::kFinished;
    record.deliver(status, at(1s));
    if (unheard != 1) record.deliver(mission_part(1, MissionState::kEnded, roster_of(1)), at(1s));
    WorldState last = state_of(2);
    last.last = unheard != 2;
    record.deliver(last, at(1s));
    advance(record.recorder, at(1999ms));
    EXPECT_FALSE(record.recorder.finished()) << unheard;
    advance(record.recorder, at(2s));
    EXPECT_TRUE(record.recorder.finished()) << unheard;
  }
}

TEST_F(LastWords, AfterASecondIfAStateIsMissing) {
  record_.deliver(state_of(0), at(1s));
  mission_ends(), agent_leaves(), world_leaves(2);
  EXPECT_FALSE(left());
  advance(record_.recorder, at(2s));
  EXPECT_TRUE(left());
}

TEST_F(LastWords, OfAMissionThatWasEndedEarlyTheRowsAreThoseBeforeTheLastState) {
  record_until(1), mission_ends(MissionState::kFailed), agent_leaves(), world_leaves(1);
  EXPECT_TRUE(left());
  EXPECT_STREQ(record_.recorder.result(), "failed");
  EXPECT_EQ(record_.trajectory_rows().size(), 1u);
}

}  // namespace
}  // namespace ergocast
