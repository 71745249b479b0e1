// SPDX-License-Identifier: BSD-3-Clause
// Processes that hang, that get a stop signal, or that receive messages of a foreign sender.
#include <lcm/lcm-cpp.hpp>

#include "core/base/noise.h"
#include "lcmtypes/channels.h"
#include "lcmtypes/codec.h"
#include "runtime/bus/lcm_url.h"
#include "tests/process/support/mission.h"

namespace ergocast::test {
namespace {

using Fault = RunningMission;

TEST_F(Fault, CtrlCEndsTheMissionInOrderWithACompleteRecord) {
  Child mission = launch_endless(scenario());
  mission.send(SIGINT);
  EXPECT_EQ(wait_for(mission), 0) << printed();
  EXPECT_EQ(summary()["result"], "stopped");
  EXPECT_EQ(summary()["record_complete"], true);
  EXPECT_TRUE(std::filesystem::exists(out() / "report.html"));
  EXPECT_EQ(ergocast({"verify", out()}), 0) << output();
}

TEST_F(Fault, KilledLauncherLeavesNoProcessAndAReadableRecord) {
  Child mission = launch_endless(scenario());
  mission.send(SIGKILL);
  EXPECT_TRUE(eventually([] { return processes_on_own_host().empty(); }));
  EXPECT_EQ(ergocast({"verify", out()}), 0) << output();
  EXPECT_EQ(ergocast({"report", out()}), 0) << output();
}

TEST_F(Fault, LauncherThatSleptThroughTheEndStillNoticesIt) {
  Child mission = launch_held(scenario("duration_s: 20"));
  mission.send(SIGSTOP);
  release();
  ASSERT_TRUE(eventually([] { return processes_on_own_host().size() == 1; }));
  mission.send(SIGCONT);
  EXPECT_EQ(wait_for(mission), 0) << printed();
  EXPECT_EQ(summary()["result"], "done");
  EXPECT_EQ(summary()["restarts"], 0);
}

TEST_F(Fault, LoggerThatWasGivenUpLeavesARecordThatReportsIt) {
  // A buffer too small for the messages that arrive while it is stopped.
  Child mission =
      launch_held(scenario("duration_s: 20 lockstep_timeout_s: 10"),
                  {"--lcm-url", "udpm://239.255.76.67:24699?ttl=0&recv_buf_size=20000"});
  signal_to({"ergocast-logger"}, SIGSTOP);
  release();
  // The world continues without it after its time-out, to the end.
  ASSERT_TRUE(logs("coordinator", "mission ended")) << printed();
  EXPECT_NE(log_of("sim").find("goes on without it"), std::string::npos);
  signal_to({"ergocast-logger"}, SIGCONT);
  EXPECT_EQ(wait_for(mission), 4) << printed();
  EXPECT_EQ(summary()["record_complete"], false);
  EXPECT_EQ(summary()["result"], "failed");
}

TEST_F(Fault, ParentThatIgnoresItsChildrenIsNoObstacle) {
  signal(SIGCHLD, SIG_IGN);  // is inherited
  EXPECT_EQ(std::system(("exec " + (program_folder() / "ergocast").string() + " run " +
                         scenario_file("quadrimodal_corners").string() + " --duration 5 --out " +
                         out().string() + " >/dev/null 2>&1")
                            .c_str()),
            -1);  // a parent that ignores SIGCHLD cannot wait for a child
  signal(SIGCHLD, SIG_DFL);
  EXPECT_EQ(summary()["result"], "done");
}

TEST_F(Fault, HangingAgentIsNamedByTheTimeOut) {
  Child mission = launch_endless(scenario("lockstep_timeout_s: 5"));
  signal_to(agent(3), SIGSTOP);
  EXPECT_EQ(wait_for(mission), 4) << printed();
  const std::string reason = summary()["reason"];
  EXPECT_NE(reason.find("agent 3 has not answered tick"), std::string::npos) << reason;
}

TEST_F(Fault, YoungerOfTwoAgentsWithOneIdStopsAndReportsWhy) {
  Child mission = launch_endless(scenario(), {"--lcm-url", kUrl});
  EXPECT_EQ(run("ergocast-agent", {"--id", "0", "--lcm-url", kUrl}), 4);
  EXPECT_NE(output().find("agent 0 is already running on"), std::string::npos) << output();
  mission.send(SIGINT);
  EXPECT_EQ(wait_for(mission), 0) << printed();
  EXPECT_EQ(ergocast({"verify", out()}), 0) << output();
}

/// Datagrams that must have no effect: noise, other runs' messages, flipped bits.
class Adversary {
 public:
  explicit Adversary(const LcmUrl& url)
      : buses_{lcm::LCM(url.of(Bus::kSwarm)), lcm::LCM(url.of(Bus::kWorld)),
               lcm::LCM(url.of(Bus::kCommand))} {}

  void strike(std::uint64_t round) {
    const auto word = [round](std::uint32_t who) {
      return random_words(1, Purpose::kFault, who, round).first;
    };
    Stop stop{{round % 2 == 0 ? 0x77 : word(9), kOperator, 1, 1, 0}, false, "vandalism"};
    Command command;
    command.header = {word(8), 0, word(7), 1 << 30, 0};
    for (const Message& message : {Message(stop), Message(command)}) {
      std::vector<std::byte> bytes;
      encode(message, bytes);
      publish(channel_of(message), bytes);
      bytes[word(1) % bytes.size()] ^= std::byte{1};
      publish(channel_of(message), bytes);
      bytes.resize(word(2) % 1500, std::byte{0x7f});
      publish("ERGOCAST_WORLD_STATE", bytes);
      publish("ERGOCAST_CONTRIBUTION_1", bytes);
      publish("ERGOCAST_MISSION", bytes);
    }
  }

 private:
  void publish(const std::string& channel, const std::vector<std::byte>& bytes) {
    for (lcm::LCM& bus : buses_) {
      bus.publish(channel, bytes.data(), static_cast<unsigned>(bytes.size()));
    }
  }
  lcm::LCM buses_[3];
};

TEST_F(Fault, ForeignAndDamagedDatagramsAreCountedAndHaveNoEffect) {
  Child mission = launch_endless(scenario(), {"--lcm-url", kUrl});
  Adversary adversary(LcmUrl::parse(kUrl).value());
  for (std::uint64_t round = 0; round < 200; ++round) adversary.strike(round);
  ASSERT_TRUE(moves_on(200000)) << printed();
  mission.send(SIGINT);
  EXPECT_EQ(wait_for(mission), 0) << printed();
  EXPECT_EQ(ergocast({"verify", out()}), 0) << output();
  const auto refused = summary()["messages"]["refused"];
  EXPECT_GT(refused["size"], 0);
  EXPECT_GT(refused["tag"], 0);
  EXPECT_GT(refused["run"], 0);
}

}  // namespace
}  // namespace ergocast::test
