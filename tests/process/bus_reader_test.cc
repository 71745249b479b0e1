// SPDX-License-Identifier: BSD-3-Clause
// One socket of ours among others at its port: the messages that it receives, and those that it
// counts as lost.
#include "runtime/bus/bus_reader.h"

#include "lcmtypes/channels.h"
#include "lcmtypes/codec.h"
#include "runtime/bus/bus_writer.h"
#include "tests/lcmtypes/sample_messages.h"
#include "tests/process/support/programs.h"

namespace ergocast::test {
namespace {

class OneBus : public OwnHost {
 protected:
  static LcmUrl url(const std::string& text) { return LcmUrl::parse(text).value(); }
  static std::unique_ptr<BusReader> reader(const LcmUrl& url, MessageTypes receives = kEveryType) {
    return BusReader::open(url, Bus::kSwarm, receives).value();
  }
  static std::unique_ptr<BusWriter> writer(const LcmUrl& url) {
    return BusWriter::open(url).value();
  }
  /// Sends several messages of one kind.
  static void send(BusWriter& writer, const Message& message, int count = 1) {
    std::vector<std::byte> bytes;
    encode(message, bytes);
    for (int i = 0; i < count; ++i) writer.add(Bus::kSwarm, channel_of(message), bytes);
    writer.flush();
  }
  static void send_bytes(const std::string& address, const std::string& bytes) {
    const Socket socket(AF_INET, SOCK_DGRAM);
    const sockaddr_in to = address_of(address, kPort);
    sendto(socket.fd(), bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr*>(&to),
           sizeof to);
  }
  /// Continues to read; the channels of received messages are in `heard_`.
  std::size_t read(BusReader& reader) {
    std::size_t all = 0;
    while (const std::size_t count = reader.receive()) {
      for (std::size_t i = 0; i < count; ++i) {
        const auto datagram = parse_datagram(reader.datagram(i));
        heard_.emplace_back(datagram ? datagram->channel : "nothing of LCM's");
      }
      all += count;
    }
    return all;
  }
  /// Reads until a message of that kind has arrived.
  bool receives(BusReader& reader, const Message& message) {
    return eventually([&] {
      read(reader);
      return !heard_.empty() && heard_.back() == channel_of(message);
    });
  }

