// SPDX-License-Identifier: BSD-3-Clause
// What the world knows of the record: only growth is progress.
#include "sim/record_window.h"

#include <gtest/gtest.h>

#include "tests/sim/driven_world.h"

namespace ergocast {
namespace {

using namespace test;

constexpr auto kPatience = 3s;

TEST(RecordWindow, AnAcknowledgementOfNothingNewIsNoProgress) {
  RecordWindow record;
  record.start(at(0s));
  record.remember({WorldState{}});
  record.acknowledge(ack_of(5), at(1s));
  record.acknowledge(ack_of(5), at(2s));
  record.acknowledge(ack_of(3), at(3s));
  EXPECT_EQ(record.progress(), at(1s));
  EXPECT_TRUE(record.complete(6)) << "an older acknowledgement takes nothing back";
  const Tick too_far = 5 + kRecordWindowTicks + 1;
  EXPECT_FALSE(record.is_close(too_far, at(4s), kPatience));
  EXPECT_TRUE(record.is_close(too_far, at(5s), kPatience)) << "given up";
}

TEST(RecordWindow, ARestartedLoggerMayHaveLessAndIsWaitedForAgain) {
  RecordWindow record;
  record.start(at(0s));
  record.remember({WorldState{}});
  record.acknowledge(ack_of(500), at(1s));
  EXPECT_TRUE(record.is_close(500 + kRecordWindowTicks + 1, at(5s), kPatience));
  EXPECT_TRUE(record.lost());
  RecordAck again = ack_of(100);
  again.header.incarnation += 1;
  record.acknowledge(again, at(6s));
  EXPECT_FALSE(record.lost());
  EXPECT_FALSE(record.complete(501));
  EXPECT_FALSE(record.is_close(100 + kRecordWindowTicks + 1, at(7s), kPatience));
}

TEST(RecordWindow, ARestartedWorldPublishesItsFirstStateForALoggerThatHasFarLess) {
  RecordWindow record;
  record.start(at(0s));
  EXPECT_FALSE(record.is_close(469, at(0s), kPatience)) << "no logger has reported";
  record.acknowledge(ack_of(94), at(0s));
  EXPECT_TRUE(record.is_close(469, at(1s), kPatience));
  WorldState first;
  first.header.tick = 469;
  record.remember({first});
  EXPECT_FALSE(record.is_close(470, at(1s), kPatience));
  record.acknowledge(ack_of(468), at(2s));
  EXPECT_TRUE(record.is_close(470, at(2s), kPatience));
}

}  // namespace
}  // namespace ergocast
