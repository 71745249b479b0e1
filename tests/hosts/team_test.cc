// SPDX-License-Identifier: BSD-3-Clause
// A team on three hosts: all processes are found, and the mission runs as on one host.
#include "tests/hosts/team_on_hosts.h"

namespace ergocast::test {
namespace {

/// The hosts that the record's agents ran on.
std::vector<std::string> hosts_of(const nlohmann::json& summary) {
  std::vector<std::string> hosts;
  for (const auto& agent : summary["agents"]) hosts.push_back(agent["host"]);
  std::sort(hosts.begin(), hosts.end());
  return hosts;
}

class Team : public TeamOnHosts {
 protected:
  /// Agents that get a URL and no number.
  void start_with_nameless_agents(const std::filesystem::path& scenario) {
    start_all_but_agents(scenario);
    for (const int host : {0, 1, 2, 2}) agents_.push_back(&on(host, "ergocast-agent"));
  }
};

TEST_F(Team, InLockstepRunsTheMissionAsItIsSimulated) {
  const auto file = mission("200");
  start_with_nameless_agents(file);
  expect_all_to_end();
  expect_complete_record();
  expect_simulated(file);
  EXPECT_EQ(hosts_of(summary()),
            (std::vector<std::string>{"host-0", "host-1", "host-2", "host-2"}));
}

TEST_F(Team, InRealTimeRunsTheMissionToItsEnd) {
  start_with_nameless_agents(mission("50", kRealtime));
  expect_all_to_end();
  EXPECT_EQ(summary()["result"], "done") << summary()["reason"];
  EXPECT_EQ(hosts_of(summary()),
            (std::vector<std::string>{"host-0", "host-1", "host-2", "host-2"}));
}

TEST_F(Team, SendsNoFragmentOverLinksOfTheSmallestMtu) {
  lan_->set_mtu(1280);
  const auto file = mission("100");
  start(file);
  expect_all_to_end();
  expect_complete_record();
  expect_simulated(file);
  EXPECT_GT(lan_->packets(), 1000 * 4) << "the mission went over the switch";
  EXPECT_EQ(lan_->fragments(), 0);
}

TEST_F(Team, IsTheSameWhenEveryFrameIsLate) {
  if (!lan_->delay(std::chrono::milliseconds(10))) GTEST_SKIP() << "this kernel has no netem";
  const auto file = mission("20");
  start(file);
  expect_all_to_end();
  expect_complete_record();
  expect_simulated(file);
}

}  // namespace
}  // namespace ergocast::test
