// SPDX-License-Identifier: BSD-3-Clause
// The network of the other tests has the properties that they require.
#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <deque>

#include "tests/hosts/team_on_hosts.h"

namespace ergocast::test {
namespace {

using namespace std::chrono_literals;

/// A socket on a host that sends to a multicast group and receives from it.
class Radio {
 public:
  Radio(const Lan& lan, int host) {
    const auto there = lan.visit(host);
    fd_ = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    group_.sin_family = AF_INET;
    group_.sin_port = htons(24700);
    inet_pton(AF_INET, "239.255.76.67", &group_.sin_addr);
    const ip_mreq membership{group_.sin_addr, {INADDR_ANY}};
    EXPECT_EQ(bind(fd_, address(), sizeof group_), 0);
    EXPECT_EQ(setsockopt(fd_, IPPROTO_IP, IP_ADD_MEMBERSHIP, &membership, sizeof membership), 0);
  }
  Radio(const Radio&) = delete;
  Radio& operator=(const Radio&) = delete;
  ~Radio() { close(fd_); }

  void send(std::size_t bytes = 100) {
    const std::string text(bytes, '.');
    sendto(fd_, text.data(), text.size(), 0, address(), sizeof group_);
  }
  /// The number of received messages, once none has arrived for a while.
  int heard() {
    int count = 0;
    char text[2000];
    for (pollfd ready{fd_, POLLIN, 0}; poll(&ready, 1, 200) == 1; ++count) {
      EXPECT_GT(recv(fd_, text, sizeof text, 0), 0);
    }
    return count;
  }

 private:
  const sockaddr* address() const { return reinterpret_cast<const sockaddr*>(&group_); }
  int fd_;
  sockaddr_in group_{};
};

class ThreeHosts : public OnHosts {
 protected:
  void SetUp() override {
    OnHosts::SetUp();
    for (int host = 0; lan_ && host < 3; ++host) radios_.emplace_back(*lan_, host);
  }
  void TearDown() override {
    radios_.clear();
    OnHosts::TearDown();
  }
  Radio& radio(int host) { return radios_[static_cast<std::size_t>(host)]; }
  /// The hosts that receive a message of `from`, as "01": host 0 and host 1.
  std::string hearers(int from) {
    radio(from).send();
    std::string who;
    for (int host = 0; host < 3; ++host) {
      if (radio(host).heard() > 0) who += std::to_string(host);
    }
    return who;
  }
  std::deque<Radio> radios_;
};

TEST_F(ThreeHosts, ReceiveEachOtherUntilACableIsPulled) {
  for (const int host : {0, 1, 2}) EXPECT_EQ(hearers(host), "012");
  lan_->unplug(2);
  EXPECT_EQ(hearers(0), "01");
  EXPECT_EQ(hearers(2), "2");
  lan_->heal();
  EXPECT_EQ(hearers(0), "012");
  EXPECT_EQ(hearers(2), "012");
}

TEST_F(ThreeHosts, CanBeBlockedOneWayOrBoth) {
  lan_->block(0, 2);
  EXPECT_EQ(hearers(0), "01");
  EXPECT_EQ(hearers(2), "012");
  lan_->block(2, 0);
  EXPECT_EQ(hearers(2), "12");
  lan_->heal();
  EXPECT_EQ(hearers(0), "012");
}

TEST_F(ThreeHosts, LoseAShareOfWhatTheyAreSentButForTheSpared) {
  lan_->lose(30, {2});
  for (int i = 0; i < 200; ++i) radio(0).send();
  EXPECT_EQ(radio(0).heard(), 200) << "what does not leave a host is not lost";
  const int heard = radio(1).heard();
  EXPECT_GT(heard, 100);
  EXPECT_LT(heard, 180);
  EXPECT_EQ(radio(2).heard(), 200);
}

TEST_F(ThreeHosts, CountPacketsAndFragments) {
  const std::int64_t before = lan_->packets();
  radio(0).send(1400);
  EXPECT_EQ(hearers(0), "012");
  EXPECT_GE(lan_->packets(), before + 4) << "two, each to two ports";
  EXPECT_EQ(lan_->fragments(), 0);
  lan_->set_mtu(1280);
  radio(0).send(1400);
  EXPECT_EQ(radio(1).heard(), 1);
  EXPECT_EQ(lan_->fragments(), 4);
}

TEST_F(ThreeHosts, SendWhereTheRouteLeads) {
  lan_->add_interface(2);
  lan_->route_multicast(2, "eth1");
  EXPECT_EQ(hearers(2), "") << "not even itself, because it listens to eth0";
  EXPECT_EQ(hearers(0), "012");
  lan_->route_multicast(2, "");
  EXPECT_EQ(hearers(2), "");
  lan_->route_multicast(2, "eth0");
  EXPECT_EQ(hearers(2), "012");
}

TEST_F(ThreeHosts, AreLate) {
  if (!lan_->delay(300ms)) GTEST_SKIP() << "this kernel has no netem";
  radio(0).send();
  EXPECT_EQ(radio(1).heard(), 0);
  EXPECT_EQ(radio(1).heard(), 1);
}

TEST_F(ThreeHosts, SeeTheProgramsThatRunOnThem) {
  EXPECT_TRUE(lan_->processes().empty());
  Program& world = on(1, "ergocast-sim");
  ASSERT_TRUE(world.prints("waiting for a mission")) << world.printed();
  EXPECT_EQ(lan_->processes().size(), 1U);
}

}  // namespace
}  // namespace ergocast::test
