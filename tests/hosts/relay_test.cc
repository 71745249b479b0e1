// SPDX-License-Identifier: BSD-3-Clause
// A team at two sites, each behind a router that translates addresses, with a hub between them. No
// multicast passes from one site to the other.
#include <filesystem>
#include <string>
#include <vector>

#include "runtime/process/key_file.h"
#include "tests/hosts/team_on_hosts.h"
#include "tests/process/support/stranger.h"

namespace ergocast::test {
namespace {

/// The hub's server is host 0 of the network between the routers, hosts 1 and 2. Both sites have
/// the same private addresses.
class RelaysOnHosts : public OnHosts {
 protected:
  void SetUp() override {
    OnHosts::SetUp();
    if (IsSkipped() || HasFatalFailure()) return;
    url_ = kUrl;
    lan_->on_switch(
        "nft 'table bridge internet { chain forward { type filter hook forward priority 5; "
        "ether type ip meta pkttype multicast drop; }; }'");
    for (int site : {0, 1}) {
      sites_.push_back(Namespaces::make("site-" + std::to_string(site)));
      const int router = 1 + site;
      lan_->on_host(router, "ip link add lan type veth peer name eth0 netns " +
                                sites_.back().path() +
                                " && ip addr add 192.168.7.1/24 dev lan && ip link set lan up && "
                                "echo 1 >/proc/sys/net/ipv4/ip_forward");
      lan_->on_host(router,
                    "nft 'table ip nat { chain post { type nat hook postrouting priority 100; "
                    "oifname eth0 masquerade; }; }'");
      on_site(site,
              "ip link set lo up && ip addr add 192.168.7.2/24 dev eth0 && ip link set eth0 up && "
              "ip route add default via 192.168.7.1 && ip route add 224.0.0.0/4 dev lo");
    }
    const MissionKey key = make_mission_key();
    authenticator_ = MessageAuthenticator(key);
    ASSERT_FALSE(write_key_file(key_file(), key_text(key, true)));
    setenv("ERGOCAST_KEY_FILE", key_file().c_str(), 1);
  }
  void TearDown() override {
    unsetenv("ERGOCAST_KEY_FILE");
    OnHosts::TearDown();
  }

  std::string key_file() const { return folder_ / "team.key"; }
  /// Runs `work` on a host of that site.
  template <class Work>
  decltype(auto) at_site(int site, const Work& work) const {
    const Lan::Visit there(sites_[static_cast<std::size_t>(site)], home_);
    return work();
  }
  void on_site(int site, const std::string& command) const {
    at_site(site, [&] { ASSERT_EQ(std::system(command.c_str()), 0) << command; });
  }
  Program& on_site(int site, const std::string& program, std::vector<std::string> arguments) {
    return at_site(site, [&]() -> Program& { return hand(program, std::move(arguments)); });
  }
  Program& start_hub() {
    const auto there = lan_->visit(0);
    return hand("ergocast-relay", {"--hub", "--listen", ":7700"});
  }
  Program& start_relay(int site) {
    return on_site(site, "ergocast-relay", {"--to", "10.0.0.1:7700"});
  }
  BusObserver observer_at(int site) {
    return at_site(site, [&] { return BusObserver(url_, authenticator_); });
  }
  /// Whether the doctor gets that report of a hub, now or later.
  bool reports(const std::string& hub, const std::string& report) {
    return eventually([&] {
      ergocast({"doctor", "--relay", hub});
      return answered(hub + ": " + report);
    });
  }
  /// Whether each agent reports more of every other one than it did.
  static bool all_learn(BusObserver& here, BusObserver& there) {
    const auto held = [&](AgentId holder, AgentId author) {
      return here.held(here.member(holder), here.member(author));
    };
    std::map<std::pair<AgentId, AgentId>, std::int64_t> before;
    for (AgentId holder = 0; holder < 4; ++holder) {
      for (AgentId author = 0; author < 4; ++author)
        before[{holder, author}] = held(holder, author);
    }
    return here.observes([&] {
      there.listen();
      return std::all_of(before.begin(), before.end(), [&](const auto& one) {
        const auto& [pair, steps] = one;
        return pair.first == pair.second || held(pair.first, pair.second) > steps;
      });
    });
  }

