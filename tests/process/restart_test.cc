// SPDX-License-Identifier: BSD-3-Clause
// kill -9: the loss of one or several processes never ends a mission, and a restarted process
// continues where it was.
#include <lcm/lcm-cpp.hpp>
#include <tuple>

#include "tests/process/support/bus_observer.h"
#include "tests/process/support/mission.h"

namespace ergocast::test {
namespace {

using namespace std::chrono_literals;

const std::vector<std::string> kSimProcess{"ergocast-sim"}, kLoggerProcess{"ergocast-logger"},
    kCoordinatorProcess{"ergocast-coordinator"};

/// The number of events in an event log, up to an incomplete one.
int events_in(const std::filesystem::path& file) {
  lcm::LogFile log(file, "r");
  int events = 0;
  while (log.good() && log.readNextEvent() != nullptr) ++events;
  return events;
}

/// The tick of the last whole row of a table.
Tick last_tick(const std::filesystem::path& table) {
  const std::string text = text_of(table);
  return std::stoll(text.substr(text.rfind('\n', text.rfind('\n') - 1) + 1));
}

class Restart : public RunningMission {
 protected:
  /// States that only a killed world had may be missing in the record; nothing else may be.
  void expect_identical_to_its_simulation(bool complete = true) {
    EXPECT_EQ(ergocast({"verify", out()}), 0) << output();
    EXPECT_NE(output().find("identical"), std::string::npos) << output();
    EXPECT_TRUE(!complete || output().find("missing") == std::string::npos) << output();
  }
  /// Kills all of the processes before any is started again.
  static void kill_at_once(const std::vector<std::vector<std::string>>& processes) {
    std::vector<pid_t> victims;
    for (const auto& words : processes) {
      ASSERT_TRUE(eventually([&] { return pids(words).size() == 1; }))
          << ::testing::PrintToString(words);
      victims.push_back(pids(words).front());
    }
    for (const pid_t victim : victims) kill(victim, SIGKILL);
  }
  /// Kills the process more often than it is restarted.
  void kill_for_good(const std::vector<std::string>& words) {
    for (int death = 0; death <= 3; ++death) kill_next(words);
  }
};

TEST_F(Restart, KilledAgentIsNamedAndItsSuccessorTakesPart) {
  Child mission = launch_endless(scenario());
  kill_next(agent(2));
  ASSERT_TRUE(logs("agent-2", ": running", 2)) << printed();
  ASSERT_TRUE(moves_on()) << printed();
  mission.send(SIGTERM);
  EXPECT_EQ(wait_for(mission), 0) << printed();
  EXPECT_TRUE(printed("agent-2 (process")) << printed();
  EXPECT_TRUE(printed("was killed by SIGKILL")) << printed();
  EXPECT_EQ(summary()["restarts"], 1);
  EXPECT_EQ(summary()["agents"].size(), 5U);
  EXPECT_EQ(ergocast({"verify", out()}), 2);
  EXPECT_NE(output().find("restarted"), std::string::npos) << output();
}

/// A team whose agents broadcast every five ticks, in either pace.
class RestartInEitherPace : public Restart, public ::testing::WithParamInterface<const char*> {};
INSTANTIATE_TEST_SUITE_P(Paces, RestartInEitherPace,
                         ::testing::Values("--lockstep", "--realtime=5"), name_of_pace);

TEST_P(RestartInEitherPace, KilledAgentGetsBackWhatItHasSent) {
  const bool lockstep = std::string(GetParam()) == "--lockstep";
  Child mission =
      launch_endless(scenario("broadcast_period_ticks: 5"), {GetParam(), "--lcm-url", kUrl});
  BusObserver observer(kUrl);
  const auto member = [&observer] { return observer.member(1); };
  ASSERT_TRUE(observer.observes(
      [&] { return observer.steps_sent(member()) > 0 && observer.answered(member()) > 0; }));
  const Author former = member();
  // An agent that does not answer holds the tick until the last messages have been repeated.
  if (lockstep) signal_to(agent(2), SIGSTOP);
  ASSERT_TRUE(observer.observes([&] { return !lockstep || observer.stands_still(former); }));
  kill_next(agent(1));
  const Instant killed = now();
  const auto since_kill = [killed] { return std::to_string((now() - killed) / 1.0s); };
  if (lockstep) signal_to(agent(2), SIGCONT);
  ASSERT_TRUE(observer.observes([&] { return member() != former && member().incarnation != 0; }));
  RecordProperty("admitted_after_s", since_kill());
  ASSERT_TRUE(observer.observes(
      [&] { return observer.held(member(), former) >= observer.steps_sent(former); }));
  RecordProperty("recovered_after_s", since_kill());
  ASSERT_TRUE(observer.observes([&] { return observer.steps_sent(member()) > 10; }));
  mission.send(SIGINT);
  EXPECT_EQ(wait_for(mission), 0) << printed();

  EXPECT_EQ(observer.held(member(), former), observer.steps_sent(former))
      << "no more than it had sent";
  EXPECT_LT(observer.answered(former), observer.block(former).next_broadcast_tick)
      << "lost is only what it covered since its last broadcast";
  for (const Author& life : {former, member()}) {
    const Contribution block = observer.block(life);
    const Tick ticks = block.header.tick + 1 - observer.entry(life)->active_from;
    EXPECT_LE(block.steps, ticks);
    EXPECT_TRUE(!lockstep || block.steps == ticks) << block.steps << " of " << ticks;
    EXPECT_NEAR(block.sums[0], 0.1 * static_cast<double>(block.steps), 1e-9 * block.sums[0]);
  }
}

/// All agents and other processes are killed at once: only `ergocast run` still has the mission.
struct Victims {
  const char* name;
  std::vector<std::string> programs;  // besides the agents
};
void PrintTo(const Victims& victims, std::ostream* out) { *out << victims.name; }
class AllAgentsAtOnce : public Restart,
                        public ::testing::WithParamInterface<std::tuple<Victims, const char*>> {};
INSTANTIATE_TEST_SUITE_P(
    And, AllAgentsAtOnce,
    ::testing::Combine(::testing::Values(Victims{"NobodyElse", {}},
                                         Victims{"Coordinator", {"coordinator"}},
                                         Victims{"CoordinatorAndWorld", {"coordinator", "sim"}},
                                         Victims{"Everybody", {"coordinator", "sim", "logger"}}),
                       ::testing::Values("--lockstep", "--realtime=5")),
    [](const auto& of) {
      return std::string(std::get<0>(of.param).name) +
             (std::string(std::get<1>(of.param)) == "--lockstep" ? "Lockstep" : "Realtime");
    });

TEST_P(AllAgentsAtOnce, AreReplacedAndTheMissionGoesOn) {
  const auto& [victims, pace] = GetParam();
  Child mission = launch_endless(scenario(), {pace});
  std::vector<std::vector<std::string>> processes;
  for (int id = 0; id < 4; ++id) processes.push_back(agent(id));
  for (const std::string& program : victims.programs) processes.push_back({"ergocast-" + program});
  kill_at_once(processes);
  for (const std::string& program : victims.programs) {
    ASSERT_TRUE(eventually([&] { return printed(program + ": restarted (1 of 3)"); })) << printed();
    ASSERT_TRUE(program != "coordinator" || logs(program, "taken over")) << printed();
  }
  for (int id = 0; id < 4; ++id) {
    ASSERT_TRUE(logs("agent-" + std::to_string(id), ": running", 2)) << printed();
  }
  ASSERT_TRUE(moves_on()) << printed();
  mission.send(SIGINT);
  EXPECT_EQ(wait_for(mission), 0) << printed();
  EXPECT_EQ(summary()["restarts"], processes.size());
  EXPECT_EQ(summary()["record_complete"], true);
  EXPECT_EQ(summary()["agents"].size(), 8U) << "the roster of before is still known";
  const std::string reason = summary()["reason"];
  EXPECT_NE(reason.find("all agents had stopped at once"), reason.npos) << reason;
  EXPECT_EQ(ergocast({"report", out()}), 0) << output();
}

TEST_F(Restart, AMissionWhoseCoordinatorAndAgentsCrashAtOnceComesToItsEnd) {
  Child mission = launch_held(scenario("duration_s: 20"));
  kill_at_once({kCoordinatorProcess, agent(0), agent(1), agent(2), agent(3)});
  EXPECT_EQ(wait_for(mission), 0) << printed();
  EXPECT_EQ(summary()["result"], "done");
  EXPECT_EQ(summary()["ticks"], summary()["tick_count"]);
  EXPECT_EQ(summary()["gaps"], 0);
}

TEST_F(Restart, APausedMissionWhoseCoordinatorAndAgentsCrashAtOnceStaysPaused) {
  Child mission = launch_endless(scenario(), {"--lcm-url", kUrl});
  ASSERT_EQ(ergocast({"pause", "--lcm-url", kUrl}), 0) << output();
  kill_at_once({kCoordinatorProcess, agent(0), agent(1), agent(2), agent(3)});
  ASSERT_TRUE(logs("coordinator", "taken over")) << printed();
  ASSERT_TRUE(logs("coordinator", "mission is paused", 2)) << printed();
  ASSERT_TRUE(eventually([&] { return ergocast({"resume", "--lcm-url", kUrl}) == 0; })) << output();
  EXPECT_NE(output().find("goes on at tick "), output().npos) << output();
  ASSERT_TRUE(moves_on()) << printed();
  mission.send(SIGINT);
  EXPECT_EQ(wait_for(mission), 0) << printed();
  EXPECT_EQ(summary()["holds"].size(), 1U);
}

TEST_F(Restart, KilledWorldGoesOnWhereTheAgentsWere) {
  Child mission = launch_endless(scenario());
  kill_next(kSimProcess);
  ASSERT_TRUE(logs("sim", "moving from tick", 2)) << printed();
  ASSERT_TRUE(moves_on()) << printed();
  mission.send(SIGINT);
  EXPECT_EQ(wait_for(mission), 0) << printed();
  EXPECT_TRUE(printed("sim: restarted (1 of 3)")) << printed();
  EXPECT_EQ(summary()["result"], "stopped");
  EXPECT_EQ(summary()["restarts"], 1);
  expect_identical_to_its_simulation(false);
}

TEST_F(Restart, KilledCoordinatorTakesTheMissionOver) {
  Child mission = launch_held(scenario("duration_s: 20"));
  kill_next(kCoordinatorProcess);
  ASSERT_TRUE(logs("coordinator", "taken over")) << printed();
  release();
  EXPECT_EQ(wait_for(mission), 0) << printed();
  EXPECT_EQ(summary()["result"], "done");
  EXPECT_EQ(summary()["reason"], "mission complete");
  EXPECT_EQ(summary()["restarts"], 1);
  expect_identical_to_its_simulation();
}

/// It learns from the rows of the first segment which agents covered nothing at their stations.
TEST_F(Restart, KilledLoggerGoesOnWhileBatteriesAreCharged) {
  const std::filesystem::path tree = ERGOCAST_SOURCE_DIR;
  hold_next("ERGOCAST_COMMAND_0", 56);  // agents 0 and 1 have been at home since tick 51
  Child mission =
      start_mission(tree / "tests/lab/charged_team.textproto",
                    {"--lockstep", "--lcm-url", kUrl, "--set", "time.lockstep_timeout_s=600",
                     "--set", "time.admission_timeout_s=600"});
  EXPECT_TRUE(eventually([] { return stopped(pids(agent(0))); })) << printed();
  hold_none();
  EXPECT_TRUE(eventually([&] {
    ergocast({"status", "--lcm-url", kUrl});
    return output().find("charging") != std::string::npos;
  })) << output();
  kill_next(kLoggerProcess);
  ASSERT_TRUE(logs("logger", "recording", 2)) << printed();
  release();
  EXPECT_EQ(wait_for(mission), 0) << printed();
  EXPECT_EQ(summary()["segments"], 2);
  EXPECT_EQ(summary()["record_complete"], true);
  expect_identical_to_its_simulation();
}

TEST_F(Restart, KilledLoggerGoesOnInASecondSegmentAndLosesNothing) {
  Child mission = launch_endless(scenario());
  kill_next(kLoggerProcess);
  ASSERT_TRUE(logs("logger", "recording", 2)) << printed();
  ASSERT_TRUE(moves_on()) << printed();
  mission.send(SIGINT);
  EXPECT_EQ(wait_for(mission), 0) << printed();
  EXPECT_EQ(summary()["result"], "stopped");
  EXPECT_EQ(summary()["segments"], 2);
  EXPECT_EQ(summary()["record_complete"], true);
  EXPECT_GT(std::filesystem::file_size(out() / "trajectory-001.csv"), 0U);
  expect_identical_to_its_simulation();
  EXPECT_EQ(ergocast({"report", out()}), 0) << output();
}

TEST_F(Restart, InRealTimeTheMissionContinuesThoughEachOfThemIsKilled) {
  Child mission = launch_endless(scenario(), {"--realtime=5", "--lcm-url", kUrl});
  kill_next(kCoordinatorProcess);
  ASSERT_TRUE(logs("coordinator", "taken over")) << printed();
  ASSERT_TRUE(moves_on()) << printed();
  kill_next(kSimProcess);
  ASSERT_TRUE(logs("sim", "moving from tick", 2)) << printed();
  ASSERT_TRUE(moves_on()) << printed();
  BusObserver observer(kUrl);
  ASSERT_TRUE(observer.observes([&] { return observer.recorded() > 0; }));
  kill_next(kLoggerProcess);
  EXPECT_GE(last_tick(out() / "trajectory.csv"), observer.recorded()) << "what it had acknowledged";
  ASSERT_TRUE(moves_on()) << printed();
  mission.send(SIGINT);
  EXPECT_EQ(wait_for(mission), 0) << printed();
  EXPECT_EQ(summary()["restarts"], 3);
  EXPECT_EQ(summary()["segments"], 2);
  EXPECT_EQ(summary()["record_complete"], true);
  EXPECT_GT(events_in(out() / "events-000.lcm"), 0);
  EXPECT_GT(events_in(out() / "events-001.lcm"), 0);
  EXPECT_EQ(ergocast({"report", out()}), 0) << output();
}

TEST_F(Restart, WithoutACoordinatorTheTeamEndsByItselfAtTheLastTick) {
  Child mission = launch_held(scenario("duration_s: 20"));
  kill_for_good(kCoordinatorProcess);
  ASSERT_TRUE(eventually([this] { return printed("the team goes on to the plan's last tick"); }))
      << printed();
  release();
  EXPECT_EQ(wait_for(mission), 0) << printed();
  EXPECT_EQ(summary()["result"], "done");
  EXPECT_EQ(summary()["reason"],
            "mission complete; coordinator was killed by SIGKILL after 3 restarts");
  EXPECT_EQ(summary()["ticks"], summary()["tick_count"]);
  EXPECT_EQ(summary()["restarts"], 3);
  expect_identical_to_its_simulation();
}

TEST_F(Restart, WithoutACoordinatorATickThatStaysUnansweredFailsTheMission) {
  Child mission = launch_endless(scenario("lockstep_timeout_s: 5"));
  kill_for_good(kCoordinatorProcess);
  ASSERT_TRUE(eventually([this] { return printed("the team goes on to the plan's last tick"); }))
      << printed();
  kill_next(agent(1));
  EXPECT_EQ(wait_for(mission), 4) << printed();
  const std::string reason = summary()["reason"];
  EXPECT_NE(reason.find("was not answered in time, and no coordinator is left"), std::string::npos)
      << reason;
}

TEST_F(Restart, WithoutACoordinatorAndAnyAgentTheMissionFailsInRealTime) {
  Child mission = launch_endless(scenario(), {"--realtime=5"});
  kill_for_good(kCoordinatorProcess);
  ASSERT_TRUE(eventually([this] { return printed("the team goes on to the plan's last tick"); }))
      << printed();
  kill_at_once({agent(0), agent(1), agent(2), agent(3)});
  EXPECT_EQ(wait_for(mission), 4) << printed();
  EXPECT_EQ(std::string(summary()["reason"]).find("no agent runs any more, and no coordinator"), 0U)
      << summary()["reason"];
}

TEST_F(Restart, AMissionThatNoAgentKnowsYetIsBegunByTheNextCoordinator) {
  hold_next("ERGOCAST_MISSION", -1);  // the coordinator, before its first message
  Child mission = start_mission(scenario(), {"--duration", "20"});
  ASSERT_TRUE(eventually([] { return stopped(pids(kCoordinatorProcess)); })) << printed();
  hold_none();
  kill_next(kCoordinatorProcess);
  EXPECT_EQ(wait_for(mission), 0) << printed();
  EXPECT_EQ(summary()["result"], "done");
  expect_identical_to_its_simulation();
}

TEST_F(Restart, WorldThatCrashesAgainAndAgainFailsTheMission) {
  Child mission = launch_endless(scenario());
  kill_for_good(kSimProcess);
  EXPECT_EQ(wait_for(mission), 4) << printed();
  EXPECT_EQ(summary()["result"], "failed");
  EXPECT_EQ(summary()["reason"], "sim was killed by SIGKILL after 3 restarts");
}

TEST_F(Restart, AgentThatCrashesAgainAndAgainFailsTheMission) {
  Child mission = launch_endless(scenario());
  kill_for_good(agent(1));
  EXPECT_EQ(wait_for(mission), 4) << printed();
  EXPECT_EQ(summary()["result"], "failed");
  EXPECT_EQ(summary()["restarts"], 3);
  EXPECT_EQ(summary()["reason"], "agent-1 was killed by SIGKILL after 3 restarts");
}

TEST_F(Restart, WithoutALoggerTheTeamGoesOnAndTheRunReportsThatTheRecordIsNotComplete) {
  Child mission = launch_endless(scenario(), {"--realtime=5", "--lcm-url", kUrl});
  kill_for_good(kLoggerProcess);
  ASSERT_TRUE(eventually([this] { return printed("the team goes on without a record"); }))
      << printed();
  BusObserver observer(kUrl);
  ASSERT_TRUE(observer.observes([&] { return observer.answered(observer.member(0)) > 0; }));
  const Tick tick = observer.answered(observer.member(0));
  ASSERT_TRUE(observer.observes([&] { return observer.answered(observer.member(0)) > tick + 20; }));
  mission.send(SIGINT);
  EXPECT_EQ(wait_for(mission), 4) << printed();
  EXPECT_EQ(summary()["record_complete"], false);
  EXPECT_EQ(summary()["reason"],
            "the logger left no summary; logger was killed by SIGKILL after 3 restarts");
  EXPECT_EQ(summary()["scenario"], "quadrimodal_corners");
}

TEST_F(Restart, AgentOrWorldThatASignalStopsIsNamedAndReplaced) {
  Child mission = launch_endless(scenario());
  signal_to(agent(0), SIGTERM);
  ASSERT_TRUE(logs("agent-0", ": running", 2)) << printed();
  signal_to(kSimProcess, SIGTERM);
  ASSERT_TRUE(logs("sim", "moving from tick", 2)) << printed();
  ASSERT_TRUE(moves_on()) << printed();
  mission.send(SIGTERM);
  EXPECT_EQ(wait_for(mission), 0) << printed();
  EXPECT_TRUE(printed("agent-0 (process")) << printed();
  EXPECT_TRUE(printed("stopped by a signal")) << printed();
  EXPECT_TRUE(printed("a signal stopped the world")) << printed();
  EXPECT_EQ(summary()["restarts"], 2);
}

}  // namespace
}  // namespace ergocast::test
