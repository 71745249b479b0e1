// SPDX-License-Identifier: BSD-3-Clause
// A host whose multicast uses another network or none: its agent is reported missing, by its
// number.
#include "tests/hosts/team_on_hosts.h"

namespace ergocast::test {
namespace {

class WrongNetwork : public TeamOnHosts {
 protected:
  /// Starts a team whose agent 2 is alone on host 2 and is given `url`.
  void start_team(const std::string& time, std::string url) {
    for (const AgentId id : {0, 1, 3}) agents_.push_back(&agent_on(id % 2, id));
    std::swap(url_, url);
    agents_.push_back(&agent_on(2, 2));
    std::swap(url_, url);
    for (Program* agent : agents_) EXPECT_TRUE(agent->prints("joining on")) << agent->printed();
    start_all_but_agents(mission("20", time));
  }
  void expect_agent_2_to_be_missing() {
    EXPECT_EQ(wait_for(coordinator_->child), 4) << coordinator_->printed();
    EXPECT_TRUE(coordinator_->prints("only 3 of the quorum of 4 agents were admitted; missing: 2"))
        << coordinator_->printed();
  }
  void expect_agent_2_to_join_once_mended() {
    start_team("admission_timeout_s: 600", url_);
    ASSERT_TRUE(coordinator_->prints("agent 3")) << coordinator_->printed();
    lan_->route_multicast(2, "eth0");
    EXPECT_TRUE(agents_.back()->prints("listening on another network interface"))
        << agents_.back()->printed();
    expect_all_to_end();
    expect_complete_record();
  }
};

TEST_F(WrongNetwork, AnAgentWhoseMulticastRouteLeadsElsewhereIsMissed) {
  lan_->add_interface(2);
  lan_->route_multicast(2, "eth1");
  start_team("admission_timeout_s: 10", url_);
  expect_agent_2_to_be_missing();
}

TEST_F(WrongNetwork, AnAgentJoinsOnceTheRouteIsMended) {
  lan_->add_interface(2);
  lan_->route_multicast(2, "eth1");
  expect_agent_2_to_join_once_mended();
}

TEST_F(WrongNetwork, AnAgentWhoseMulticastStayedOnItsHostJoinsOnceTheRouteIsMended) {
  lan_->route_multicast(2, "lo");
  expect_agent_2_to_join_once_mended();
}

TEST_F(WrongNetwork, AnAgentWithATtlOfZeroIsMissed) {
  start_team("admission_timeout_s: 10", kUrl);
  expect_agent_2_to_be_missing();
}

TEST_F(WrongNetwork, AnAgentWithoutAMulticastRouteReportsWhatIsWrong) {
  lan_->route_multicast(2, "");
  Program& agent = agent_on(2, 0);
  EXPECT_EQ(wait_for(agent.child), 3) << agent.printed();
  EXPECT_TRUE(agent.prints("ip route add 224.0.0.0/4")) << agent.printed();
}

TEST_F(WrongNetwork, AnAgentWhoseFirewallDropsOneBusReportsWhich) {
  const LcmUrl url = LcmUrl::parse(url_).value();
  {
    const auto there = lan_->visit(2);
    const std::string drop =
        "nft 'add table inet wall; add chain inet wall in { type filter hook input priority 0; }; "
        "add rule inet wall in udp dport " +
        std::to_string(url.base_port + 1) + " drop'";
    ASSERT_EQ(std::system(drop.c_str()), 0);
  }
  Program& agent = agent_on(2, 0);
  EXPECT_EQ(wait_for(agent.child), 3) << agent.printed();
  EXPECT_TRUE(agent.prints(url.of(Bus::kWorld) + ": LCM's self test failed")) << agent.printed();
  EXPECT_TRUE(agent.prints("nft list ruleset")) << agent.printed();
}

}  // namespace
}  // namespace ergocast::test
