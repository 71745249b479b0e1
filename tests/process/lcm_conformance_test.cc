// SPDX-License-Identifier: BSD-3-Clause
// LCM's library, recorder and player read what we send, and we read what they send, byte for byte.
#include <deque>
#include <lcm/lcm-cpp.hpp>
#include <thread>

#include "lcmtypes/channels.h"
#include "runtime/bus/clock.h"
#include "runtime/bus/transport.h"
#include "tests/lcmtypes/sample_messages.h"
#include "tests/process/support/programs.h"

namespace ergocast::test {
namespace {

constexpr Bus kBuses[] = {Bus::kSwarm, Bus::kWorld, Bus::kCommand};

/// A datagram, as both sides see it.
struct Said {
  std::string channel;
  Bytes bytes;
  bool operator==(const Said&) const = default;
};

Said printed(const Message& message) { return {channel_of(message), encoded(message)}; }

/// Each kind of message, with names of all lengths.
std::vector<Message> under_every_name() {
  std::vector<Message> all = every_message();
  for (const Message& message : every_message()) {
    for (const AgentId sender : {kUnassigned, 0, 42, kMaxAgents - 1}) {
      Message other = message;
      std::visit([sender](auto& m) { m.header.sender = sender; }, other);
      const bool permitted = decode(encoded(other), 0).has_value();
      if (permitted && transmitter_of(other, channel_of(other))) all.push_back(other);
    }
  }
  return all;
}

class Conformance : public OwnHost {
 protected:
  /// The messages that one side has received on one bus, in order.
  using Heard = std::vector<Said>;

  class LcmEar {
   public:
    explicit LcmEar(const std::string& url) : lcm_(url) {
      lcm_.subscribe(".*", &LcmEar::receive, this)->setQueueCapacity(0);
      EXPECT_GE(lcm_.getFileno(), 0);
    }
    Heard& listen() {
      while (lcm_.handleTimeout(0) > 0) {
      }
      return heard_;
    }

   private:
    void receive(const lcm::ReceiveBuffer* buffer, const std::string& channel) {
      if (channel == "LCM_SELF_TEST") return;  // the library's own
      const auto* bytes = static_cast<const std::byte*>(buffer->data);
      heard_.push_back({channel, {bytes, bytes + buffer->data_size}});
    }
    lcm::LCM lcm_;
    Heard heard_;
  };

  Conformance() : ours_(open({kEveryType, kEveryType, kEveryType}, &heard_)) {}

  static std::unique_ptr<Transport> open(const Subscriptions& observes,
                                         std::map<Bus, Heard>* heard) {
    return Transport::open(
               LcmUrl::parse(kUrl).value(), 0, {}, observes,
               {.on_message = [](const Message&, Bus, AgentId) {},
                .on_accepted =
                    [heard](Bus bus, std::string_view channel, std::span<const std::byte> bytes) {
                      (*heard)[bus].push_back({std::string(channel), {bytes.begin(), bytes.end()}});
                    }})
        .value();
  }
  std::string url(Bus bus) const { return LcmUrl::parse(kUrl).value().of(bus); }
  Heard& listen(Bus bus) {
    ours_->deliver_until(now(), -1);
    return heard_[bus];
  }

