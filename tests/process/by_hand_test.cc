// SPDX-License-Identifier: BSD-3-Clause
// Programs that people start one by one, without `ergocast run`.
#include "tests/process/support/bus_observer.h"
#include "tests/process/support/mission.h"

namespace ergocast::test {
namespace {

class StartedByHand : public ByHand {
 protected:
  /// A mission of two agents that is under way.
  Program& begin_mission(const std::filesystem::path& scenario) {
    Program& coordinator = hand_all_but_agents(scenario);
    for (const char* id : {"0", "1"}) hand("ergocast-agent", {"--id", id});
    EXPECT_TRUE(recorded(20000)) << coordinator.printed();
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

TEST_F(StartedByHand, AnAgentThatASignalStopsIsReportedAndNotWaitedFor) {
  Program& coordinator = begin_mission(endless_pair());
  BusObserver observer(kUrl);
  ASSERT_TRUE(observer.observes([&] { return observer.answered(observer.member(0)) > 0; }));
  const Author left = observer.member(1);
  signal_to(agent(1), SIGTERM);
  ASSERT_TRUE(observer.observes([&] {
    const RosterEntry* entry = observer.entry(left);
    return entry != nullptr && entry->active_until >= 0;
  })) << coordinator.printed();
  const Tick tick = observer.entry(left)->active_until;
  EXPECT_TRUE(
      observer.observes([&] { return observer.answered(observer.member(0)) > tick + 100; }));
  EXPECT_TRUE(coordinator.prints("agent 1 (" + to_hex(left.incarnation) + ") is gone at tick"))
      << coordinator.printed();
}

TEST_F(StartedByHand, ASecondCoordinatorLeavesTheMissionToTheFirst) {
  const auto file = endless_pair();
  Program& first = begin_mission(file);
  Program& second = hand("ergocast-coordinator", {file});
  EXPECT_EQ(wait_for(second.child), 4) << second.printed();
  EXPECT_TRUE(second.prints("is led by the coordinator on ")) << second.printed();
  EXPECT_TRUE(second.prints("take the mission over with --resume")) << second.printed();
  EXPECT_TRUE(moves_on()) << first.printed();
  EXPECT_TRUE(first.child.running()) << first.printed();
}

TEST_F(StartedByHand, ASecondCoordinatorLeavesALeaderAloneThatHasNoAgentsYet) {
  const auto file = endless_pair();
  Program& first = hand("ergocast-coordinator", {file});
  ASSERT_TRUE(first.prints("quorum of 2 agents")) << first.printed();
  Program& second = hand("ergocast-coordinator", {file});
  EXPECT_EQ(wait_for(second.child), 4) << second.printed();
  EXPECT_TRUE(second.prints("is led by the coordinator on ")) << second.printed();
}

TEST_F(StartedByHand, ASecondCoordinatorTakesTheMissionOverWithResume) {
  const auto file = endless_pair();
  Program& first = begin_mission(file);
  Program& second = hand("ergocast-coordinator", {file, "--resume"});
  ASSERT_TRUE(second.prints("taken over")) << second.printed();
  EXPECT_EQ(wait_for(first.child), 4) << first.printed();
  EXPECT_TRUE(first.prints("another coordinator has taken the mission over")) << first.printed();
  EXPECT_TRUE(moves_on()) << second.printed();
}

TEST_F(StartedByHand, ACoordinatorTakesTheMissionOfALauncherOver) {
  Child mission = launch_held(scenario("duration_s: 20"), {"--lcm-url", kUrl});
  hand("ergocast-coordinator", {"--resume"});
  ASSERT_TRUE(eventually([this] { return printed("the team goes on to the plan's last tick"); }))
      << printed();
  release();
  EXPECT_EQ(wait_for(mission), 0) << printed();
  EXPECT_TRUE(printed("another coordinator has taken the mission over")) << printed();
  EXPECT_EQ(summary()["reason"], "mission complete; coordinator exited with code 4");
  EXPECT_EQ(ergocast({"verify", out()}), 0) << output();
}

TEST_F(StartedByHand, ACoordinatorOfAnotherScenarioIsRefusedAndDisturbsNoTeam) {
  begin_mission(endless_pair());
  Program& other = hand("ergocast-coordinator", {scenario_file("paper_fig2b")});
  EXPECT_EQ(wait_for(other.child), 4) << other.printed();
  EXPECT_TRUE(other.prints("is running on this URL: choose another URL")) << other.printed();
  EXPECT_TRUE(moves_on());
}

// As if an adapter is unplugged, or a container is disconnected from its network: memberships in
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
    EXPECT_TRUE(moves_on()) << coordinator.printed();
  }
  EXPECT_TRUE(coordinator.prints("listening on another network interface"))
      << coordinator.printed();
}

TEST_F(StartedByHand, ACoordinatorThatFindsNothingToTakeOverCanBeStopped) {
  Program& coordinator = hand("ergocast-coordinator", {"--resume"});
  ASSERT_TRUE(coordinator.prints("looking for a mission")) << coordinator.printed();
  coordinator.child.send(SIGTERM);
  EXPECT_EQ(wait_for(coordinator.child), 0) << coordinator.printed();
}

}  // namespace
}  // namespace ergocast::test
