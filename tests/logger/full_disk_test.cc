// SPDX-License-Identifier: BSD-3-Clause
// A recorder whose streams refuse all data for a while, as on a full disk.
#include "logger/null_buffer.h"
#include "tests/logger/record.h"

namespace ergocast {
namespace {

using namespace test;

Incarnation incarnation_of(const Outbox& out) { return header_of(out.back().message).incarnation; }

/// One agent, and more ticks than a recorder keeps.
Mission long_mission(Pace pace) {
  Mission mission = small_mission(1);
  mission.timing.pace = pace;
  mission.timing.tick_count = 10000;
  return mission;
}

void fill(Record& record) { record.trajectory.setstate(std::ios::badbit); }
void free_space(Record& record, Instant now) {
  record.trajectory.clear();
  record.recorder.go_on(now);
}

TEST(FullDisk, NothingIsAcknowledgedThatIsNotWritten) {
  Record record(long_mission(Pace::kLockstep));
  for (Tick tick = 0; tick <= 10; ++tick) record.deliver(state_of(tick));
  fill(record);
  Outbox sent;
  for (Tick tick = 11; tick <= 60; ++tick) sent = record.deliver(state_of(tick), at(1s));
  EXPECT_TRUE(acks(sent).empty());
  EXPECT_TRUE(acks(advance(record.recorder, at(5s))).empty());
  EXPECT_EQ(record.trajectory_rows().size(), 10U);
}

TEST(FullDisk, WhatWasStillHeldIsWrittenAfterwards) {
  Record record(long_mission(Pace::kLockstep)), untroubled(long_mission(Pace::kLockstep));
  for (Tick tick = 0; tick <= 70; ++tick) {
    untroubled.deliver(state_of(tick));
    if (tick == 10) fill(record);
    record.deliver(state_of(tick));
  }
  free_space(record, at(3s));
  const Outbox sent = advance(record.recorder, at(3s));
  EXPECT_EQ(acks(sent), std::vector<Tick>{69});
  EXPECT_NE(incarnation_of(sent), kLoggerLife) << "a world that gave it up takes it back";
  EXPECT_EQ(record.trajectory.str(), untroubled.trajectory.str());
  EXPECT_EQ(record.recorder.facts().gaps, 0);
}

TEST(FullDisk, InLockstepTheRecordGoesOnWhereTheTeamIsAndCountsTheGap) {
  Record record(long_mission(Pace::kLockstep));
  for (Tick tick = 0; tick <= 10; ++tick) record.deliver(state_of(tick));
  fill(record);
  for (Tick tick = 11; tick <= 5000; ++tick) record.deliver(state_of(tick), at(59s));
  free_space(record, at(60s));
  advance(record.recorder, at(60s));
  // It writes its buffered ticks, 1024 from the first missing one on. Then, after a while, it
  // writes the world's repeats.
  record.deliver(state_of(5000), at(61s));
  EXPECT_EQ(acks(record.deliver(state_of(5001), at(62s))), std::vector<Tick>{5000});
  const auto rows = record.trajectory_rows();
  const auto ticks = static_cast<Tick>(rows.size());
  EXPECT_EQ(number(rows.back(), 0), 5000);
  EXPECT_GT(ticks, 1000);
  EXPECT_LT(ticks, 1100);
  EXPECT_EQ(record.recorder.facts().gaps, 5001 - ticks);
}

TEST(FullDisk, InRealTimeTheRecordGoesOnWhereTheTeamIsAndCountsTheGap) {
  Record record(long_mission(Pace::kRealtime));
  for (Tick tick = 0; tick <= 10; ++tick) record.deliver(state_of(tick));
  fill(record);
  for (Tick tick = 11; tick <= 5000; ++tick) record.deliver(state_of(tick), at(1s));
  free_space(record, at(60s));
  for (Tick tick = 5001; tick <= 5100; ++tick) record.deliver(state_of(tick), at(61s));
  const auto rows = record.trajectory_rows();
  const auto ticks = static_cast<Tick>(rows.size());
  EXPECT_EQ(number(rows.back(), 0), 5099);
  EXPECT_GT(ticks, 1000);
  EXPECT_LT(ticks, 1200);
  EXPECT_EQ(record.recorder.facts().gaps, 5100 - ticks);
}

TEST(Statuses, OfNoMoreIncarnationsThanThereCanBeAreKept) {
  Record record(long_mission(Pace::kLockstep));
  const auto receive = [&](Incarnation life, std::int64_t sequence) {
    AgentStatus status = status_of(1, sequence);
    status.header.incarnation = life;
    record.deliver(status);
  };
  for (Incarnation life = 1; life <= Liveness::kMaxIncarnations + 1; ++life) receive(life, 1);
  EXPECT_EQ(record.recorder.statuses().size(), Liveness::kMaxIncarnations - 1)
      << "and the coordinator";
  receive(1, 2);
  EXPECT_EQ(record.recorder.statuses().at({1, 1}).header.sequence, 2) << "of those it goes on";
}

TEST(FullDisk, UntilTheEndOfTheMissionTheRecordIsWhatFitted) {
  Record record(long_mission(Pace::kLockstep));
  for (Tick tick = 0; tick <= 10; ++tick) record.deliver(state_of(tick));
  fill(record);
  for (Tick tick = 11; tick <= 60; ++tick) record.deliver(state_of(tick), at(1s));
  record.deliver(mission_part(1, MissionState::kEnded, roster_of(1)), at(2s));
  advance(record.recorder, at(10s));
  EXPECT_TRUE(record.recorder.finished());
  EXPECT_STREQ(record.recorder.result(), "stopped");
  EXPECT_EQ(record.trajectory_rows().size(), 10U);
}

TEST(FullDisk, NoStreamIsFullFromTheBeginning) {
  NullBuffer nowhere;
  const auto record_to = [](std::ostream& trajectory, std::ostream& metrics) {
    Recorder(kRun, kLoggerLife, trajectory, metrics);
  };
  record_to(nowhere, nowhere);
  EXPECT_TRUE(nowhere << 'x' << "a line\n" << std::flush);
  std::ostream no_buffer(nullptr);
  EXPECT_DEATH(record_to(no_buffer, nowhere), "broken precondition: good");
  EXPECT_DEATH(record_to(nowhere, no_buffer), "broken precondition: good");
}

}  // namespace
}  // namespace ergocast