  static constexpr const char* kUrl = "udpm://239.255.76.67:24700?ttl=0";
  std::map<Bus, Heard> heard_;
  std::unique_ptr<Transport> ours_;
};

TEST_F(Conformance, LcmReadsEveryMessageThatWePublish) {
  std::deque<LcmEar> theirs;
  Outbox outbox;
  Heard expected;
  for (const Message& message : under_every_name()) expected.push_back(printed(message));
  ASSERT_GT(expected.size(), 20U);
  for (const Bus bus : kBuses) {
    theirs.emplace_back(url(bus));
    for (const Message& message : under_every_name()) outbox.push_back({bus, message});
  }
  ours_->publish(outbox);
  for (std::size_t bus = 0; bus < kBusCount; ++bus) {
    EXPECT_TRUE(eventually([&] { return theirs[bus].listen().size() >= expected.size(); }));
    EXPECT_EQ(theirs[bus].listen(), expected) << "bus " << bus;
    EXPECT_TRUE(eventually([&] { return listen(kBuses[bus]).size() >= expected.size(); }));
    EXPECT_EQ(heard_[kBuses[bus]], expected) << "we receive our own messages, bus " << bus;
  }
}

TEST_F(Conformance, WeReadEveryMessageThatLcmPublishes) {
  for (const Bus bus : kBuses) {
    lcm::LCM theirs(url(bus));
    Heard expected;
    for (const Message& message : under_every_name()) {
      expected.push_back(printed(message));
      const auto& [channel, bytes] = expected.back();
      theirs.publish("NOT_OURS", bytes.data(), static_cast<unsigned>(bytes.size()));
      theirs.publish(channel, bytes.data(), static_cast<unsigned>(bytes.size()));
    }
    EXPECT_TRUE(eventually([&] { return listen(bus).size() >= expected.size(); }));
    EXPECT_EQ(heard_[bus], expected) << url(bus);
  }
  EXPECT_EQ(ours_->refused(), RefusalCounts{});
  EXPECT_EQ(ours_->kernel_drops(), 0);
}

TEST_F(Conformance, EachReceivesWhatItSubscribesToAndNothingElseCounts) {
  std::map<Bus, Heard> heard;
  const auto some = open({kTypes<Hello, Contribution>, 0, kTypes<Command>}, &heard);
  Outbox outbox;
  for (const Bus bus : kBuses) {
    for (const Message& message : every_message()) outbox.push_back({bus, message});
  }
  outbox.push_back({Bus::kSwarm, hello()});
  outbox.push_back({Bus::kCommand, command()});
  ours_->publish(outbox);
  EXPECT_TRUE(eventually([&] {
    some->deliver_until(now(), -1);
    return heard[Bus::kSwarm].size() >= 6 && heard[Bus::kCommand].size() >= 2;
  }));
  EXPECT_EQ(heard[Bus::kSwarm],
            (Heard{printed(hello()), printed(contribution()), printed(averages()),
                   printed(low_sums()), printed(low_averages()), printed(hello())}));
  EXPECT_EQ(heard[Bus::kWorld], Heard{});
  EXPECT_EQ(heard[Bus::kCommand], (Heard{printed(command()), printed(command())}));
  EXPECT_EQ(some->refused(), RefusalCounts{});
  EXPECT_EQ(some->kernel_drops(), 0);
}

/// The messages in a log of LCM's.
std::vector<Said> logged(const std::filesystem::path& file) {
  std::vector<Said> events;
  lcm::LogFile log(file, "r");
  while (const lcm::LogEvent* event = log.good() ? log.readNextEvent() : nullptr) {
    const auto* bytes = static_cast<const std::byte*>(event->data);
    if (event->channel != "LCM_SELF_TEST") {
      events.push_back({event->channel, {bytes, bytes + event->datalen}});
    }
  }
  return events;
}

TEST_F(Conformance, LcmsLoggerRecordsUsAndItsPlayerReachesUs) {
  const auto log = folder_ / "log.lcm";
  setenv("LCM_DEFAULT_URL", url(Bus::kSwarm).c_str(), 1);
  Child logger = begin({"/usr/bin/lcm-logger", "--flush-interval=10", log});
  unsetenv("LCM_DEFAULT_URL");
  Heard expected;
  const auto has_all = [&expected](const Heard& heard) {
    return std::all_of(expected.begin(), expected.end(), [&heard](const Said& one) {
      return std::find(heard.begin(), heard.end(), one) != heard.end();
    });
  };
  // Each message is repeated until it is in the file: the logger's start is not visible, and it
  // buffers few messages.
  for (const Message& message : under_every_name()) {
    expected.push_back(printed(message));
    ASSERT_TRUE(eventually(
        [&] {
          ours_->publish({Bus::kSwarm, message});
          return has_all(logged(log));
        },
        logger.pid()))
        << expected.back().channel << output();
  }
  logger.send(SIGTERM);
  wait_for(logger);
  EXPECT_TRUE(eventually([&] { return has_all(listen(Bus::kSwarm)); }));
  heard_.clear();
  // A busy machine may lose datagrams: then the player plays once more.
  EXPECT_TRUE(eventually([&] {
    Child player = begin({"/usr/bin/lcm-logplayer", "--lcm-url=" + url(Bus::kSwarm), log});
    while (player.running()) {
      listen(Bus::kSwarm);
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    EXPECT_EQ(wait_for(player), 0);
    return has_all(listen(Bus::kSwarm));
  })) << output();
}

}  // namespace
}  // namespace ergocast::test
