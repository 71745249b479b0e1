// SPDX-License-Identifier: BSD-3-Clause
// Hosts with different versions of Ergocast: no process takes part in a mission that it may
// misunderstand, and both sides report it.
#include "runtime/process/program_options.h"
#include "tests/process/support/bus_observer.h"
#include "tests/process/support/mission.h"
#include "tests/process/support/stranger.h"

namespace ergocast::test {
namespace {

constexpr RunId kTheirRun = 0xabc;

/// The message of a coordinator of version 9.9.9, whose plan begins like ours and goes on
/// differently.
MissionPart their_mission() {
  MissionPart part;
  part.header = {kTheirRun, kCoordinator, 71, 0, 0};
  part.state = MissionState::kRunning;
  for (const int byte :
       {0x0A, 5, int{'9'}, int{'.'}, int{'9'}, int{'.'}, int{'9'}, 0xFF, 0xFF, 1, 2, 3}) {
    part.plan.push_back(std::byte{static_cast<unsigned char>(byte)});
  }
  return part;
}

AgentStatus their_status() {
  AgentStatus status;
  status.header = {kTheirRun, 5, 72, 0, 0};
  status.phase = AgentPhase::kRunning;
  return status;
}

class OtherVersion : public ByHand {
 protected:
  Stranger stranger_{kUrl};
};

TEST_F(OtherVersion, OfACoordinatorEndsAllProcessesWithBothVersionsNamed) {
  std::filesystem::create_directory(out());
  std::vector<Program*> programs{&hand("ergocast-logger", {"--out", out()}), &hand("ergocast-sim"),
                                 &hand("ergocast-agent"),
                                 &hand("ergocast-coordinator", {"--resume"})};
  ASSERT_TRUE(eventually([&] {
    stranger_.send(Bus::kSwarm, their_status());
    for (const Bus bus : {Bus::kSwarm, Bus::kCommand}) stranger_.send(bus, their_mission());
    return std::none_of(programs.begin(), programs.end(),
                        [](Program* p) { return p->child.running(); });
  }));
  for (Program* program : programs) {
    EXPECT_EQ(wait_for(program->child), 4) << program->printed();
    EXPECT_NE(program->printed().find("the mission's plan is of version 9.9.9, this program is " +
                                      version() + ": install the same version on every host"),
              std::string::npos)
        << program->printed();
  }
  EXPECT_FALSE(std::filesystem::exists(out() / "trajectory.csv")) << "no record is begun";
}

TEST_F(OtherVersion, OfAnAgentIsNotAdmittedAndNamedOnce) {
  Program& coordinator = hand("ergocast-coordinator", {scenario(), "--run-id", to_hex(kTheirRun)});
  BusObserver observer(kUrl);
  const Hello theirs{{kTheirRun, kUnassigned, 73, 0, 0}, 2, "old-robot", "9.9.9"};
  const std::string warning = "agent on old-robot runs version 9.9.9, this mission is run with " +
                              version() + ": install " + version() + " there";
  ASSERT_TRUE(eventually([&] {
    stranger_.send(Bus::kSwarm, theirs);
    return coordinator.printed().find(warning) != std::string::npos;
  })) << coordinator.printed();
  // A valid agent of our version gets the number that the other agent has asked for.
  hand("ergocast-agent", {"--id", "2"});
  ASSERT_TRUE(observer.observes([&] {
    stranger_.send(Bus::kSwarm, theirs);
    return observer.member(2).incarnation != 0;
  })) << coordinator.printed();
  EXPECT_EQ(observer.entry({2, 73}), nullptr);
  const std::string printed = coordinator.printed();
  EXPECT_EQ(printed.find(warning), printed.rfind(warning)) << "once";
}

TEST_F(OtherVersion, OfAnAgentIsTroubleInStatusWhichNamesTheHostToUpdate) {
  hand("ergocast-coordinator", {scenario(), "--run-id", to_hex(kTheirRun)});
  const Hello theirs{{kTheirRun, kUnassigned, 73, 0, 0}, 2, "new-robot", "99.0"};
  Program& status = hand("ergocast", {"status", "--watch"});
  const std::string told =
      "an agent on new-robot cannot join: it has version 99.0 and this host has " + version() +
      "; update this host to 99.0";
  ASSERT_TRUE(eventually([&] {
    stranger_.send(Bus::kSwarm, theirs);
    return status.printed().find(told) != std::string::npos;
  })) << status.printed();
}

TEST_F(OtherVersion, OfAMessagesLayoutIsNamedWithItsChannelByAnAgentThatWaits) {
  Program& agent = hand("ergocast-agent");
  const std::string warning = "ERGOCAST_MISSION arrives in a format that version " + version() +
                              " does not know: another version of Ergocast is on this URL";
  ASSERT_TRUE(eventually([&] {
    stranger_.send(Bus::kSwarm, "ERGOCAST_MISSION", std::vector<std::byte>(300, std::byte{0xAB}));
    return agent.printed().find(warning) != std::string::npos;
  })) << agent.printed();
  EXPECT_TRUE(agent.prints("no coordinator answers")) << agent.printed();
}

}  // namespace
}  // namespace ergocast::test
