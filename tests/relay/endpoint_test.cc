// SPDX-License-Identifier: BSD-3-Clause
// Places as people write them.
#include "relay/endpoint.h"

#include <gtest/gtest.h>

namespace ergocast::relay {
namespace {

TEST(APlace, IsReadAndWrittenAlike) {
  for (const char* text : {"hub.example.org:7700", "10.0.0.1:1", "[2001:db8::1]:65535", ":7700"}) {
    const auto place = HostAndPort::parse(text);
    ASSERT_TRUE(place) << text;
    EXPECT_EQ(to_text(*place), text);
  }
  for (const char* text : {"", "hub", "hub:", "hub:0", "hub:65536", "2001:db8::1:7700"}) {
    EXPECT_FALSE(HostAndPort::parse(text)) << text;
  }
}

TEST(APlace, ToSendToHasAHost) {
  EXPECT_TRUE(HostAndPort::parse_hub("hub:7700"));
  for (const char* text : {":7700", "[]:7700"}) EXPECT_FALSE(HostAndPort::parse_hub(text)) << text;
}

/// Also on a host that has such addresses on its loopback only.
TEST(APlace, MayBeALiteralOfEitherKind) {
  EXPECT_EQ(to_text(look_up({"127.0.0.1", 7700}).value().at(0)), "127.0.0.1:7700");
  EXPECT_EQ(to_text(look_up({"::1", 7700}).value().at(0)), "[0:0:0:0:0:0:0:1]:7700");
  EXPECT_EQ(to_text(look_up({"", 7700}).value().at(0)), "[0:0:0:0:0:0:0:0]:7700");
}

}  // namespace
}  // namespace ergocast::relay
