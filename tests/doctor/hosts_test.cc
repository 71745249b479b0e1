// The real program on hosts that hang on a bridge, with what goes wrong there.
#include <unistd.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "tests/doctor/bridged_hosts.h"
#include "tests/process/programs.h"

namespace ergocast::doctor {
namespace {

using nlohmann::json;

class DoctorOnHosts : public test::OwnHost {
 protected:
  void SetUp() override {
    if (!test::may_mount()) GTEST_SKIP() << "needs root: hosts on a bridge";
    hosts_ = std::make_unique<BridgedHosts>(2);
  }

  struct Answer {
    int exit_code = -1;
    json told;

    /// The finding of a check; null if there is none.
    json of(const std::string& check) const {
      for (const json& finding : told["findings"]) {
        if (finding["check"] == check) return finding;
      }
      return {};
    }
    /// Of the only peer; null if there is not exactly one.
    json peer(const char* what) const {
      const json& peers = told["peers"];
      return peers.size() == 1 ? peers[0][what] : json();
    }
    /// Of the only peer, one of its losses [%]; −1 if there is not exactly one.
    double lost(const char* direction, const char* what = "lost_percent") const {
      const json& loss = peer(direction);
      return loss.is_object() ? loss[what].get<double>() : -1;
    }
  };

  static std::string url(int ttl) {
    return "udpm://239.255.76.67:24000?ttl=" + std::to_string(ttl);
  }
  Child start(int host, const std::string& url, std::vector<std::string> more) {
    std::vector<std::string> command = {std::string(ERGOCAST_BIN_DIR) + "/ergocast", "doctor",
                                        "--json", "--lcm-url", url};
    command.insert(command.end(), more.begin(), more.end());
    return hosts_->start(host, command, log_of(host));
  }
  Answer answer(int host, Child& child) {
    Answer answer{wait_for(child), json::parse(test::text_of(log_of(host)), nullptr, false)};
    EXPECT_FALSE(answer.told.is_discarded()) << test::text_of(log_of(host));
    return answer;
  }
  std::filesystem::path log_of(int host) const {
    return folder_ / ("host-" + std::to_string(host) + "-" + std::to_string(round_));
  }

  Answer alone(int host, int ttl) {
    ++round_;
    Child child = start(host, url(ttl), {});
    return answer(host, child);
  }
  /// --peer on both hosts at once, 200 probes from each.
  std::pair<Answer, Answer> both(int ttl_of_1 = 1) {
    ++round_;
    Child first = start(1, url(ttl_of_1), {"--peer"});
    Child second = start(2, url(1), {"--peer"});
    Answer one = answer(1, first);
    return {one, answer(2, second)};
  }
  /// On the switch; `rule` is about frames that go from host 1 to host 2 and carry UDP.
  void on_the_way_to_2(const std::string& rule) {
    ASSERT_EQ(hosts_->on_switch("nft add table bridge t && nft add chain bridge t f "
                                "'{ type filter hook forward priority 0; }' && "
                                "nft add rule bridge t f iifname p1 oifname p2 ip protocol udp " +
                                rule),
              0);
  }

