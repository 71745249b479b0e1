// SPDX-License-Identifier: BSD-3-Clause
// The subscriptions of team/subscriptions.h, on LCM's channels.
#include "team/subscriptions.h"

#include <gtest/gtest.h>

#include <string>

#include "lcmtypes/channels.h"
#include "tests/lcmtypes/sample_messages.h"

namespace ergocast {
namespace {

using namespace test;

TEST(Subscriptions, AreTheChannelsOfTheirTypesAndNoOthers) {
  for (const Subscriptions& subscriptions : kSubscriptions) {
    for (std::size_t bus = 0; bus < kBusCount; ++bus) {
      for (const Message& message : every_message()) {
        EXPECT_EQ(is_channel_of(subscriptions[bus], channel_of(message)),
                  subscribes(subscriptions, static_cast<Bus>(bus), message))
            << channel_of(message) << " on bus " << bus;
      }
      for (const char* nobodys : {"", "ERGOCAST_", "ERGOCAST_SOMETHING", "ERGOCAST_HELLO_",
                                  "ERGOCAST_HELL", "ERGOCAST_CONTRIBUTION"}) {
        EXPECT_FALSE(is_channel_of(subscriptions[bus], nobodys)) << nobodys;
      }
    }
  }
}

}  // namespace
}  // namespace ergocast
