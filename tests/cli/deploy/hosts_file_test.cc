// SPDX-License-Identifier: BSD-3-Clause
// The hosts file of `ergocast deploy`: its content, and every possible error.
#include <gtest/gtest.h>

#include <algorithm>

#include "cli/deploy/deploy.h"

namespace ergocast {
namespace {

std::vector<DeployHost> hosts_in(const std::string& text) {
  auto read = parse_hosts(text, "hosts");
  if (read) return *std::move(read);
  for (const Problem& problem : read.error()) ADD_FAILURE() << to_string(problem);
  return {};
}

std::string joined(const std::vector<Problem>& problems) {
  std::string text;
  for (const Problem& problem : problems) text += to_string(problem) + '\n';
  return text;
}

std::string problems_in(const std::string& text) {
  const auto read = parse_hosts(text, "hosts");
  return read ? "" : joined(read.error());
}

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(HostsFile, AssignsTheRoles) {
  const auto hosts = hosts_in(
      "# our team\n"
      "ground  ops@10.0.0.1  coordinator logger sim\r\n"
      "\n"
      "rover1\tpi@rover-1.local agent 4 1 # two\n"
      "rover2 agents=2 driver\n"
      "rover3 10.0.0.13 agents=1 agent 0");
  ASSERT_EQ(hosts.size(), 4U);
  EXPECT_EQ(hosts[0].name, "ground");
  EXPECT_EQ(hosts[0].address, "ops@10.0.0.1");
  EXPECT_TRUE(hosts[0].coordinator && hosts[0].logger && hosts[0].sim && !hosts[0].driver);
  EXPECT_TRUE(hosts[0].agents.empty());
  EXPECT_EQ(hosts[1].address, "pi@rover-1.local");
  EXPECT_EQ(hosts[1].agents, (std::vector{1, 4}));
  EXPECT_EQ(hosts[2].address, "rover2");
  EXPECT_TRUE(hosts[2].driver && !hosts[2].sim);
  EXPECT_EQ(hosts[3].address, "10.0.0.13");
}

TEST(HostsFile, NamesHubsAndTheRelaysOfSites) {
  const auto hosts = hosts_in(
      "server hub=hub.example.org:7700\n"
      "ground ops@10.0.0.1 relay coordinator\n"
      "rover relay=1000 agent 0\n"
      "second 10.0.0.9 hub=[2001:db8::1]:7701 relay\n"
      "alone agent 1\n");
  ASSERT_EQ(hosts.size(), 5U);
  const std::vector<std::string> hubs{"hub.example.org:7700", "[2001:db8::1]:7701"};
  EXPECT_EQ(hosts[0].address, "server");
  EXPECT_EQ(hosts[0].hub, hubs[0]);
  EXPECT_FALSE(hosts[0].relay);
  EXPECT_TRUE(hosts[1].relay && hosts[1].coordinator);
  EXPECT_EQ(hosts[1].relay_kbit_per_s, 0);
  EXPECT_TRUE(hosts[2].relay);
  EXPECT_EQ(hosts[2].relay_kbit_per_s, 1000);
  EXPECT_EQ(hosts[3].hub, hubs[1]);
  const auto relay_of = [&](std::size_t host) {
    std::string words;
    for (const DeployProcess& process : processes_of(hosts[host])) {
      if (process.name != kRelayProcess) continue;
      for (const std::string& word : process.command) words += ' ' + word;
    }
    return words;
  };
  EXPECT_EQ(relay_of(0), " ergocast-relay --hub --listen :7700");
  EXPECT_EQ(relay_of(1), " ergocast-relay --to hub.example.org:7700 [2001:db8::1]:7701");
  EXPECT_EQ(relay_of(2),
            " ergocast-relay --to hub.example.org:7700 [2001:db8::1]:7701 --max-rate 1000");
  EXPECT_EQ(relay_of(3), " ergocast-relay --listen :7701") << "it is a site itself";
  EXPECT_EQ(relay_of(4), "");
  EXPECT_EQ(roles_of(hosts[3]), "hub [2001:db8::1]:7701, relay");
}

TEST(HostsFile, CountedAgentsGetTheNumbersThatAreFreeInItsOrder) {
  const auto hosts = hosts_in("a agents=2\nb agent 0 2\nc agents=1 agent 7\nd agents=1");
  ASSERT_EQ(hosts.size(), 4U);
  EXPECT_EQ(hosts[0].agents, (std::vector{1, 3}));
  EXPECT_EQ(hosts[1].agents, (std::vector{0, 2}));
  EXPECT_EQ(hosts[2].agents, (std::vector{4, 7}));
  EXPECT_EQ(hosts[3].agents, (std::vector{5}));
}

TEST(HostsFile, AllItsProblemsAreNamedAtOnceWithLineColumnAndRemedy) {
  const std::string printed = problems_in(
      "ground coordinator pilot\n"
      "ground sim\n"
      "-oProxyCommand=x agent 0\n"
      "rover pi@host;reboot agent 1024\n"
      "other agent\n"
      "third agent 0 0 agents=0 agents=x\n"
      "fourth\n"
      "fifth pi agent 3\n"
      "sixth relay=7 hub=here\n");
  for (const char* part :
       {"hosts:1:20: \"pilot\" is no role (write coordinator, logger",
        "hosts:2:1: \"ground\" is already in line 1",
        "hosts:3:1: \"-oProxyCommand=x\" is no host name",
        "hosts:4:7: \"pi@host;reboot\" is no address",
        "hosts:4:28: agent 1024 cannot be (number agents from 0 to 1023)",
        "hosts:5:7: \"agent\" without a number", "hosts:6:15: agent 0 is named twice",
        "hosts:6:17: \"agents=0\" has no count", "hosts:6:26: \"agents=x\" has no count",
        "hosts:7:1: \"fourth\" has no role", "hosts:8:7: \"pi\" is no role",
        "hosts:9:7: \"relay=7\" has no rate from 8 to 10000000 kbit/s (write relay=1000",
        "hosts:9:15: \"here\" is no place where sites can join (write hub=HOST:PORT",
        "an address has an @ or a dot"}) {
    EXPECT_TRUE(has(printed, part)) << part << " in\n" << printed;
  }
}

TEST(HostsFile, NothingThatAShellOrSshWouldReadIsAnAddress) {
  for (const char* address :
       {"-oProxyCommand=a.b", "pi@-a.b", "@a.b", "pi@", "a.b;c", "$(a.b)", "`a.b`", "a.b|c",
        "a@b@c", "a.b'c", "a.b\"", "a/b.c", "a.b:c", "p\xC3\xA9@b", "a@b.c\\"}) {
    EXPECT_TRUE(has(problems_in("host " + std::string(address) + " sim"), "is no address"))
        << address;
  }
}

TEST(HostsFile, NothingThatAShellWouldReadIsAHub) {
  for (const char* hub :
       {"", "h", ":7700", "h:", "h:0", "h:65536", "h:x", "-h:1", "h;x:1", "$(h):1", "h i:1", "[]:1",
        "[::1;x]:1", "[h]:1", "2001:db8::1:7700", "h:1:2", "h*:1", "h/i:1"}) {
    EXPECT_TRUE(has(problems_in("host hub=" + std::string(hub)), "where sites can join")) << hub;
  }
}

TEST(HostsFile, IsNotEmptyAndNotEndless) {
  EXPECT_TRUE(has(problems_in("# nobody\n"), "hosts: names no host (write one host a line"));
  EXPECT_TRUE(has(problems_in("a agents=1000\nb agents=25"), "more agents than 1024"));
  EXPECT_EQ(problems_in("a agents=100\nb agents=28"), "");
}

std::string lacks(const std::string& text, const std::string& url = "udpm://239.1.2.3:7000?ttl=1",
                  const std::string& keys = "") {
  DeployMission mission;
  mission.name = "mission";
  mission.quorum = 2;
  mission.keys = keys;
  mission.url = LcmUrl::parse(url).value();
  const auto hosts = hosts_in(text);
  return joined(problems_of(hosts, mission, "hosts", hosts.size() > 1));
}

TEST(Deployment, NeedsOneOfEachAndAQuorum) {
  EXPECT_EQ(lacks("a coordinator sim logger\nb agents=2"), "");
  EXPECT_EQ(lacks("a coordinator driver agent 0\nb driver agent 1"), "");
  EXPECT_TRUE(has(lacks("a sim agents=2"), "no host is the coordinator (give the role"));
  EXPECT_TRUE(has(lacks("a coordinator sim agents=2\nb coordinator"), "several hosts: a, b"));
  EXPECT_TRUE(has(lacks("a coordinator agents=2"), "no host moves the vehicles"));
  EXPECT_TRUE(has(lacks("a coordinator sim agents=2\nb sim"), "sim is the role of several hosts"));
  EXPECT_TRUE(has(lacks("a coordinator sim agents=2\nb driver"), "a simulated world and drivers"));
  EXPECT_TRUE(has(lacks("a coordinator sim logger agents=2\nb logger"), "logger is the role of"));
  EXPECT_TRUE(has(lacks("a coordinator sim agent 5"), "1 agents are fewer than the quorum of 2"));
}

TEST(Deployment, OverRelaysNeedsAHubAndAKey) {
  const std::string url = "udpm://239.1.2.3:7000?ttl=1", keys = "/team";
  const std::string team = "a coordinator sim agents=2", hub = "\nb hub=b:7700";
  EXPECT_EQ(lacks(team + " relay" + hub, url, keys), "");
  EXPECT_TRUE(has(lacks(team + " relay" + hub), "relays carry only messages with the team's key"));
  EXPECT_TRUE(has(lacks(team + " relay", url, keys), "no host is the hub that the relays join"));
  EXPECT_TRUE(has(lacks(team + hub, url, keys), "a hub has no relays (give the role relay"));
}

TEST(Deployment, OfSeveralHostsNeedsMessagesThatReachThem) {
  const std::string url = "udpm://239.1.2.3:7000?ttl=0&recv_buf_size=4096";
  EXPECT_EQ(lacks("a coordinator sim agents=2", url), "");
  EXPECT_TRUE(has(lacks("a coordinator sim\nb agents=2", url),
                  "give 'udpm://239.1.2.3:7000?ttl=1&recv_buf_size=4096'"));
}

}  // namespace
}  // namespace ergocast
