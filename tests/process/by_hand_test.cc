// SPDX-License-Identifier: BSD-3-Clause
// Programs that people start one by one, without `ergocast run`.
#include "tests/process/bus_observer.h"
#include "tests/process/mission.h"

namespace ergocast::test {
namespace {

class StartedByHand : public ByHand {
 protected:
  /// A mission of two agents that is under way.
  Program& begin_mission(const std::filesystem::path& scenario) {
    Program& coordinator = hand_all_but_agents(scenario);
    for (const char* id : {"0", "1"}) hand("ergocast-agent", {"--id", id});
    EXPECT_TRUE(recorded(20000)) << coordinator.said();
    return coordinator;
  }
  /// A scenario of two agents that lasts as long as the test needs.
  std::filesystem::path endless_pair() {
    std::string text = text_of(scenario(std::string("duration_s: ") + kEndless));
    for (const char* start :
         {"starts { x_m: 0     y_m: 2000 }", "starts { x_m: 2000  y_m: 2000 }"}) {
      text.erase(text.find(start), std::string(start).size());
    }
    const auto file = folder_ / "pair.textproto";
    std::ofstream(file) << text;
    return file;
  }
};

TEST_F(StartedByHand, AnAgentThatIsToldToLeaveIsReportedAndNotWaitedFor) {
  Program& coordinator = begin_mission(endless_pair());
  BusObserver observer(kUrl);
  ASSERT_TRUE(observer.hears([&] { return observer.answered(observer.member(0)) > 0; }));
  const Author left = observer.member(1);
  signal_to(agent(1), SIGTERM);
  ASSERT_TRUE(observer.hears([&] {
    const RosterEntry* entry = observer.entry(left);
    return entry != nullptr && entry->active_until >= 0;
  })) << coordinator.said();
  const Tick tick = observer.entry(left)->active_until;
  EXPECT_TRUE(observer.hears([&] { return observer.answered(observer.member(0)) > tick + 100; }));
  EXPECT_TRUE(coordinator.says("agent 1 (" + to_hex(left.incarnation) + ") is gone at tick"))
      << coordinator.said();
}

TEST_F(StartedByHand, ASecondCoordinatorLeavesTheMissionToTheFirst) {
  const auto file = endless_pair();
  Program& first = begin_mission(file);
  Program& second = hand("ergocast-coordinator", {file});
  EXPECT_EQ(wait_for(second.child), 4) << second.said();
  EXPECT_TRUE(second.says("is led by the coordinator on ")) << second.said();
  EXPECT_TRUE(second.says("take the mission over with --resume")) << second.said();
  EXPECT_TRUE(moves_on()) << first.said();
  EXPECT_TRUE(first.child.running()) << first.said();
}

TEST_F(StartedByHand, ASecondCoordinatorLeavesALeaderAloneThatHasNoAgentsYet) {
  const auto file = endless_pair();
  Program& first = hand("ergocast-coordinator", {file});
  ASSERT_TRUE(first.says("quorum of 2 agents")) << first.said();
  Program& second = hand("ergocast-coordinator", {file});
  EXPECT_EQ(wait_for(second.child), 4) << second.said();
  EXPECT_TRUE(second.says("is led by the coordinator on ")) << second.said();
}

TEST_F(StartedByHand, ASecondCoordinatorTakesTheMissionOverWhenItIsToldTo) {
  const auto file = endless_pair();
  Program& first = begin_mission(file);
  Program& second = hand("ergocast-coordinator", {file, "--resume"});
  ASSERT_TRUE(second.says("taken over")) << second.said();
  EXPECT_EQ(wait_for(first.child), 4) << first.said();
  EXPECT_TRUE(first.says("another coordinator has taken the mission over")) << first.said();
  EXPECT_TRUE(moves_on()) << second.said();
}

TEST_F(StartedByHand, ACoordinatorTakesTheMissionOfALauncherOver) {
  Child mission = launch_held(scenario("duration_s: 20"), {"--lcm-url", kUrl});
  hand("ergocast-coordinator", {"--resume"});
  ASSERT_TRUE(eventually([this] { return said("the team goes on to the plan's last tick"); }))
      << said();
  release();
  EXPECT_EQ(wait_for(mission), 0) << said();
  EXPECT_TRUE(said("another coordinator has taken the mission over")) << said();
  EXPECT_EQ(summary()["reason"], "mission complete; coordinator exited with code 4");
  EXPECT_EQ(ergocast({"verify", out()}), 0) << output();
}

TEST_F(StartedByHand, ACoordinatorOfAnotherScenarioIsRefusedAndDisturbsNobody) {
  begin_mission(endless_pair());
  Program& other = hand("ergocast-coordinator", {scenario_file("paper_fig2b")});
  EXPECT_EQ(wait_for(other.child), 4) << other.said();
  EXPECT_TRUE(other.says("is flying on this URL: choose another URL")) << other.said();
  EXPECT_TRUE(moves_on());
}

// As when an adapter is unplugged, or a container is disconnected from its network: memberships in
// the group end with the interface.
TEST_F(StartedByHand, AMissionGoesOnOnAnotherNetworkInterface) {
  const auto plug_in = [] {
    return std::system(
        "ip link add wire type veth peer name end && ip addr add 10.1.1.1/24 dev wire && "
        "ip link set end up && ip link set wire up && "
        "ip route replace 224.0.0.0/4 dev wire");
  };
  ASSERT_EQ(plug_in(), 0);
  Program& coordinator = begin_mission(endless_pair());
  for (int i = 0; i < 2; ++i) {
    ASSERT_EQ(std::system("ip link delete wire"), 0);
    ASSERT_EQ(plug_in(), 0);
    EXPECT_TRUE(moves_on()) << coordinator.said();
  }
  EXPECT_TRUE(coordinator.says("listening on another network interface")) << coordinator.said();
}

TEST_F(StartedByHand, ACoordinatorThatFindsNothingToTakeOverCanBeStopped) {
  Program& coordinator = hand("ergocast-coordinator", {"--resume"});
  ASSERT_TRUE(coordinator.says("looking for a mission")) << coordinator.said();
  coordinator.child.send(SIGTERM);
  EXPECT_EQ(wait_for(coordinator.child), 0) << coordinator.said();
}

}  // namespace
}  // namespace ergocast::test
