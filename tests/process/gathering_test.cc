// SPDX-License-Identifier: BSD-3-Clause
// Messages collect in the kernel as long as a mission allows, but none is read late.
#include "runtime/bus/clock.h"
#include "runtime/bus/transport.h"
#include "tests/lcmtypes/sample_messages.h"
#include "tests/process/support/programs.h"

namespace ergocast::test {
namespace {

using namespace std::chrono_literals;

class Gathers : public OwnHost {
 protected:
  Gathers() {
    const auto url = LcmUrl::parse("udpm://239.255.76.67:24700?ttl=0").value();
    transport_ =
        Transport::open(url, 0, {}, {kEveryType, kEveryType, kEveryType},
                        {.on_message = [this](const Message&, Bus bus, AgentId) { ++heard_[bus]; }})
            .value();
  }
  void send(Bus bus, int count = 1) {
    const Message message = bus == Bus::kWorld ? Message(world_state()) : Message(digest());
    transport_->publish(Outbox(static_cast<std::size_t>(count), {bus, message}));
  }
  /// Whether the call returns early, although its next work is due in an hour.
  bool is_woken() {
    const Instant start = now();
    return transport_->deliver_until(start + 1h, -1) - start < kLongestWait;
  }
  bool is_woken_by(Bus bus) {
    return eventually([&] {
      send(bus);
      return is_woken();
    });
  }

  std::map<Bus, int> heard_;
  std::unique_ptr<Transport> transport_;
};

TEST_F(Gathers, OnAllBusesButTheWorlds) {
  transport_->let_gather({1h, 10});
  EXPECT_TRUE(is_woken_by(Bus::kSwarm)) << "nothing has been received before";
  for (const Bus bus : {Bus::kSwarm, Bus::kCommand}) {
    send(bus);
    EXPECT_FALSE(is_woken());
  }
  EXPECT_TRUE(is_woken_by(Bus::kWorld));
}

TEST_F(Gathers, UntilAnythingWakesTheProcess) {
  transport_->let_gather({1h, 10});
  send(Bus::kWorld);
  while (heard_[Bus::kWorld] < 1) transport_->deliver_until(now() + 1h, -1);
  heard_.clear();
  send(Bus::kSwarm, 3);
  send(Bus::kCommand, 2);
  transport_->deliver_until(now(), -1);  // a deadline
  EXPECT_EQ(heard_, (std::map<Bus, int>{{Bus::kSwarm, 3}, {Bus::kCommand, 2}}));
  send(Bus::kSwarm);
  send(Bus::kWorld);
  transport_->deliver_until(now() + 1h, -1);
  EXPECT_EQ(heard_, (std::map<Bus, int>{{Bus::kSwarm, 4}, {Bus::kWorld, 1}, {Bus::kCommand, 2}}));
}

TEST_F(Gathers, ForNoLongerThanItMay) {
  transport_->let_gather({1ms, 10});
  EXPECT_TRUE(is_woken_by(Bus::kSwarm));
  send(Bus::kSwarm);
  EXPECT_TRUE(eventually([&] { return is_woken() && heard_[Bus::kSwarm] >= 2; }));
}

TEST_F(Gathers, NothingWhereABufferIsTooSmallOrABusIsFlooded) {
  transport_->let_gather({1h, 1000000});
  EXPECT_TRUE(is_woken_by(Bus::kSwarm));
  EXPECT_TRUE(is_woken_by(Bus::kSwarm));
  transport_->let_gather({1h, 2});
  send(Bus::kSwarm, 9);
  transport_->deliver_until(now() + 1h, -1);
  EXPECT_TRUE(is_woken_by(Bus::kSwarm));
}

}  // namespace
}  // namespace ergocast::test
