// SPDX-License-Identifier: BSD-3-Clause
// The findings of `ergocast doctor` on hosts of one network, without and with faults.
#include <unistd.h>

#include <algorithm>
#include <map>

#include "tests/hosts/team_on_hosts.h"

namespace ergocast::test {
namespace {

using nlohmann::json;

class DoctorOnHosts : public OnHosts {
 protected:
  struct Answer {
    int exit_code = -1;
    json report;

    /// The finding of a check; null if there is none.
    json of(const std::string& check) const {
      for (const json& finding : report["findings"]) {
        if (finding["check"] == check) return finding;
      }
      return {};
    }
    /// The value of the only peer; null if there is not exactly one.
    json peer(const char* what) const {
      const json& peers = report["peers"];
      return peers.size() == 1 ? peers[0][what] : json();
    }
    /// One of the losses of the only peer [%]; −1 if there is not exactly one.
    double lost(const char* direction, const char* what = "lost_percent") const {
      const json& loss = peer(direction);
      return loss.is_object() ? loss[what].get<double>() : -1;
    }
  };

  static std::string url(int ttl) {
    return "udpm://239.255.76.67:24000?ttl=" + std::to_string(ttl);
  }
  Child start_on(int host, const std::string& url, const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments{"doctor", "--json", "--lcm-url", url};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const auto there = lan_->visit(host);
    Child child = start("ergocast", arguments);
    logs_[host] = log_;
    return child;
  }
  Answer answer(int host, Child& child) {
    const int code = wait_for(child);
    Answer answer{code, json::parse(text_of(logs_[host]), nullptr, false)};
    EXPECT_FALSE(answer.report.is_discarded()) << text_of(logs_[host]);
    return answer;
  }
  Answer alone(int host, int ttl) {
    Child child = start_on(host, url(ttl));
    return answer(host, child);
  }
  /// Runs --peer on hosts 0 and 1 at once, with 100 probes from each. Repeats if a busy machine
  /// started one so late that a host received few probes.
  std::pair<Answer, Answer> both(int ttl_of_0 = 1) {
    constexpr int kTries = 5;
    for (int n = 1;; ++n) {
      Child first = start_on(0, url(ttl_of_0), {"--peer", "5"});
      Child second = start_on(1, url(1), {"--peer", "5"});
      EXPECT_TRUE(eventually([&] {
        const bool second_runs = second.running();  // the first one to end may have found something
        return !first.running() && !second_runs;
      }));
      const Answer one = answer(0, first), two = answer(1, second);
      const double heard = std::max(one.lost("from_it", "probes"), two.lost("from_it", "probes"));
      const bool nothing_or_enough = heard < 0 || heard > 30;
      if (nothing_or_enough || n == kTries) return {one, two};
    }
  }

