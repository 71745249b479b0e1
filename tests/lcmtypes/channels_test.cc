// Which message may come under which name.
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
}

TEST(Channels, CarryTheirOwnTypeOnly) {
  for (const Message& message : every_message()) {
    for (const Message& other : every_message()) {
      EXPECT_EQ(belongs_on(message, channel_of(other)), message.index() == other.index())
          << "message kind " << message.index() << " on " << channel_of(other);
    }
    EXPECT_FALSE(belongs_on(message, ""));
    EXPECT_FALSE(belongs_on(message, "ERGOCAST_"));
    EXPECT_FALSE(belongs_on(message, "ERGOCAST_STATUS_3"));
  }
}

TEST(Channels, NameTheSenderButForContributionsWhichOthersMayRelay) {
  EXPECT_FALSE(belongs_on(command(), "ERGOCAST_COMMAND_3"));
  EXPECT_FALSE(belongs_on(agent_status(), "ERGOCAST_AGENT_STATUS_30"));
  EXPECT_TRUE(belongs_on(contribution(), "ERGOCAST_CONTRIBUTION_9"));
}

}  // namespace
}  // namespace ergocast
