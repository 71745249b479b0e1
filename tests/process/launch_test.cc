// SPDX-License-Identifier: BSD-3-Clause
// `ergocast run` on a machine that cannot restart a killed process at once: the mission continues.
#include <sys/resource.h>

#include "tests/process/support/mission.h"

namespace ergocast::test {
namespace {

namespace fs = std::filesystem;

const std::vector<std::string> kLoggerProgram{"ergocast-logger"};

/// In lockstep: if the mission continues, all its processes run again.
class Launch : public RunningMission {
 protected:
  void TearDown() override {
    for (const char* name : {"ERGOCAST_BIN_DIR", "LD_PRELOAD", "ERGOCAST_TEST_NO_MORE_PROCESSES"}) {
      unsetenv(name);
    }
    RunningMission::TearDown();
  }
  bool comes_to_say(const std::string& part) const {
    return eventually([&] { return printed(part); });
  }
  void end(Child& mission, int restarts) {
    mission.send(SIGINT);
    EXPECT_EQ(wait_for(mission), 0) << printed();
    EXPECT_EQ(summary()["restarts"], restarts) << printed();
    EXPECT_EQ(summary()["record_complete"], true) << printed();
  }
};

TEST_F(Launch, WithoutTheFolderOfLogsAStoppedAgentComesBackAndLogsNowhere) {
  Child mission = launch_endless(scenario());
  fs::remove_all(out() / "log");
  kill_next(agent(2));
  ASSERT_TRUE(comes_to_say("agent-2: restarted (1 of 3)")) << printed();
  EXPECT_TRUE(moves_on()) << printed();
  end(mission, 1);
  EXPECT_FALSE(fs::exists(out() / "log"));
}

TEST_F(Launch, WithoutRoomForOneMoreFileAStoppedAgentComesBackOnceThereIs) {
  Child mission = launch_endless(scenario());
  rlimit former{};
  ASSERT_EQ(prlimit(mission.pid(), RLIMIT_NOFILE, nullptr, &former), 0);
  const rlimit none{3, former.rlim_max};
  ASSERT_EQ(prlimit(mission.pid(), RLIMIT_NOFILE, &none, nullptr), 0);
  kill_next(agent(2));
  ASSERT_TRUE(comes_to_say("agent-2: will be started as soon as possible")) << printed();
  EXPECT_TRUE(printed("could not be executed")) << printed();
  ASSERT_EQ(prlimit(mission.pid(), RLIMIT_NOFILE, &former, nullptr), 0);
  EXPECT_TRUE(moves_on()) << printed();
  end(mission, 1);
}

TEST_F(Launch, WithoutRoomForOneMoreProcessAStoppedAgentComesBackOnceThereIs) {
  const fs::path full = folder_ / "full";
  setenv("LD_PRELOAD", ERGOCAST_NO_MORE_PROCESSES, 1);
  setenv("ERGOCAST_TEST_NO_MORE_PROCESSES", full.c_str(), 1);
  Child mission = launch_endless(scenario());
  std::ofstream(full).close();
  kill_next(agent(2));
  ASSERT_TRUE(comes_to_say("Resource temporarily unavailable")) << printed();
  fs::remove(full);
  EXPECT_TRUE(moves_on()) << printed();
  end(mission, 1);
}

/// Copies of the programs that the test can remove.
class OwnPrograms : public Launch {
 protected:
  void SetUp() override {
    fs::create_directory(programs());
    fs::copy_file(program_folder() / "ergocast", programs() / "ergocast");
    for (const char* name :
         {"ergocast-agent", "ergocast-coordinator", "ergocast-logger", "ergocast-sim"}) {
      fs::create_symlink(program_folder() / name, programs() / name);
    }
    setenv("ERGOCAST_BIN_DIR", programs().c_str(), 1);
  }
  fs::path programs() const { return folder_ / "programs"; }
  fs::path agent_program() const { return programs() / "ergocast-agent"; }
};

TEST_F(OwnPrograms, AreReplacedWhileAnAgentCrashesAndItComesBackWithTheNewOne) {
  Child mission = launch_endless(scenario());
  const fs::path real = fs::read_symlink(agent_program());
  fs::remove(agent_program());
  std::ofstream(agent_program()) << "half of a program";
  kill_next(agent(2));
  ASSERT_TRUE(comes_to_say("agent-2: will be started as soon as possible")) << printed();
  ASSERT_TRUE(logs("agent-2", "cannot be executed: Permission denied", 2)) << printed();
  fs::remove(agent_program());
  fs::create_symlink(real, agent_program());
  EXPECT_TRUE(moves_on()) << printed();
  end(mission, 1);
}

TEST_F(OwnPrograms, ThatAreGoneForGoodFailTheMission) {
  Child mission = launch_endless(scenario());
  fs::remove(agent_program());
  kill_next(agent(2));
  EXPECT_EQ(wait_for(mission), 4) << printed();
  EXPECT_EQ(summary()["reason"], "agent-2 could not be started again") << printed();
}

TEST_F(Launch, WhileTheRouteIsAwayStoppedProcessesAreWaitedForAndNoRestartIsCounted) {
  Child mission = launch_endless(scenario());
  ASSERT_EQ(std::system("ip route del 224.0.0.0/4 dev lo"), 0);
  kill_next(agent(1));
  kill_next({"ergocast-coordinator"});
  kill_next({"ergocast-sim"});
  kill_next(kLoggerProgram);
  // More often than a killed process is restarted.
  for (const char* name : {"agent-1", "coordinator", "sim", "logger"}) {
    EXPECT_TRUE(logs(name, "LCM needs a multicast route", 4)) << printed();
  }
  ASSERT_EQ(std::system("ip route add 224.0.0.0/4 dev lo"), 0);
  EXPECT_TRUE(moves_on()) << printed();
  end(mission, 4);
}

/// The record is damaged before the logger's next process reads it.
class DamagedRecord : public Launch {
 protected:
  template <class Damage>
  void while_the_logger_is_dead(Child& mission, Damage damage) {
    mission.send(SIGSTOP);
    kill_next(kLoggerProgram);
    damage();
    mission.send(SIGCONT);
  }
  void write(const char* file, const std::string& text) const {
    std::ofstream(out() / file, std::ios::binary) << text;
  }
};

TEST_F(DamagedRecord, GoesOnInANewSegmentWithoutWhatCannotBeRead) {
  Child mission = launch_endless(scenario());
  while_the_logger_is_dead(mission, [this] {
    std::string rows = text_of(out() / "trajectory.csv");
    rows.replace(rows.find('\n', 10000) + 1, 200, 200, '\1');
    write("trajectory.csv", rows);
  });
  ASSERT_TRUE(moves_on()) << printed();
  EXPECT_TRUE(logs("logger", "goes on in a new segment")) << log_of("logger");
  while_the_logger_is_dead(mission, [this] { write("trajectory-001.csv", ""); });
  ASSERT_TRUE(moves_on()) << printed();
  while_the_logger_is_dead(mission, [this] { fs::remove(out() / "metrics-002.csv"); });
  ASSERT_TRUE(moves_on()) << printed();
  end(mission, 3);
  EXPECT_EQ(summary()["segments"], 4) << printed();
  EXPECT_GT(summary()["gaps"], 0) << printed();
  EXPECT_GT(fs::file_size(out() / "trajectory-003.csv"), 1000U);
  EXPECT_TRUE(printed("no report: ")) << printed();
}

TEST_F(DamagedRecord, GoesOnWithoutAReadablePlanWhichIsThenWrittenAgain) {
  Child mission = launch_endless(scenario());
  const std::string plan = text_of(out() / "plan.binpb");
  while_the_logger_is_dead(mission, [this] { write("plan.binpb", "no plan"); });
  ASSERT_TRUE(moves_on()) << printed();
  EXPECT_TRUE(text_of(out() / "plan.binpb") == plan);
  while_the_logger_is_dead(mission, [this] { fs::remove(out() / "plan.binpb"); });
  ASSERT_TRUE(moves_on()) << printed();
  EXPECT_TRUE(text_of(out() / "plan.binpb") == plan);
  end(mission, 2);
  EXPECT_EQ(summary()["gaps"], 0) << printed();
}

}  // namespace
}  // namespace ergocast::test
