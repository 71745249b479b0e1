// SPDX-License-Identifier: BSD-3-Clause
// The channels that are allowed for each message.
#include "lcmtypes/channels.h"

#include <gtest/gtest.h>

#include "tests/lcmtypes/sample_messages.h"

namespace ergocast {
namespace {

using namespace test;

TEST(Channels, HaveTheDocumentedNames) {
  EXPECT_EQ(channel_of(hello()), "ERGOCAST_HELLO");
  EXPECT_EQ(channel_of(mission_part()), "ERGOCAST_MISSION");
  EXPECT_EQ(channel_of(contribution()), "ERGOCAST_CONTRIBUTION_3");
  EXPECT_EQ(channel_of(agent_status()), "ERGOCAST_AGENT_STATUS_3");
  EXPECT_EQ(channel_of(team_status()), "ERGOCAST_TEAM_STATUS");
  EXPECT_EQ(channel_of(stop()), "ERGOCAST_STOP");
  EXPECT_EQ(channel_of(world_state()), "ERGOCAST_WORLD_STATE");
  EXPECT_EQ(channel_of(command()), "ERGOCAST_COMMAND_2");
  EXPECT_EQ(channel_of(record_ack()), "ERGOCAST_RECORD_ACK");
  EXPECT_EQ(channel_of(digest()), "ERGOCAST_DIGEST_3");
  EXPECT_EQ(channel_of(beacon()), "ERGOCAST_BEACON_3");
  EXPECT_EQ(channel_of(effort()), "ERGOCAST_EFFORT_3");
  EXPECT_EQ(channel_of(contribution(), 9), "ERGOCAST_CONTRIBUTION_9") << "repeated by agent 9";
}

TEST(Channels, CarryTheirOwnTypeOnly) {
  for (const Message& message : every_message()) {
    for (const Message& other : every_message()) {
      EXPECT_EQ(transmitter_of(message, channel_of(other)).has_value(),
                message.index() == other.index())
          << "message kind " << message.index() << " on " << channel_of(other);
    }
    EXPECT_FALSE(transmitter_of(message, ""));
    EXPECT_FALSE(transmitter_of(message, "ERGOCAST_"));
    EXPECT_FALSE(transmitter_of(message, "ERGOCAST_STATUS_3"));
  }
}

TEST(Channels, NameTheSenderButForContributionsWhichOthersMayRelay) {
  EXPECT_FALSE(transmitter_of(command(), "ERGOCAST_COMMAND_3"));
  EXPECT_FALSE(transmitter_of(agent_status(), "ERGOCAST_AGENT_STATUS_30"));
  EXPECT_FALSE(transmitter_of(digest(), "ERGOCAST_DIGEST_30"));
  EXPECT_EQ(transmitter_of(contribution(), "ERGOCAST_CONTRIBUTION_3"), 3);
  EXPECT_EQ(transmitter_of(contribution(), "ERGOCAST_CONTRIBUTION_9"), 9);
  for (const char* nobody : {"", "x", "-1", "1024", "9 ", "99999999999"}) {
    EXPECT_FALSE(transmitter_of(contribution(), std::string("ERGOCAST_CONTRIBUTION_") + nobody))
        << nobody;
  }
}

}  // namespace
}  // namespace ergocast
