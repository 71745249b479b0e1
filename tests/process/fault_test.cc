// What happens when processes die, hang, or are told to stop.
#include <algorithm>
#include <lcm/lcm-cpp.hpp>
#include <sstream>

#include "core/noise.h"
#include "lcmtypes/channels.h"
#include "lcmtypes/codec.h"
#include "runtime/lcm_url.h"
#include "tests/process/programs.h"

namespace ergocast::test {
namespace {

class Fault : public OwnHost {
 protected:
  /// A long mission that is well under way. A tick may stay unanswered for `timeout_s`: longer than
  /// any test takes, unless the time-out itself is what is tested.
  Child long_mission(std::vector<std::string> more = {}, int timeout_s = 600) {
    std::string text = text_of(scenario_file("quadrimodal_corners"));
    text.replace(text.find("pace:"), 0,
                 "lockstep_timeout_s: " + std::to_string(timeout_s) + "  ");
    std::ofstream(folder_ / "quadrimodal_corners.textproto") << text;
    std::vector<std::string> arguments{"run", folder_ / "quadrimodal_corners.textproto", "--out",
                                       out()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    if (std::find(more.begin(), more.end(), "--duration") == more.end()) {
      arguments.insert(arguments.end(), {"--duration", "100000"});
    }
    Child mission = start("ergocast", arguments);
    mission_log_ = log_;
    EXPECT_TRUE(recorded(100000)) << said();
    return mission;
  }
  std::string said() const { return text_of(mission_log_); }

  /// Process ids on this host whose command line contains all of `words`.
  static std::vector<pid_t> pids(const std::vector<std::string>& words) {
    std::vector<pid_t> found;
    for (const std::string& process : processes_on_own_host()) {
      const std::string pid = process.substr(process.find("pid ") + 4);
      std::string command = text_of("/proc/" + pid.substr(0, pid.size() - 1) + "/cmdline");
      std::replace(command.begin(), command.end(), '\0', ' ');
      if (std::all_of(words.begin(), words.end(), [&command](const std::string& word) {
            return command.find(word) != command.npos;
          })) {
        found.push_back(std::stoi(pid));
      }
    }
    return found;
  }
  static void signal_to(const std::vector<std::string>& words, int signal) {
    const auto targets = pids(words);
    ASSERT_EQ(targets.size(), 1U);
    kill(targets.front(), signal);
  }

  std::filesystem::path mission_log_;
};

TEST_F(Fault, CtrlCEndsTheMissionInOrderWithACompleteRecord) {
  Child mission = long_mission();
  mission.send(SIGINT);
  EXPECT_EQ(wait_for(mission), 0) << said();
  EXPECT_EQ(summary()["result"], "stopped");
  EXPECT_EQ(summary()["record_complete"], true);
  EXPECT_TRUE(std::filesystem::exists(out() / "report.html"));
  EXPECT_EQ(ergocast({"verify", out()}), 0) << output();
}

TEST_F(Fault, KilledLauncherLeavesNoProcessAndAReadableRecord) {
  Child mission = long_mission();
  mission.send(SIGKILL);
  EXPECT_TRUE(eventually([] { return processes_on_own_host().empty(); }));
  EXPECT_EQ(ergocast({"verify", out()}), 0) << output();
  EXPECT_EQ(ergocast({"report", out()}), 0) << output();
}

TEST_F(Fault, DeadAgentIsNamedRestartedAndTheMissionGoesOn) {
  Child mission = long_mission();
  signal_to({"ergocast-agent", "--id 2"}, SIGKILL);
  ASSERT_TRUE(eventually([this] {
    const std::string log = text_of(out() / "log" / "agent-2.log");
    const auto first = log.find(": running");
    return first != log.npos && log.find(": running", first + 1) != log.npos;
  })) << said();
  const auto size = std::filesystem::file_size(out() / "trajectory.csv");
  ASSERT_TRUE(recorded(size + 200000)) << said();
  mission.send(SIGTERM);
  EXPECT_EQ(wait_for(mission), 0) << said();
  EXPECT_NE(said().find("agent-2 (process"), std::string::npos) << said();
  EXPECT_NE(said().find("was killed by SIGKILL"), std::string::npos) << said();
  EXPECT_EQ(summary()["restarts"], 1);
  EXPECT_EQ(summary()["agents"].size(), 5U);
  EXPECT_EQ(ergocast({"verify", out()}), 2);
  EXPECT_NE(output().find("restarted"), std::string::npos) << output();
}

TEST_F(Fault, AgentThatIsToldToStopIsNamedAndReplaced) {
  Child mission = long_mission();
  signal_to({"ergocast-agent", "--id 0"}, SIGTERM);
  ASSERT_TRUE(eventually([this] { return said().find("agent-0: restarted") != std::string::npos; }));
  mission.send(SIGTERM);
  EXPECT_EQ(wait_for(mission), 0) << said();
  EXPECT_NE(said().find("agent-0 (process"), std::string::npos) << said();
  EXPECT_NE(said().find("told to stop by a signal"), std::string::npos) << said();
}

TEST_F(Fault, DeadLoggerIsNamedAndTheTeamGoesOnWithoutARecord) {
  Child mission = long_mission();
  signal_to({"ergocast-logger"}, SIGKILL);
  ASSERT_TRUE(eventually([this] { return said().find("logger (process") != std::string::npos; }));
  mission.send(SIGINT);
  EXPECT_EQ(wait_for(mission), 4) << said();
  EXPECT_EQ(summary()["record_complete"], false);
  EXPECT_EQ(summary()["scenario"], "quadrimodal_corners");
  EXPECT_EQ(ergocast({"verify", out()}), 2) << output();
}

TEST_F(Fault, LauncherThatSleptThroughTheEndStillNoticesIt) {
  Child mission = start("ergocast", {"run", scenario_file("quadrimodal_corners"), "--duration",
                                     "400", "--out", out()});
  mission_log_ = log_;
  ASSERT_TRUE(recorded(100000)) << said();
  mission.send(SIGSTOP);
  ASSERT_TRUE(eventually([] { return processes_on_own_host().size() == 1; }));
  mission.send(SIGCONT);
  EXPECT_EQ(wait_for(mission), 0) << said();
  EXPECT_EQ(summary()["result"], "done");
  EXPECT_EQ(summary()["restarts"], 0);
}

TEST_F(Fault, LoggerThatWasGivenUpLeavesARecordThatSaysSo) {
  Child mission = long_mission({"--duration", "1000"}, 1);
  signal_to({"ergocast-logger"}, SIGSTOP);
  // The world goes on without it when its patience is over, to the end.
  ASSERT_TRUE(eventually([this] {
    return text_of(out() / "log" / "coordinator.log").find("mission ended") != std::string::npos;
  })) << said();
  EXPECT_NE(text_of(out() / "log" / "sim.log").find("going on without"), std::string::npos);
  signal_to({"ergocast-logger"}, SIGCONT);
  EXPECT_EQ(wait_for(mission), 4) << said();
  EXPECT_EQ(summary()["record_complete"], false);
  EXPECT_EQ(summary()["result"], "failed");
}

TEST_F(Fault, ParentThatIgnoresItsChildrenIsNoObstacle) {
  signal(SIGCHLD, SIG_IGN);  // is inherited
  EXPECT_EQ(std::system(("exec " ERGOCAST_BIN_DIR "/ergocast run " +
                         scenario_file("quadrimodal_corners").string() +
                         " --duration 5 --out " + out().string() + " >/dev/null 2>&1").c_str()),
            -1);  // whoever ignores children cannot ask how they ended
  signal(SIGCHLD, SIG_DFL);
  EXPECT_EQ(summary()["result"], "done");
}

TEST_F(Fault, AgentThatDiesAgainAndAgainFailsTheMission) {
  Child mission = long_mission();
  for (int restart = 0; restart <= 3; ++restart) {
    ASSERT_TRUE(eventually([] { return pids({"ergocast-agent", "--id 1"}).size() == 1; })) << said();
    signal_to({"ergocast-agent", "--id 1"}, SIGKILL);
    ASSERT_TRUE(eventually([] { return pids({"ergocast-agent", "--id 1"}).empty(); }));
  }
  EXPECT_EQ(wait_for(mission), 4) << said();
  EXPECT_EQ(summary()["result"], "failed");
  EXPECT_EQ(summary()["restarts"], 3);
  const std::string reason = summary()["reason"];
  EXPECT_NE(reason.find("agent-1 was killed by SIGKILL after 3 restarts"), std::string::npos)
      << reason;
}

TEST_F(Fault, DeadWorldFailsTheMission) {
  Child mission = long_mission();
  signal_to({"ergocast-sim"}, SIGKILL);
  EXPECT_EQ(wait_for(mission), 4) << said();
  EXPECT_EQ(summary()["result"], "failed");
  EXPECT_EQ(summary()["reason"], "the sim process was killed by SIGKILL");
}

TEST_F(Fault, HangingAgentIsNamedByTheTimeOut) {
  Child mission = long_mission({}, 5);
  signal_to({"ergocast-agent", "--id 3"}, SIGSTOP);
  EXPECT_EQ(wait_for(mission), 4) << said();
  const std::string reason = summary()["reason"];
  EXPECT_NE(reason.find("agent 3 has not answered tick"), std::string::npos) << reason;
}

TEST_F(Fault, YoungerOfTwoAgentsWithOneIdStopsAndSaysWhy) {
  const std::string url = "udpm://239.255.76.67:24600?ttl=0";
  Child mission = long_mission({"--lcm-url", url});
  EXPECT_EQ(run("ergocast-agent", {"--id", "0", "--lcm-url", url}), 4);
  EXPECT_NE(output().find("agent 0 is already running on"), std::string::npos) << output();
  mission.send(SIGINT);
  EXPECT_EQ(wait_for(mission), 0) << said();
  EXPECT_EQ(ergocast({"verify", out()}), 0) << output();
}

/// Datagrams that must have no effect: noise, other runs' messages, flipped bits.
class Vandal {
 public:
  explicit Vandal(const LcmUrl& url)
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
  const std::string url = "udpm://239.255.76.67:24700?ttl=0";
  Child mission = long_mission({"--lcm-url", url});
  Vandal vandal(std::get<LcmUrl>(LcmUrl::parse(url)));
  for (std::uint64_t round = 0; round < 200; ++round) vandal.strike(round);
  const auto size = std::filesystem::file_size(out() / "trajectory.csv");
  ASSERT_TRUE(recorded(size + 200000)) << said();
  mission.send(SIGINT);
  EXPECT_EQ(wait_for(mission), 0) << said();
  EXPECT_EQ(ergocast({"verify", out()}), 0) << output();
  const auto refused = summary()["messages"]["refused"];
  EXPECT_GT(refused["size"], 0);
  EXPECT_GT(refused["tag"], 0);
  EXPECT_GT(refused["run"], 0);
}

}  // namespace
}  // namespace ergocast::test
