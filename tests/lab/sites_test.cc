// SPDX-License-Identifier: BSD-3-Clause
// Sites that relays join: what their links do to a message, and which processes they spare.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <memory>
#include <vector>

#include "lab/network.h"

namespace ergocast::lab {
namespace {

/// Eight agents at four sites: 0 and 1 at site 0, with coordinator, world and logger.
class Sites : public ::testing::Test {
 protected:
  static constexpr int kAgents = 8, kNodes = kAgents + 3, kSites = 4;
  static constexpr PacingClock::duration kLatency = std::chrono::microseconds(200);

  Sites() {
    faults_.sites = kSites;
    faults_.link_delay_s = 0.1;
    faults_.link_jitter_s = 0.03;
  }
  /// When a message that is sent at `sent` reaches each of the other nodes.
  static std::map<NodeId, Instant> arrivals(Network& network, NodeId from, Instant sent,
                                            Bus bus = Bus::kSwarm) {
    NodeSet to;
    for (NodeId node = 0; node < kNodes; ++node) to.set(static_cast<std::size_t>(node));
    to.reset(static_cast<std::size_t>(from));
    network.send(sent, from, to, bus, kUnassigned, std::make_shared<Decoded>(Message(Stop())));
    std::map<NodeId, Instant> all;
    while (network.next() != Instant::max()) {
      const Instant at = network.next();
      const Delivery delivery = network.pop();
      for (NodeId node = 0; node < kNodes; ++node) {
        if (delivery.to.test(static_cast<std::size_t>(node))) {
          EXPECT_TRUE(all.emplace(node, at).second) << "twice at " << node;
        }
      }
    }
    return all;
  }
  Network network() const { return {1, faults_, kAgents, kNodes, kLatency}; }

  Faults faults_;
};

TEST_F(Sites, ShareAgentsEvenlyAndTheFirstHasAllOtherProcesses) {
  std::vector<int> sites;
  for (int node = 0; node < kNodes; ++node) sites.push_back(site_of(node, kAgents, kSites));
  EXPECT_EQ(sites, (std::vector{0, 0, 1, 1, 2, 2, 3, 3, 0, 0, 0}));
  EXPECT_EQ(site_count({}), 1);
  EXPECT_EQ(site_of(7, 8, 1), 0);
}

TEST_F(Sites, DelayEachMessageByTheLinkAndForAWholeSiteAlike) {
  Network network = this->network();
  std::vector<double> late_s;
  for (int i = 0; i < 1000; ++i) {
    const Instant sent(seconds(i));
    const auto all = arrivals(network, 0, sent);
    ASSERT_EQ(all.size(), kNodes - 1U);
    for (const NodeId near : {1, 8, 9, 10}) EXPECT_EQ(all.at(near), sent + kLatency);
    for (const NodeId far : {2, 4, 6}) {
      EXPECT_EQ(all.at(far), all.at(far + 1));
      late_s.push_back(std::chrono::duration<double>(all.at(far) - sent - kLatency).count());
    }
  }
  const auto [least, most] = std::minmax_element(late_s.begin(), late_s.end());
  EXPECT_GE(*least, 0.07);
  EXPECT_LT(*least, 0.072);
  EXPECT_LE(*most, 0.13);
  EXPECT_GT(*most, 0.128);
}

TEST_F(Sites, LoseAMessageForAllProcessesOfASiteOrForNone) {
  faults_.link_loss = 0.25;
  Network network = this->network();
  int lost = 0;
  for (int i = 0; i < 1000; ++i) {
    const auto all = arrivals(network, 3, Instant(seconds(i)));
    EXPECT_TRUE(all.contains(2));
    EXPECT_EQ(all.contains(0), all.contains(9));
    for (const NodeId far : {4, 6}) EXPECT_EQ(all.contains(far), all.contains(far + 1));
    lost += all.contains(4) ? 0 : 1;
  }
  EXPECT_NEAR(lost, 250, 60);
  EXPECT_GT(network.counted().lost, 0);
}

TEST_F(Sites, AreCutOffInBothDirectionsUntilTheyAreJoined) {
  Network network = this->network();
  network.cut_site(2);
  EXPECT_EQ(arrivals(network, 0, Instant(seconds(1))).size(), kNodes - 3U);
  EXPECT_EQ(arrivals(network, 4, Instant(seconds(2))).size(), 1U);
  EXPECT_EQ(arrivals(network, 6, Instant(seconds(3))).size(), kNodes - 3U);
  EXPECT_EQ(network.counted().cut, 2 + 9 + 2);
  network.join_site();
  EXPECT_EQ(arrivals(network, 4, Instant(seconds(4))).size(), kNodes - 1U);
}

TEST_F(Sites, SpareVehiclesThatHaveTheirOwnDrivers) {
  faults_.link_loss = 1;
  faults_.swarm_bus_only = 1;
  Network network = this->network();
  network.cut_site(1);
  EXPECT_EQ(arrivals(network, 9, Instant(seconds(1)), Bus::kWorld).size(), kNodes - 1U);
  EXPECT_EQ(arrivals(network, 9, Instant(seconds(2)), Bus::kSwarm).size(), 4U);
}

TEST_F(Sites, AreHealedWithAllElse) {
  faults_.link_loss = 1;
  Network network = this->network();
  network.cut_site(1);
  network.heal(Instant(seconds(1)));
  const auto all = arrivals(network, 0, Instant(seconds(2)));
  EXPECT_EQ(all.size(), kNodes - 1U);
  EXPECT_EQ(all.at(2), Instant(seconds(2)) + kLatency);
}

}  // namespace
}  // namespace ergocast::lab