 private:
  std::map<int, std::filesystem::path> logs_;
};

TEST_F(DoctorOnHosts, TwoThatReceiveEachOtherAreReported) {
  const auto [one, two] = both();
  for (const auto& [answer, other] : {std::pair(one, "host-1"), std::pair(two, "host-0")}) {
    EXPECT_EQ(answer.exit_code, 0) << answer.report.dump(1);
    ASSERT_EQ(answer.report["peers"].size(), 1u) << answer.report.dump(1);
    EXPECT_EQ(answer.peer("host"), other);
    EXPECT_EQ(answer.peer("hears_this_host"), true);
    EXPECT_EQ(answer.lost("from_it"), 0);
    EXPECT_EQ(answer.lost("to_it"), 0);
    EXPECT_GT(answer.lost("to_it", "probes"), 30);
    EXPECT_EQ(answer.peer("duplicates"), 0);
    EXPECT_GT(answer.peer("round_trip_ms")["p50"], 0.0);
  }
}

TEST_F(DoctorOnHosts, AOneWayPartitionIsSeenByTheSideThatReceives) {
  lan_->block(0, 1);
  const auto [one, two] = both();
  EXPECT_EQ(one.exit_code, 1);
  EXPECT_EQ(one.peer("hears_this_host"), false);
  EXPECT_NE(one.of("peer host-1")["found"].dump().find("one-way"), std::string::npos);
  EXPECT_EQ(two.exit_code, 1);
  EXPECT_EQ(two.report["peers"].size(), 0u);
  EXPECT_EQ(two.of("peers")["level"], "problem");
}

TEST_F(DoctorOnHosts, LossIsMeasuredInItsDirection) {
  lan_->on_switch(
      "nft 'add table bridge t; add chain bridge t f { type filter hook forward priority 0; }; "
      "add rule bridge t f iifname p0 oifname p1 ip protocol udp numgen inc mod 10 0 drop'");
  const auto [one, two] = both();
  EXPECT_EQ(one.exit_code, 1);
  EXPECT_EQ(one.of("peer host-1")["level"], "warning");
  EXPECT_EQ(one.lost("from_it"), 0);
  EXPECT_EQ(two.lost("to_it"), 0);
  for (const double lost : {one.lost("to_it"), two.lost("from_it")}) {
    EXPECT_GT(lost, 5);
    EXPECT_LT(lost, 15);
  }
}

TEST_F(DoctorOnHosts, ANarrowSwitchLosesOnlyWhatIsLong) {
  lan_->on_switch("ip link set p0 mtu 1000 && ip link set p1 mtu 1000");
  const auto [one, two] = both();
  for (const Answer& answer : {one, two}) {
    EXPECT_EQ(answer.exit_code, 1);
    EXPECT_EQ(answer.lost("from_it", "lost_small_percent"), 0) << answer.report.dump(1);
    EXPECT_EQ(answer.lost("from_it", "lost_large_percent"), 100);
  }
  EXPECT_EQ(one.of("peer host-1")["found"], "only short datagrams arrive");
  EXPECT_EQ(one.of("MTU")["level"], "ok");  // of its own interface
}

TEST_F(DoctorOnHosts, AnInterfaceWithASmallMtuIsAWarning) {
  lan_->on_host(0, "ip link set eth0 mtu 1000");
  const Answer answer = alone(0, 1);
  EXPECT_EQ(answer.exit_code, 1);
  EXPECT_EQ(answer.of("MTU")["level"], "warning");
  lan_->on_host(0, answer.of("MTU")["remedy"]);
  EXPECT_EQ(alone(0, 1).exit_code, 0);
}

TEST_F(DoctorOnHosts, TheWrongOneOfTwoInterfacesIsMendedByTheCommandGiven) {
  lan_->add_interface(0);
  lan_->route_multicast(0, "eth1");
  const auto [wrong, deaf] = both();
  EXPECT_EQ(wrong.exit_code, 1);
  EXPECT_EQ(wrong.report["peers"].size(), 0u);
  EXPECT_EQ(deaf.report["peers"].size(), 0u);
  EXPECT_EQ(wrong.of("route")["found"],
            "239.255.76.67 goes over eth1 (10.0.1.1), and not over eth0");
  lan_->on_host(0, wrong.of("route")["remedy"]);
  const auto [right, hearing] = both();
  EXPECT_EQ(right.exit_code, 0) << right.report.dump(1);
  EXPECT_EQ(hearing.exit_code, 0) << hearing.report.dump(1);
}

TEST_F(DoctorOnHosts, LoopbackIsAProblemForATeamOnSeveralHosts) {
  lan_->route_multicast(0, "lo");
  const Answer answer = alone(0, 1);
  EXPECT_EQ(answer.exit_code, 1);
  EXPECT_EQ(answer.of("route")["remedy"], "ip route replace 224.0.0.0/4 dev eth0");
  EXPECT_EQ(alone(0, 0).exit_code, 0);
}

TEST_F(DoctorOnHosts, ATtlOfZeroOnOneSideIsOneWay) {
  const auto [one, two] = both(/*ttl_of_0=*/0);
  EXPECT_EQ(one.of("TTL")["level"], "problem");
  EXPECT_EQ(one.peer("hears_this_host"), false);
  EXPECT_EQ(two.report["peers"].size(), 0u);
}

TEST_F(DoctorOnHosts, AFirewallIsOpenedByTheCommandsGiven) {
  lan_->on_host(0,
                "nft 'add table inet wall; "
                "add chain inet wall in { type filter hook input priority 0; policy drop; }'");
  const Answer answer = alone(0, 1);
  EXPECT_EQ(answer.exit_code, 3);
  EXPECT_EQ(answer.of("self test")["level"], "problem");
  lan_->on_host(0, answer.of("firewall")["remedy"]);
  EXPECT_EQ(alone(0, 1).exit_code, 0);
}

TEST_F(DoctorOnHosts, ACableThatIsPulledIsNamed) {
  // The kernel reports a change of a link with a delay.
  lan_->unplug(0);
  lan_->heal();
  lan_->unplug(0);
  const Answer answer = alone(0, 1);
  EXPECT_EQ(answer.exit_code, 1);
  EXPECT_EQ(answer.of("interface")["found"], "eth0 has no carrier");
}

TEST_F(DoctorOnHosts, ATunnelIsAnInterfaceToo) {
  if (access("/dev/net/tun", W_OK) != 0) GTEST_SKIP() << "no /dev/net/tun here";
  lan_->on_host(0,
                "ip tuntap add dev tun0 mode tun && ip addr add 10.9.0.1/24 dev tun0 && "
                "ip link set tun0 up");
  lan_->route_multicast(0, "tun0");
  const Answer answer = alone(0, 1);
  EXPECT_EQ(answer.exit_code, 1);
  EXPECT_EQ(answer.of("interface")["found"], "tun0 has no carrier")
      << "its other end is not connected";
}

}  // namespace
}  // namespace ergocast::test
