// SPDX-License-Identifier: BSD-3-Clause
// Hosts that fail permanently: their processes continue elsewhere.
#include "tests/hosts/team_on_hosts.h"

namespace ergocast::test {
namespace {

using Takeover = TeamOnHosts;

TEST_F(Takeover, ACoordinatorOnAnotherHostTakesTheMissionOver) {
  const auto file = mission("20");
  hold_next("ERGOCAST_COMMAND_3", kHeldTick);
  start(file);
  hold_none();
  ASSERT_TRUE(eventually([this] { return stopped({agents_[3]->child.pid()}); }))
      << coordinator_->printed();
  coordinator_->child.send(SIGKILL);
  wait_for(coordinator_->child);
  coordinator_ = &on(2, "ergocast-coordinator", {"--resume"});
  ASSERT_TRUE(coordinator_->prints("taken over")) << coordinator_->printed();
  agents_[3]->child.send(SIGCONT);
  expect_all_to_end();
  expect_complete_record();
  EXPECT_EQ(summary()["reason"], "mission complete");
  expect_simulated(file);
}

TEST_F(Takeover, AWorldOnAnotherHostGoesOnWhereTheAgentsWere) {
  start(mission(kEndless));
  ASSERT_TRUE(recorded(30000)) << coordinator_->printed();
  world_->child.send(SIGKILL);
  wait_for(world_->child);
  world_ = &on(0, "ergocast-sim");
  ASSERT_TRUE(world_->prints("moving from tick")) << world_->printed();
  // States that only the killed world had may be missing in the record.
  expect_all_to_go_on_and_end_when_told();
}

TEST_F(Takeover, TheSuccessorsOfALostHostsAgentsGetBackWhatThoseHadCovered) {
  start(mission(kEndless, kRealtime));
  BusObserver observer = witness_on(1);
  const auto knows = [&](AgentId who, const Author& whose) {
    return observer.held(observer.member(who), whose) >=
           std::max<std::int64_t>(1, observer.steps_sent(whose));
  };
  ASSERT_TRUE(observer.observes([&] {
    return knows(0, observer.member(2)) && knows(0, observer.member(3));
  })) << coordinator_->printed();

  const Author former[] = {observer.member(2), observer.member(3)};
  lan_->unplug(2);
  for (const std::size_t id : {2U, 3U}) {
    agents_[id]->child.send(SIGKILL);
    wait_for(agents_[id]->child);
  }
  agents_ = {agents_[0], agents_[1], &agent_on(0, 2), &agent_on(1, 3)};
  ASSERT_TRUE(observer.observes([&] {
    const Author two = observer.member(2), three = observer.member(3);
    return two != former[0] && three != former[1] && observer.steps_sent(two) > 50 &&
           observer.steps_sent(three) > 50;
  })) << coordinator_->printed();
  for (const Author& dead : former) {
    for (const AgentId id : {0, 1, 2, 3}) {
      EXPECT_TRUE(observer.observes([&] { return knows(id, dead); })) << id << " of " << dead.agent;
      EXPECT_EQ(observer.held(observer.member(id), dead), observer.steps_sent(dead))
          << "no more than that";
    }
  }
  end_mission();
  expect_all_to_end();
  EXPECT_EQ(summary()["agents"].size(), 6U);
}

}  // namespace
}  // namespace ergocast::test