  const Namespaces home_ = Namespaces::of_this_thread();
  std::vector<Namespaces> sites_;
  MessageAuthenticator authenticator_;
};

TEST_F(RelaysOnHosts, AMissionAtTwoSitesOutlivesItsHubAndAChangedAddress) {
  Program* hub = &start_hub();
  Program& ground = start_relay(0);
  Program& field = start_relay(1);
  std::filesystem::create_directory(out());
  Program& logger = on_site(0, "ergocast-logger", {"--out", out()});
  Program& world = on_site(0, "ergocast-sim", {});
  Program& coordinator = on_site(
      0, "ergocast-coordinator",
      {scenario("duration_s: " + std::string(kEndless) + " pace: REALTIME realtime_factor: 5")});
  std::vector<Program*> agents;
  for (const int id : {0, 1, 2, 3}) {
    agents.push_back(&on_site(id / 2, "ergocast-agent", {"--id", std::to_string(id)}));
  }
  BusObserver here = observer_at(0), there = observer_at(1);
  ASSERT_TRUE(here.observes([&] { return here.answered(here.member(3)) > 0; }))
      << coordinator.printed() << field.printed();
  ASSERT_TRUE(all_learn(here, there)) << field.printed();

  // Without a hub, the site with the world goes on.
  hub->child.send(SIGKILL);
  ASSERT_TRUE(ground.prints("cut off")) << ground.printed();
  ASSERT_TRUE(field.prints("cut off")) << field.printed();
  const std::int64_t steps = here.steps_sent(here.member(0));
  ASSERT_TRUE(here.observes([&] { return here.steps_sent(here.member(0)) > steps + 50; }));
  hub = &start_hub();
  ASSERT_TRUE(all_learn(here, there)) << field.printed();

  // The field's router gets another address.
  lan_->on_host(2, "ip addr add 10.0.0.33/24 dev eth0 && ip addr del 10.0.0.3/24 dev eth0");
  lan_->on_host(2,
                "ip addr show dev eth0 | grep -q 10.0.0.33 || ip addr add 10.0.0.33/24 dev eth0");
  ASSERT_TRUE(all_learn(here, there)) << field.printed();

  // A forged order from the field's network ends at its relay.
  at_site(1, [&] {
    Stranger stranger(url_);
    Stop stop;
    stop.header.sender = kOperator;
    stop.now = true;
    for (int i = 0; i < 20; ++i) stranger.send(Bus::kSwarm, stop);
  });
  ASSERT_TRUE(all_learn(here, there)) << field.printed();

  // The hub may still count the field's old address.
  EXPECT_TRUE(at_site(1, [&] { return reports("10.0.0.1:7700", "2 sites. "); })) << output();

  coordinator.child.send(SIGINT);
  for (Program* program : {&coordinator, &world, &logger}) {
    EXPECT_EQ(wait_for(program->child), 0) << program->printed();
  }
  for (Program* agent : agents) EXPECT_EQ(wait_for(agent->child), 0) << agent->printed();
  for (Program* relay : {&ground, &field, hub}) {
    relay->child.send(SIGTERM);
    EXPECT_EQ(wait_for(relay->child), 0) << relay->printed();
    EXPECT_TRUE(relay->prints("carried ")) << relay->printed();
  }
  EXPECT_TRUE(field.prints("unkeyed=")) << field.printed();
  EXPECT_TRUE(hub->prints("refused: none")) << hub->printed();
}

TEST_F(RelaysOnHosts, AHubAnswersFromTheAddressThatWasAsked) {
  lan_->on_host(0, "ip addr add 10.0.0.11/24 dev eth0");
  std::vector<std::string> hubs{"10.0.0.1:7700", "10.0.0.11:7700"};
  if (std::filesystem::exists("/proc/net/if_inet6")) {  // not every kernel has IPv6
    lan_->on_host(0, "ip -6 addr add fd00::1/64 dev eth0 nodad");
    lan_->on_host(0, "ip -6 addr add fd00::2/64 dev eth0 nodad");
    lan_->on_host(1, "ip -6 addr add fd00::3/64 dev eth0 nodad");
    hubs.insert(hubs.end(), {"[fd00::1]:7700", "[fd00::2]:7700"});
  }
  start_hub();
  for (const std::string& hub : hubs) {
    const auto there = lan_->visit(1);
    EXPECT_TRUE(reports(hub, "0 sites")) << output();
  }
}

TEST_F(RelaysOnHosts, AHubWhoseNameServerIsLateMayBeStartedAgain) {
  constexpr int kBadArguments = 2, kUnavailable = 3;
  const auto there = lan_->visit(0);
  Program& early = hand("ergocast-relay", {"--hub", "--listen", "hub.invalid:7700"});
  EXPECT_EQ(wait_for(early.child), kUnavailable) << early.printed();
  Program& wrong = hand("ergocast-relay", {"--to", ":7700"});
  EXPECT_EQ(wait_for(wrong.child), kBadArguments) << wrong.printed();
}

}  // namespace
}  // namespace ergocast::test
