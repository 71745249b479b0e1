// SPDX-License-Identifier: BSD-3-Clause
// Hosts that are disconnected for a while: in real time all processes continue with their own data,
// and afterwards the team agrees again.
#include "tests/hosts/team_on_hosts.h"

namespace ergocast::test {
namespace {

constexpr Tick kTicksPerSecond = 50;  // of wall time, at kRealtime

class Partition : public TeamOnHosts {
 protected:
  /// Steps of each of the four agents, as `observer` received them.
  using Coverage = std::array<std::int64_t, 4>;
  static Coverage coverage_sent(const BusObserver& observer) {
    Coverage coverage{};
    for (AgentId id = 0; id < 4; ++id) {
      coverage[static_cast<std::size_t>(id)] = observer.steps_sent(observer.member(id));
    }
    return coverage;
  }
  /// Whether `who` reports at least that much coverage of all other agents.
  static bool holds(const BusObserver& observer, AgentId who, const Coverage& coverage) {
    for (AgentId whose = 0; whose < 4; ++whose) {
      const std::int64_t held = observer.held(observer.member(who), observer.member(whose));
      if (held == 0 || held < coverage[static_cast<std::size_t>(whose)]) return false;
    }
    return true;
  }
  static bool all_hold(const BusObserver& observer, const Coverage& coverage) {
    return holds(observer, 0, coverage) && holds(observer, 1, coverage) &&
           holds(observer, 2, coverage) && holds(observer, 3, coverage);
  }
  static bool agree_on(BusObserver& observer, const Coverage& coverage) {
    return observer.observes([&] { return all_hold(observer, coverage); });
  }
  /// The coverage of all agents so far and a little more.
  static Coverage more_than(Coverage coverage, std::int64_t steps) {
    for (std::int64_t& one : coverage) one += steps;
    return coverage;
  }
  void expect_same_members_to_end_in_order() {
    end_mission();
    expect_all_to_end();
    EXPECT_EQ(summary()["agents"].size(), 4U);
    for (const auto& agent : summary()["agents"]) EXPECT_TRUE(agent["active_until"].is_null());
  }
};

struct CutOffHost : Partition, ::testing::WithParamInterface<int> {};
INSTANTIATE_TEST_SUITE_P(Hosts, CutOffHost, ::testing::Values(0, 2), [](const auto& host) {
  return host.param == 0 ? "WithAgents" : "WithAgentsAndTheCoordinator";
});

TEST_P(CutOffHost, HoldsStillFor20SecondsAndThenAllAgentsAgreeAgain) {
  start_all_but_agents(mission(kEndless, kRealtime), GetParam());
  start_agents();
  BusObserver with_world = witness_on(1), cut_off = witness_on(2);
  ASSERT_TRUE(agree_on(with_world, {1, 1, 1, 1})) << coordinator_->printed();
  ASSERT_TRUE(agree_on(cut_off, {1, 1, 1, 1}));

  lan_->unplug(2);
  const Coverage before = coverage_sent(with_world);
  ASSERT_TRUE(eventually([&] {
    with_world.listen();
    cut_off.listen();
    const auto holds_more = [&](AgentId who, AgentId whose) {
      return with_world.held(with_world.member(who), with_world.member(whose)) >=
             before[static_cast<std::size_t>(whose)] + 20 * kTicksPerSecond;
    };
    return holds_more(0, 1) && holds_more(1, 0);
  })) << "agents that receive the world continue";
  const auto stands_still = [&](AgentId id) { return cut_off.stands_still(cut_off.member(id)); };
  EXPECT_TRUE(stands_still(2) && stands_still(3)) << "and the others do not";
  for (const AgentId id : {2, 3}) {
    EXPECT_EQ(cut_off.held(cut_off.member(5 - id), cut_off.member(id)),
              cut_off.steps_sent(cut_off.member(id)))
        << "but each holds all that the other has";
  }
  const Coverage apart = coverage_sent(with_world), theirs = coverage_sent(cut_off);

  lan_->heal();
  const Coverage all{apart[0], apart[1], theirs[2], theirs[3]};
  ASSERT_TRUE(agree_on(with_world, all));
  EXPECT_TRUE(agree_on(with_world, more_than(all, 2 * kTicksPerSecond))) << "and goes on";
  expect_same_members_to_end_in_order();
}

TEST_F(Partition, InAChainOfHostsTheOneBetweenPassesOnWhatTheOthersCover) {
  start(mission(kEndless, kRealtime));
  BusObserver between = witness_on(1);
  ASSERT_TRUE(agree_on(between, {1, 1, 1, 1})) << coordinator_->printed();
  lan_->block(0, 2);
  lan_->block(2, 0);
  EXPECT_TRUE(agree_on(between, more_than(coverage_sent(between), 5 * kTicksPerSecond)));
  lan_->heal();
  EXPECT_TRUE(agree_on(between, more_than(coverage_sent(between), kTicksPerSecond)));
  expect_same_members_to_end_in_order();
}

TEST_F(Partition, AHostThatDoesNotReceiveAnotherGetsItsCoverageFromTheThird) {
  start(mission(kEndless, kRealtime));
  BusObserver between = witness_on(1);
  ASSERT_TRUE(agree_on(between, {1, 1, 1, 1})) << coordinator_->printed();
  lan_->block(0, 2);
  EXPECT_TRUE(agree_on(between, more_than(coverage_sent(between), 5 * kTicksPerSecond)));
  lan_->heal();
  expect_same_members_to_end_in_order();
}

TEST_F(Partition, InLockstepAllWaitForACutOffHostAndNotABitChanges) {
  start(mission(kEndless));
  BusObserver observer = witness_on(1);
  ASSERT_TRUE(recorded(30000)) << coordinator_->printed();
  lan_->unplug(2);
  ASSERT_TRUE(observer.observes([&] {
    return observer.stands_still(observer.member(0)) && observer.stands_still(observer.member(1));
  }));
  lan_->heal();
  expect_all_to_go_on_and_end_when_told();
  EXPECT_EQ(summary()["gaps"], 0);
}

TEST_F(Partition, AnAgentThatIsCutOffWhenTheMissionEndsDoesNotWaitForEver) {
  // The world is stopped during the mission, so that the mission's end comes after the cut.
  hold_next("ERGOCAST_WORLD_STATE", 100);
  start(mission("100", "pace: REALTIME realtime_factor: 20"));
  hold_none();
  for (Program* agent : agents_) ASSERT_TRUE(agent->prints(": running")) << agent->printed();
  ASSERT_TRUE(eventually([this] { return stopped({world_->child.pid()}); })) << world_->printed();
  lan_->unplug(2);
  world_->child.send(SIGCONT);
  for (Program* program : {coordinator_, world_, logger_, agents_[0], agents_[1]}) {
    EXPECT_EQ(wait_for(program->child), 0) << program->printed();
  }
  for (Program* agent : {agents_[2], agents_[3]}) {
    EXPECT_EQ(wait_for(agent->child), 4) << agent->printed();
    EXPECT_TRUE(agent->prints("nothing arrives from the world or the coordinator"))
        << agent->printed();
  }
}

}  // namespace
}  // namespace ergocast::test