  static constexpr int kPort = 24700;
  static constexpr const char* kGroup = "239.255.76.67";
  const LcmUrl here_ = url("udpm://239.255.76.67:24700?ttl=0");
  std::vector<std::string> heard_;
};

TEST_F(OneBus, ReceivesNoOtherGroupAtItsPort) {
  const LcmUrl there = url("udpm://239.255.76.68:24700?ttl=0");
  const auto our_ear = reader(here_), their_ear = reader(there);
  const auto our_mouth = writer(here_), their_mouth = writer(there);
  for (int i = 0; i < 100; ++i) send(*their_mouth, contribution());
  ASSERT_TRUE(receives(*their_ear, contribution()));
  heard_.clear();
  send(*our_mouth, hello());
  ASSERT_TRUE(receives(*our_ear, hello()));
  EXPECT_EQ(heard_, std::vector<std::string>{channel_of(hello())});
  heard_.clear();
  send(*their_mouth, stop());
  ASSERT_TRUE(receives(*their_ear, stop()));
  EXPECT_EQ(std::count(heard_.begin(), heard_.end(), channel_of(hello())), 0);
}

TEST_F(OneBus, ReceivesNothingThatIsSentToThisHostAlone) {
  const auto ear = reader(here_);
  std::vector<std::byte> bytes;
  encode(stop(), bytes);
  const std::string message(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  for (int i = 0; i < 10; ++i) {
    send_bytes("127.0.0.1", std::string("LC02\0\0\0\1ERGOCAST_STOP\0", 22) + message);
  }
  send(*writer(here_), hello());
  ASSERT_TRUE(receives(*ear, hello()));
  EXPECT_EQ(heard_, std::vector<std::string>{channel_of(hello())});
}

TEST_F(OneBus, IsSharedByManyProcessesThatAllReceiveEverything) {
  std::vector<std::unique_ptr<BusReader>> ears;
  for (int i = 0; i < 5; ++i) ears.push_back(reader(here_));
  const auto one = writer(here_), other = writer(here_);
  send(*one, contribution(), 20);
  send(*other, command(), 20);
  for (const auto& ear : ears) {
    heard_.clear();
    ASSERT_TRUE(eventually([&] { return read(*ear), heard_.size() >= 40; }));
    EXPECT_EQ(std::count(heard_.begin(), heard_.end(), channel_of(command())), 20);
    EXPECT_EQ(std::count(heard_.begin(), heard_.end(), channel_of(contribution())), 20);
  }
}

TEST_F(OneBus, CountsAsLostWhatABufferHadNoRoomForAndNothingElse) {
  constexpr int kSent = 3000;
  for (const char* buffer : {"", "&recv_buf_size=20000", "&recv_buf_size=200000"}) {
    SCOPED_TRACE(buffer);
    const LcmUrl there = url("udpm://239.255.76.67:24700?ttl=0" + std::string(buffer));
    const auto ear = reader(there, kTypes<Contribution>);
    const auto mouth = writer(there);
    std::int64_t rejected = 0;
    for (int i = 0; i < 3; ++i) {
      send(*mouth, team_status(), kSent);
      send(*mouth, contribution());
      ASSERT_TRUE(receives(*ear, contribution()));
    }
    EXPECT_TRUE(eventually([&] { return (rejected += ear->take_rejected()) >= 3 * kSent; }));
    EXPECT_EQ(rejected, 3 * kSent);
    EXPECT_EQ(ear->lost(), 0);
    // More than any buffer holds, while no process reads.
    send(*mouth, contribution(), 4 * kSent);
    std::size_t received = 0;
    EXPECT_TRUE(eventually([&] {
      received += read(*ear);
      return static_cast<std::int64_t>(received) + ear->lost() >= 4 * kSent;
    })) << received
        << " received, " << ear->lost() << " lost";
    EXPECT_EQ(static_cast<std::int64_t>(received) + ear->lost(), 4 * kSent);
    EXPECT_GT(ear->lost(), 0);
    EXPECT_EQ(ear->take_rejected(), 0);
  }
}

TEST_F(OneBus, WhatIsDroppedAsARepeatIsNotLost) {
  const auto ear = reader(here_, kTypes<Command>);
  const auto mouth = writer(here_);
  const Header from = header_of(Message(command()));
  const Repeated repeated[] = {{from.incarnation, from.sequence}};
  ear->drop_repeats(repeated);
  std::int64_t dropped = 0;
  std::size_t received = 0;
  send(*mouth, command(), 3200);
  EXPECT_TRUE(eventually([&] {
    received += read(*ear);
    dropped += ear->take_rejected();
    return static_cast<std::int64_t>(received) + dropped >= 3200;
  }));
  EXPECT_EQ(static_cast<std::int64_t>(received) + dropped, 3200);
  EXPECT_GT(dropped, 2000);
  EXPECT_EQ(ear->lost(), 0);
}

TEST_F(OneBus, ReadsAnyBytesWhereTheKernelHasNoFilter) {
  const auto ear = reader(here_);
  const int nothing = 0;
  ASSERT_EQ(setsockopt(ear->fd(), SOL_SOCKET, SO_DETACH_FILTER, &nothing, sizeof nothing), 0);
  const std::vector<std::string> hostile = {"",
                                            "L",
                                            "LC02",
                                            std::string("LC02\0\0\0\1", 8),
                                            std::string("LC02\0\0\0\1ERGOCAST_HELLO", 22),
                                            std::string("LC03\0\0\0\1\xff\xff\xff\xff", 12),
                                            std::string(70, '\0'),
                                            "LC02    " + std::string(65000, 'E')};
  for (const std::string& bytes : hostile) send_bytes(kGroup, bytes);
  send(*writer(here_), hello());
  ASSERT_TRUE(receives(*ear, hello()));
  EXPECT_EQ(heard_.size(), hostile.size() + 1);
}

TEST_F(OneBus, ADatagramThatIsTooLongArrivesAsOneThatIsTooLong) {
  const auto ear = reader(here_);
  const int nothing = 0;
  ASSERT_EQ(setsockopt(ear->fd(), SOL_SOCKET, SO_DETACH_FILTER, &nothing, sizeof nothing), 0);
  const std::string name = "LC02    " + std::string(kMaxChannelBytes - 1, 'E') + '\0';
  send_bytes(kGroup, name + std::string(60000, 'x'));
  ASSERT_TRUE(eventually([&] { return ear->receive() == 1; }));
  EXPECT_GT(parse_datagram(ear->datagram(0))->message.size(), kMaxDatagramBytes);
}

}  // namespace
}  // namespace ergocast::test
