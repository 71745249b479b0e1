// SPDX-License-Identifier: BSD-3-Clause
// `ergocast stop`: a mission of real processes is ended from outside, in order and at once.
#include <algorithm>
#include <set>

#include "runtime/bus/clock.h"
#include "runtime/process/program_options.h"
#include "tests/process/support/mission.h"
#include "tests/process/support/record.h"
#include "tests/process/support/stranger.h"

namespace ergocast::test {
namespace {

class StopCommand : public ByHand {
 protected:
  int stop(std::vector<std::string> more = {}) {
    more.insert(more.begin(), {"stop", "--lcm-url", kUrl});
    return ergocast(more);
  }

  /// Whether the record has that reason, possibly followed by a remark on late commands.
  bool was_ended(const std::string& reason) const {
    return summary()["reason"].get<std::string>().starts_with(reason);
  }

  std::filesystem::path endless(bool realtime) {
    return scenario(std::string("duration_s: ") + kEndless +
                    " realtime_factor: 10 pace: " + (realtime ? "REALTIME" : "LOCKSTEP"));
  }
  /// All processes, started by hand.
  std::vector<Program*> start_all(const std::filesystem::path& scenario) {
    std::filesystem::create_directory(out());
    std::vector<Program*> all{&hand("ergocast-logger", {"--out", out()}), &hand("ergocast-sim"),
                              &hand("ergocast-coordinator", {scenario})};
    for (const char* id : {"0", "1", "2", "3"})
      all.push_back(&hand("ergocast-agent", {"--id", id}));
    return all;
  }
  /// Also waits until the mission is under way.
  std::vector<Program*> start_mission(const std::filesystem::path& scenario) {
    const auto all = start_all(scenario);
    EXPECT_TRUE(recorded(30000)) << all[2]->printed();
    return all;
  }
  /// No vehicle moves in the record's last tick, and all moved before: in lockstep in the tick
  /// before; in real time a process that receives the stop first stands still first.
  void expect_halt(bool realtime) {
    auto rows = recorded_rows(out());
    ASSERT_GT(rows.size(), 2u);
    const auto last = std::prev(rows.end())->second;
    ASSERT_EQ(last.size(), 4u);
    for (const auto& [id, row] : last) EXPECT_TRUE(row.stands()) << "agent " << id;
    rows.erase(std::prev(rows.end()));
    if (!realtime) rows.erase(rows.begin(), std::prev(rows.end()));
    for (const auto& [id, unused] : last) {
      EXPECT_TRUE(std::any_of(rows.begin(), rows.end(),
                              [id = id](const auto& tick) {
                                return tick.second.contains(id) && !tick.second.at(id).stands();
                              }))
          << "agent " << id;
    }
  }
};

struct Stopped : StopCommand, ::testing::WithParamInterface<bool> {};
INSTANTIATE_TEST_SUITE_P(Paces, Stopped, ::testing::Values(false, true),
                         [](const auto& pace) { return pace.param ? "RealTime" : "Lockstep"; });

TEST_P(Stopped, InOrderByTheCoordinator) {
  const auto all = start_mission(endless(GetParam()));
  ASSERT_EQ(stop(), 0) << output();
  EXPECT_TRUE(answered("the mission has ended at tick ")) << output();
  EXPECT_TRUE(answered("stopped by `ergocast stop` on " + host_name())) << output();
  for (Program* program : all) EXPECT_EQ(wait_for(program->child), 0) << program->printed();
  EXPECT_EQ(summary()["result"], "stopped");
  EXPECT_TRUE(was_ended("stopped by `ergocast stop` on " + host_name()));
  EXPECT_FALSE(summary().contains("emergency_stop"));
  EXPECT_EQ(ergocast({"verify", out()}), GetParam() ? 2 : 0) << output();
}

TEST_P(Stopped, AtOnce) {
  const auto all = start_mission(endless(GetParam()));
  ASSERT_EQ(stop({"--now"}), 0) << output();
  EXPECT_TRUE(answered("all stand still")) << output();
  for (Program* program : all) EXPECT_EQ(wait_for(program->child), 0) << program->printed();
  EXPECT_EQ(summary()["result"], "stopped");
  EXPECT_TRUE(was_ended("stopped at once by `ergocast stop --now` on " + host_name()));
  expect_halt(GetParam());
  EXPECT_EQ(ergocast({"verify", out()}), GetParam() ? 2 : 0) << output();
}

TEST_P(Stopped, AtOnceWithoutACoordinator) {
  const auto all = start_mission(endless(GetParam()));
  signal_to({"ergocast-coordinator"}, SIGKILL);
  ASSERT_TRUE(moves_on());
  EXPECT_EQ(stop(), 4);
  EXPECT_TRUE(answered("no coordinator answers")) << output();
  EXPECT_TRUE(answered("ergocast stop --now")) << output();
  ASSERT_TRUE(moves_on()) << "only the coordinator obeys a stop in order";
  ASSERT_EQ(stop({"--now"}), 0) << output();
  for (Program* program : all) {
    if (program == all[2]) continue;
    EXPECT_EQ(wait_for(program->child), 0) << program->printed();
  }
  EXPECT_EQ(summary()["result"], "stopped");
  expect_halt(GetParam());
}

// The team waits for one agent, so the tick in which STOP arrives is known.
TEST_F(StopCommand, NoVehicleMovesInTheTickAfterItWasReceived) {
  constexpr Tick kWaitedFor = 100;
  hold_next("ERGOCAST_COMMAND_2", kWaitedFor);
  const auto all = start_all(endless(false));
  ASSERT_TRUE(eventually([] { return stopped(pids(agent(2))); })) << all[2]->printed();
  hold_none();
  ASSERT_EQ(stop({"--now"}), 0) << output();
  EXPECT_TRUE(answered("agent 2 did not confirm it")) << output();
  signal_to(agent(2), SIGCONT);
  EXPECT_EQ(wait_for(all[0]->child), 0);
  expect_halt(false);
  EXPECT_EQ(recorded_rows(out()).rbegin()->first, kWaitedFor)
      << "the tick that was not answered in full";
}

TEST_F(StopCommand, EndsAMissionOfALauncherWhichCallsItStopped) {
  for (const bool at_once : {false, true}) {
    std::filesystem::remove_all(out());
    Child mission = launch_endless(scenario(), {"--lcm-url", kUrl});
    ASSERT_EQ(stop(at_once ? std::vector<std::string>{"--now"} : std::vector<std::string>{}), 0)
        << output();
    EXPECT_EQ(wait_for(mission), 0) << printed();
    EXPECT_EQ(summary()["result"], "stopped") << printed();
    EXPECT_EQ(summary()["restarts"], 0) << printed();
    EXPECT_EQ(summary()["record_complete"], true);
    for (const auto& process : summary()["processes"])
      EXPECT_EQ(process["end"], "exited with code 0");
  }
}

TEST_F(StopCommand, ALauncherEndsAMissionWhoseCoordinatorIsFrozen) {
  Child mission = launch_endless(scenario());
  signal_to({"ergocast-coordinator"}, SIGSTOP);
  mission.send(SIGINT);
  EXPECT_TRUE(logs("sim", "finished at tick")) << printed();
  signal_to({"ergocast-coordinator"}, SIGCONT);
  EXPECT_EQ(wait_for(mission), 0) << printed();
  EXPECT_EQ(summary()["result"], "stopped");
}

TEST_F(StopCommand, NeedsTheCoordinatorsKeyIfTheTeamHasOne) {
  const std::string name = folder_ / "team", team = name + ".key",
                    coordinator = name + ".coordinator.key";
  ASSERT_EQ(ergocast({"keygen", name}), 0) << output();
  std::filesystem::create_directory(out());
  hand("ergocast-logger", {"--out", out(), "--key-file", team});
  Program& sim = hand("ergocast-sim", {"--key-file", team});
  hand("ergocast-coordinator", {endless(false), "--run-id", "ab", "--key-file", coordinator});
  for (const char* id : {"0", "1", "2", "3"})
    hand("ergocast-agent", {"--id", id, "--key-file", team});
  ASSERT_TRUE(recorded(30000)) << sim.printed();
  for (const bool at_once : {false, true}) {
    std::vector<std::string> how{"--run-id", "ab"};
    if (at_once) how.push_back("--now");
    EXPECT_EQ(stop(how), 4);
    EXPECT_TRUE(answered("has a mission key: give it with --key-file")) << output();
    how.insert(how.end(), {"--key-file", team});
    EXPECT_EQ(stop(how), 2);
    EXPECT_TRUE(answered("cannot begin or end missions")) << output();
    EXPECT_TRUE(moves_on()) << "no process obeys without the coordinator's key";
  }
  ASSERT_EQ(stop({"--now", "--key-file", coordinator}), 0) << output();
  EXPECT_EQ(wait_for(sim.child), 0) << sim.printed();
  EXPECT_TRUE(sim.prints("stopped at once")) << sim.printed();
}

TEST_F(StopCommand, WithoutATeamNamesWhatToCheck) {
  EXPECT_EQ(stop({"--now"}), 4);
  EXPECT_TRUE(answered("no message of any run arrived on ")) << output();
  EXPECT_EQ(stop({"--now", "--run-id", "b2"}), 4);
  EXPECT_TRUE(answered("no message of run 00000000000000b2 arrived on ")) << output();
}

/// Coordinators of two runs send until `done`.
void two_runs_speak_until(const std::function<bool()>& done) {
  Stranger stranger("udpm://239.255.76.67:24700?ttl=0");
  ASSERT_TRUE(eventually([&] {
    for (const RunId run : {0xa1, 0xb2}) {
      TeamStatus team;
      team.header = {run, kCoordinator, run, 0, 7};
      stranger.send(Bus::kSwarm, team);
    }
    return done();
  }));
}

TEST_F(StopCommand, OfSeveralRunsOnOneUrlEndsNoneInOrder) {
  Program& undecided = hand("ergocast", {"stop"});
  two_runs_speak_until([&] { return !undecided.child.running(); });
  EXPECT_EQ(wait_for(undecided.child), 2) << undecided.printed();
  EXPECT_TRUE(undecided.prints("--run-id 00000000000000a1")) << undecided.printed();
  EXPECT_TRUE(undecided.prints("--run-id 00000000000000b2")) << undecided.printed();
}

TEST_F(StopCommand, InAnEmergencyStopsAllRunsThatItFinds) {
  Program& decided = hand("ergocast", {"stop", "--now"});
  two_runs_speak_until([&] { return decided.printed().find("stopping") != std::string::npos; });
  EXPECT_TRUE(decided.prints("run 00000000000000a1: stopping all vehicles at once"));
  EXPECT_TRUE(decided.prints("run 00000000000000b2: stopping all vehicles at once"));
  EXPECT_EQ(wait_for(decided.child), 4) << decided.printed();
  EXPECT_TRUE(decided.prints("none came from a world or driver"))
      << "so the state of vehicles is unknown";
}

// An attacker with recordings of many runs of the same key cannot hide another run behind them.
TEST_F(StopCommand, InAnEmergencySendsAlsoToMoreRunsThanItCanWatch) {
  std::set<RunId> reached;
  const auto listener =
      Transport::open(LcmUrl::parse(kUrl).value(), 0, {}, {kTypes<Stop>},
                      {.on_message = [&](const Message& stop, Bus,
                                         AgentId) { reached.insert(header_of(stop).run); }})
          .value();
  Stranger stranger(kUrl);
  Program& decided = hand("ergocast", {"stop", "--now"});
  ASSERT_TRUE(eventually([&] {
    for (RunId run = 1; run <= 20; ++run) {
      TeamStatus team;
      team.header = {run, kCoordinator, run, 0, 7};
      stranger.send(Bus::kSwarm, team);
    }
    listener->deliver_until(now(), -1);
    return reached.size() == 20;
  }));
  EXPECT_EQ(wait_for(decided.child), 4) << decided.printed();
  EXPECT_TRUE(decided.prints("more than 16 runs were found")) << decided.printed();
}

TEST_F(StopCommand, InAnEmergencyDoesNotReportThatVehiclesStandWhoseWorldIsSilent) {
  start_mission(endless(true));
  signal_to({"ergocast-sim"}, SIGSTOP);
  EXPECT_EQ(stop({"--now"}), 4) << output();
  EXPECT_TRUE(answered("look at them")) << output();
  signal_to({"ergocast-sim"}, SIGCONT);
}

}  // namespace
}  // namespace ergocast::test