  std::unique_ptr<BridgedHosts> hosts_;
  int round_ = 0;
};

TEST_F(DoctorOnHosts, TwoThatHearEachOtherAreToldSo) {
  const auto [one, two] = both();
  for (const auto& [answer, other] : {std::pair(one, "host2"), std::pair(two, "host1")}) {
    EXPECT_EQ(answer.exit_code, 0) << answer.told.dump(1);
    ASSERT_EQ(answer.told["peers"].size(), 1u) << answer.told.dump(1);
    EXPECT_EQ(answer.peer("host"), other);
    EXPECT_EQ(answer.peer("hears_this_host"), true);
    EXPECT_EQ(answer.lost("from_it"), 0);
    EXPECT_EQ(answer.lost("to_it"), 0);
    EXPECT_GT(answer.lost("to_it", "probes"), 100);
    EXPECT_EQ(answer.peer("duplicates"), 0);
    EXPECT_GT(answer.peer("round_trip_ms")["p50"], 0.0);
  }
}

TEST_F(DoctorOnHosts, AOneWayPartitionIsSeenByTheSideThatHears) {
  on_the_way_to_2("drop");
  const auto [one, two] = both();
  EXPECT_EQ(one.exit_code, 1);
  EXPECT_EQ(one.peer("hears_this_host"), false);
  EXPECT_NE(one.of("peer host2")["found"].dump().find("one-way"), std::string::npos);
  EXPECT_EQ(two.exit_code, 1);
  EXPECT_EQ(two.told["peers"].size(), 0u);
  EXPECT_EQ(two.of("peers")["level"], "problem");
}

TEST_F(DoctorOnHosts, LossIsMeasuredInItsDirection) {
  on_the_way_to_2("numgen inc mod 10 0 drop");
  const auto [one, two] = both();
  EXPECT_EQ(one.exit_code, 1);
  EXPECT_EQ(one.of("peer host2")["level"], "warning");
  EXPECT_EQ(one.lost("from_it"), 0);
  EXPECT_EQ(two.lost("to_it"), 0);
  for (const double lost : {one.lost("to_it"), two.lost("from_it")}) {
    EXPECT_GT(lost, 5);
    EXPECT_LT(lost, 15);
  }
}

TEST_F(DoctorOnHosts, ANarrowSwitchLosesOnlyWhatIsLong) {
  ASSERT_EQ(hosts_->on_switch("ip link set p1 mtu 1000 && ip link set p2 mtu 1000"), 0);
  const auto [one, two] = both();
  for (const Answer& answer : {one, two}) {
    EXPECT_EQ(answer.exit_code, 1);
    EXPECT_EQ(answer.lost("from_it", "lost_small_percent"), 0) << answer.told.dump(1);
    EXPECT_EQ(answer.lost("from_it", "lost_large_percent"), 100);
  }
  EXPECT_EQ(one.of("peer host2")["found"], "only short datagrams arrive");
  EXPECT_EQ(one.of("MTU")["level"], "ok");  // of its own interface
}

TEST_F(DoctorOnHosts, AnInterfaceWithASmallMtuIsAWarning) {
  ASSERT_EQ(hosts_->on_host(1, "ip link set eth0 mtu 1000"), 0);
  const Answer answer = alone(1, 1);
  EXPECT_EQ(answer.exit_code, 1);
  EXPECT_EQ(answer.of("MTU")["level"], "warning");
  ASSERT_EQ(hosts_->on_host(1, answer.of("MTU")["remedy"]), 0);
  EXPECT_EQ(alone(1, 1).exit_code, 0);
}

TEST_F(DoctorOnHosts, TheWrongOneOfTwoInterfacesIsMendedByTheCommandGiven) {
  ASSERT_EQ(
      hosts_->on_host(1,
                      "ip link add eth1 type veth peer name far && ip link set far up && ip addr "
                      "add 10.8.0.1/24 dev eth1 && "
                      "ip link set eth1 up multicast on && ip route replace 224.0.0.0/4 dev eth1"),
      0);
  const auto [wrong, deaf] = both();
  EXPECT_EQ(wrong.exit_code, 1);
  EXPECT_EQ(wrong.told["peers"].size(), 0u);
  EXPECT_EQ(deaf.told["peers"].size(), 0u);
  EXPECT_EQ(wrong.of("route")["found"],
            "239.255.76.67 goes over eth1 (10.8.0.1), and not over eth0");
  ASSERT_EQ(hosts_->on_host(1, wrong.of("route")["remedy"]), 0);
  const auto [right, hearing] = both();
  EXPECT_EQ(right.exit_code, 0) << right.told.dump(1);
  EXPECT_EQ(hearing.exit_code, 0) << hearing.told.dump(1);
}

TEST_F(DoctorOnHosts, LoopbackIsAProblemForATeamOnSeveralHosts) {
  ASSERT_EQ(hosts_->on_host(1, "ip route replace 224.0.0.0/4 dev lo"), 0);
  const Answer answer = alone(1, 1);
  EXPECT_EQ(answer.exit_code, 1);
  EXPECT_EQ(answer.of("route")["remedy"], "ip route replace 224.0.0.0/4 dev eth0");
  EXPECT_EQ(alone(1, 0).exit_code, 0);
}

TEST_F(DoctorOnHosts, ATtlOfZeroOnOneSideIsOneWay) {
  const auto [one, two] = both(/*ttl_of_1=*/0);
  EXPECT_EQ(one.of("TTL")["level"], "problem");
  EXPECT_EQ(one.peer("hears_this_host"), false);
  EXPECT_EQ(two.told["peers"].size(), 0u);
}

TEST_F(DoctorOnHosts, AFirewallIsOpenedByTheCommandsGiven) {
  ASSERT_EQ(hosts_->on_host(1,
                            "nft add table inet wall && nft add chain inet wall in "
                            "\\{ type filter hook input priority 0\\; policy drop\\; \\}"),
            0);
  const Answer answer = alone(1, 1);
  EXPECT_EQ(answer.exit_code, 3);
  EXPECT_EQ(answer.of("self test")["level"], "problem");
  ASSERT_EQ(hosts_->on_host(1, answer.of("firewall")["remedy"]), 0);
  EXPECT_EQ(alone(1, 1).exit_code, 0);
}

TEST_F(DoctorOnHosts, ACableThatIsPulledIsNamed) {
  ASSERT_EQ(hosts_->on_switch("ip link set p1 down"), 0);
  const Answer answer = alone(1, 1);
  EXPECT_EQ(answer.exit_code, 1);
  EXPECT_EQ(answer.of("interface")["found"], "eth0 has no carrier");
}

}  // namespace
}  // namespace ergocast::doctor
