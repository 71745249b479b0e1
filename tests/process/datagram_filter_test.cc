// SPDX-License-Identifier: BSD-3-Clause
// The messages that the kernel passes to our sockets, with real sockets: always subscribed ones, a
// share of the repeats during a flood, and no others.
#include "runtime/bus/datagram_filter.h"

#include "lcmtypes/channels.h"
#include "lcmtypes/codec.h"
#include "runtime/bus/socket.h"
#include "tests/lcmtypes/sample_messages.h"

namespace ergocast::test {
namespace {

class DatagramFilter : public ::testing::Test {
 protected:
  DatagramFilter() {
    const sockaddr_in here = address_of("127.0.0.1", kPort);
    EXPECT_EQ(bind(ear_.fd(), reinterpret_cast<const sockaddr*>(&here), sizeof here), 0);
  }

  /// Sends a message in LCM's format; returns whether it arrives.
  bool passes(const Message& message, const std::string& channel) {
    encode(message, bytes_);
    std::string datagram = std::string("LC02\0\0\0\1", 8) + channel + '\0';
    datagram.append(reinterpret_cast<const char*>(bytes_.data()), bytes_.size());
    const sockaddr_in to = address_of("127.0.0.1", kPort);
    sendto(mouth_.fd(), datagram.data(), datagram.size(), 0, reinterpret_cast<const sockaddr*>(&to),
           sizeof to);
    std::array<char, 2048> space;
    const ssize_t size = recv(ear_.fd(), space.data(), space.size(), MSG_DONTWAIT);
    return size == static_cast<ssize_t>(datagram.size());
  }
  bool passes(const Message& message) { return passes(message, channel_of(message)); }

  static Message stamped(Message message, Incarnation life, std::int64_t sequence) {
    std::visit([&](auto& m) { m.header.incarnation = life, m.header.sequence = sequence; },
               message);
    return message;
  }

  static constexpr int kPort = 24700;
  const Socket ear_{AF_INET, SOCK_DGRAM}, mouth_{AF_INET, SOCK_DGRAM};
  std::vector<std::byte> bytes_;
};

TEST_F(DatagramFilter, PassesOnOurMessagesUnderOurNamesOnly) {
  ASSERT_TRUE(admit_only(ear_.fd(), kEveryType));
  for (const Message& message : every_message()) {
    EXPECT_TRUE(passes(message)) << channel_of(message);
    EXPECT_FALSE(passes(message, channel_of(message) + "X")) << channel_of(message);
  }
  for (const char* number : {"0", "17", "127", "999", "1023", "NEW"}) {
    EXPECT_TRUE(passes(command(), std::string("ERGOCAST_COMMAND_") + number));
  }
  for (const char* number : {"", "X", "10000", "1X", "NE", "NEWS"}) {
    EXPECT_FALSE(passes(command(), std::string("ERGOCAST_COMMAND_") + number)) << number;
  }
}

TEST_F(DatagramFilter, PassesOnReplaysOnlyToProcessesThatAskForThem) {
  for (const bool asks : {false, true}) {
    ASSERT_TRUE(admit_only(ear_.fd(), kEveryType, {}, asks));
    for (const Message& message : every_message()) {
      EXPECT_TRUE(passes(message)) << channel_of(message);
      EXPECT_EQ(passes(message, replayed(channel_of(message))), asks) << channel_of(message);
      EXPECT_FALSE(passes(message, replayed(channel_of(message)) + "X")) << channel_of(message);
    }
  }
}

TEST_F(DatagramFilter, PassesOnToEachRoleWhatItSubscribesTo) {
  for (const Subscriptions& subscriptions : kSubscriptions) {
    for (int bus = 0; bus < kBusCount; ++bus) {
      const MessageTypes types = subscriptions[static_cast<std::size_t>(bus)];
      ASSERT_TRUE(admit_only(ear_.fd(), types));
      for (const Message& message : every_message()) {
        EXPECT_EQ(passes(message), subscribes(subscriptions, static_cast<Bus>(bus), message))
            << channel_of(message) << " on bus " << bus;
      }
    }
  }
}

TEST_F(DatagramFilter, InAFloodPassesOnAllThatIsNew) {
  const std::vector<Repeated> flooded = {{0x700000001, 100}, {2, 0}, {3, 5000000000}};
  ASSERT_TRUE(admit_only(ear_.fd(), kEveryType, flooded));
  for (const Message& message : every_message()) {
    for (std::int64_t later = 1; later < 50; ++later) {
      EXPECT_TRUE(passes(stamped(message, 0x700000001, 100 + later))) << channel_of(message);
      EXPECT_TRUE(passes(stamped(message, 2, later))) << channel_of(message);
      EXPECT_TRUE(passes(stamped(message, 4, later))) << "an incarnation that is not repeated";
      EXPECT_TRUE(passes(stamped(message, 3, 5000000000 + later)));
    }
  }
}

TEST_F(DatagramFilter, InAFloodPassesOnOnlyAShareOfTheRepeats) {
  const std::vector<Repeated> flooded = {{0x700000001, 100}, {2, 100}};
  ASSERT_TRUE(admit_only(ear_.fd(), kEveryType, flooded));
  for (const Message& message : every_message()) {
    int passed = 0;
    constexpr int kSent = 3200;
    for (int i = 0; i < kSent; ++i)
      passed += passes(stamped(message, 0x700000001, i % 101)) ? 1 : 0;
    // 100 are expected: six standard deviations to either side.
    EXPECT_GT(passed, 40) << channel_of(message);
    EXPECT_LT(passed, 160) << channel_of(message);
  }
  // The same for numbers of one to four digits.
  for (const char* number : {"7", "42", "127", "1023", "NEW"}) {
    int passed = 0;
    for (int i = 0; i < 3200; ++i) {
      passed +=
          passes(stamped(command(), 2, 100), std::string("ERGOCAST_COMMAND_") + number) ? 1 : 0;
    }
    EXPECT_LT(passed, 160) << number;
  }
  ASSERT_TRUE(admit_only(ear_.fd(), kEveryType));
  for (int i = 0; i < 100; ++i)
    EXPECT_TRUE(passes(stamped(command(), 2, 100))) << "after the flood";
}

TEST_F(DatagramFilter, HasRoomForAsManyIncarnationsAsATeamHas) {
  std::vector<Repeated> flooded;
  for (Incarnation life = 1; life <= 144; ++life) flooded.push_back({life, 100});
  ASSERT_TRUE(admit_only(ear_.fd(), kEveryType, flooded));
  ASSERT_TRUE(admit_only(ear_.fd(), kEveryType, flooded)) << "in place of another";
  int passed = 0;
  for (int i = 0; i < 1440; ++i) {
    const auto life = static_cast<Incarnation>(1 + i % 144);
    passed += passes(stamped(command(), life, 100)) ? 1 : 0;
    EXPECT_TRUE(passes(stamped(command(), life, 101)));
  }
  EXPECT_LT(passed, 144);
}

}  // namespace
}  // namespace ergocast::test
