// SPDX-License-Identifier: BSD-3-Clause
// A recorder that goes on leaves out only rows that no process can repeat.
#include <gtest/gtest.h>

#include "tests/logger/resumed_record.h"

namespace ergocast {
namespace {

using namespace test;

constexpr Incarnation kNextWorldLife = kWorldLife + 1;

WorldState of_world(Incarnation incarnation, WorldState state) {
  state.header.incarnation = incarnation;
  return state;
}

TEST_F(Resume, AStateThatIsRepeatedInTimeIsNoGap) {
  Record resumed(small_mission(1), ten_rows());
  EXPECT_EQ(acks(resumed.deliver(state_of(30), at(10s))), (std::vector<Tick>{9}));
  for (Tick tick = 10; tick < 30; ++tick)
    resumed.deliver(state_of(tick), at(10s + (tick - 9) * 200ms));
  EXPECT_EQ(resumed.recorder.next_row(), 30);
  EXPECT_EQ(resumed.recorder.facts().gaps, 0);
}

TEST_F(Resume, WhatIsNotRepeatedWithinHalfASecondIsAGap) {
  Record resumed(small_mission(1), ten_rows());
  for (const Tick tick : {30, 31, 33, 34}) resumed.deliver(state_of(tick), at(10s));
  advance(resumed.recorder, at(10499ms));
  EXPECT_EQ(resumed.recorder.next_row(), 10);
  advance(resumed.recorder, at(10500ms));
  EXPECT_EQ(resumed.recorder.next_row(), 31);
  EXPECT_EQ(resumed.recorder.facts().gaps, 20);
  advance(resumed.recorder, at(30s));
  EXPECT_EQ(resumed.recorder.next_row(), 31) << "32 came after the first that was received";
  resumed.deliver(state_of(32), at(30s));
  EXPECT_EQ(resumed.recorder.next_row(), 34);
  EXPECT_EQ(resumed.recorder.facts().gaps, 20);
}

TEST_F(Resume, AGapEndsAtTheFirstStateReceivedEvenIfTheNextIsMissing) {
  Record resumed(small_mission(1), ten_rows());
  for (const Tick tick : {30, 32}) resumed.deliver(state_of(tick), at(10s));
  advance(resumed.recorder, at(30s));
  EXPECT_EQ(resumed.recorder.next_row(), 30);
  resumed.deliver(state_of(31), at(30s));
  EXPECT_EQ(resumed.recorder.next_row(), 32);
}

TEST_F(Resume, AGapEndsWithTheFirstPairThatIsRepeated) {
  Record resumed(small_mission(1), ten_rows());
  for (const Tick tick : {30, 20, 21, 18}) resumed.deliver(state_of(tick), at(10s));
  advance(resumed.recorder, at(11s));
  EXPECT_EQ(resumed.recorder.next_row(), 21);
  EXPECT_EQ(resumed.recorder.facts().gaps, 10);
}

TEST_F(Resume, NothingIsGivenUpWhileNoNewerStateIsHeld) {
  Record resumed(small_mission(1), ten_rows());
  advance(resumed.recorder, at(1h));
  resumed.deliver(state_of(10), at(2h));
  advance(resumed.recorder, at(3h));
  EXPECT_EQ(resumed.recorder.next_row(), 10);
  EXPECT_EQ(resumed.recorder.facts().gaps, 0);
}

TEST_F(Resume, ALastTickThatWasCutOffCannotBecomeAGap) {
  const Mission mission = small_mission(3);
  Record former(mission);
  for (Tick tick = 0; tick <= 10; ++tick) former.deliver(team_at(tick));
  const std::string rows = former.trajectory.str();
  const std::string cut = rows.substr(0, rows.rfind('\n', rows.size() - 2) + 5);  // 9's third row
  Record resumed(mission, past(cut, former.metrics.str()));
  for (const Tick tick : {20, 21}) resumed.deliver(team_at(tick), at(10s));
  advance(resumed.recorder, at(11s));
  EXPECT_EQ(resumed.recorder.next_row(), 21);
  EXPECT_EQ(resumed.recorder.facts().gaps, 10) << "10 … 19: of 9 there are rows";
  EXPECT_EQ(resumed.recorder.facts().ticks, 11);
}

TEST_F(Resume, TheWorldMayHaveGoneFarAheadButNotBeyondTheMission) {
  Mission mission = small_mission(1);
  mission.timing.tick_count = 9000;
  Record resumed(mission, ten_rows());
  for (const Tick tick : {9001, 8000, 8001}) resumed.deliver(state_of(tick), at(10s));
  advance(resumed.recorder, at(11s));
  EXPECT_EQ(resumed.recorder.next_row(), 8001);
  EXPECT_EQ(resumed.recorder.facts().gaps, 7990);
}

TEST_F(Resume, ARecordThatEndsWritesWhatStandsBehindTheGap) {
  Record resumed(small_mission(1), ten_rows());
  for (const Tick tick : {30, 31, 32}) resumed.deliver(state_of(tick), at(10s));
  resumed.recorder.stop("SIGTERM");
  EXPECT_EQ(resumed.recorder.next_row(), 32);
  EXPECT_EQ(resumed.recorder.facts().gaps, 20);
}

TEST_F(Resume, ANewWorldMayLeaveAGapBeforeItsFirstState) {
  Record record(small_mission(1));
  for (Tick tick = 0; tick <= 10; ++tick) record.deliver(state_of(tick));
  for (const Tick tick : {14, 15, 17}) {
    record.deliver(of_world(kNextWorldLife, state_of(tick)), at(10s));
  }
  advance(record.recorder, at(10499ms));
  EXPECT_EQ(record.recorder.next_row(), 10);
  advance(record.recorder, at(14s));
  EXPECT_EQ(record.recorder.next_row(), 15) << "16 is repeated by the world that sent 17";
  EXPECT_EQ(record.recorder.facts().gaps, 4);
}

TEST_F(Resume, ANewWorldThatRepeatsWhatIsRecordedChangesNothing) {
  for (Mission mission : {small_mission(1), realtime_mission()}) {
    Record record(mission);
    for (Tick tick = 0; tick <= 10; ++tick) record.deliver(state_of(tick));
    // The new world does not know which velocities led there.
    record.deliver(of_world(kNextWorldLife, state_of(8, {108, 500, 0}, {0, 0, 0})), at(1s));
    record.deliver(of_world(kNextWorldLife, state_of(10, {110, 500, 0}, {0, 0, 0})), at(1s));
    for (Tick tick = 11; tick <= 20; ++tick) {
      record.deliver(of_world(kNextWorldLife, state_of(tick)), at(1s));
    }
    const auto rows = record.trajectory_rows();
    ASSERT_EQ(rows.size(), 20u);
    for (const std::string& row : rows) EXPECT_EQ(number(row, 5), 10) << row;
    EXPECT_EQ(record.recorder.facts().gaps, 0);
  }
}

TEST_F(Resume, AStateThatIsHeldIsNotReplacedByANewWorldsRepeat) {
  Record record(small_mission(1));
  for (const Tick tick : {0, 1, 3, 4}) record.deliver(state_of(tick));
  record.deliver(of_world(kNextWorldLife, state_of(4, {104, 500, 0}, {0, 0, 0})), at(1s));
  advance(record.recorder, at(2s));
  const auto rows = record.trajectory_rows();
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(columns(rows[1])[0], "3");
  EXPECT_EQ(number(rows[1], 5), 10);
}

TEST_F(Resume, PartsOfTwoWorldsMakeNoState) {
  Record record(small_mission(2));
  const auto part_of = [](Incarnation world, Tick tick, int part) {
    WorldState state = of_world(world, world_state(tick, {{100, 500, 0}}));
    state.vehicles[0].id = part;
    state.part = part;
    state.parts = 2;
    return state;
  };
  for (const int part : {0, 1}) record.deliver(part_of(kWorldLife, 0, part));
  record.deliver(part_of(kWorldLife, 1, 0));
  record.deliver(part_of(kNextWorldLife, 1, 1));
  EXPECT_TRUE(record.trajectory_rows().empty());
  record.deliver(part_of(kNextWorldLife, 1, 0));
  EXPECT_EQ(record.trajectory_rows().size(), 2u);
}

}  // namespace
}  // namespace ergocast
