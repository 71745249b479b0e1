// SPDX-License-Identifier: BSD-3-Clause
// The main use: a mission as real processes over real LCM.
#include <algorithm>
#include <sstream>

#include "tests/process/support/programs.h"

namespace ergocast::test {
namespace {

using MissionRun = OwnHost;

std::size_t lines(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

TEST_F(MissionRun, DefaultScenarioLeavesACompleteRecordThatIsTheSimulationsByteForByte) {
  const auto scenario = scenario_file("quadrimodal_corners").string();
  ASSERT_EQ(ergocast({"run", scenario, "--duration", "100", "--out", out()}), 0) << output();
  ASSERT_EQ(ergocast({"simulate", scenario, "--duration", "100", "--out", folder_ / "simulated"}),
            0)
      << output();
  const std::string recorded = text_of(out() / "trajectory.csv");
  EXPECT_EQ(lines(recorded), 1U + 4 * 1000);
  EXPECT_TRUE(recorded == text_of(folder_ / "simulated" / "trajectory.csv"));

  EXPECT_EQ(ergocast({"verify", out()}), 0) << output();
  EXPECT_NE(output().find("identical"), std::string::npos) << output();
  EXPECT_EQ(lines(text_of(out() / "metrics.csv")), 1U + 101);
  const auto facts = summary();
  EXPECT_EQ(facts["result"], "done");
  EXPECT_EQ(facts["ticks"], 1000);
  EXPECT_EQ(facts["mode"], "lockstep");
  EXPECT_EQ(facts["restarts"], 0);
  EXPECT_EQ(facts["record_complete"], true);
  EXPECT_EQ(facts["agents"].size(), 4U);
  EXPECT_LT(facts["ergodic_metric"]["last"], facts["ergodic_metric"]["first"]);
  for (const char* name :
       {"scenario.textproto", "plan.binpb", "events-000.lcm", "report.html", "log/agent-3.log",
        "log/sim.log", "log/coordinator.log", "log/logger.log"}) {
    EXPECT_GT(std::filesystem::file_size(out() / name), 0U) << name;
  }
  EXPECT_FALSE(std::filesystem::exists(out() / "figures"));
}

TEST_F(MissionRun, RecordedScenarioRunsAgainToTheSameTrajectory) {
  ASSERT_EQ(ergocast({"run", scenario_file("paper_fig2b").string(), "--duration", "20", "--seed",
                      "9", "--out", out()}),
            0)
      << output();
  ASSERT_EQ(ergocast({"simulate", out() / "scenario.textproto", "--out", folder_ / "again"}), 0)
      << output();
  EXPECT_TRUE(text_of(out() / "trajectory.csv") == text_of(folder_ / "again" / "trajectory.csv"));
}

TEST_F(MissionRun, WarnsOfLateCommandsWithTheRemedy) {
  // Every machine is sometimes late at ten thousand ticks a second.
  Child mission =
      start("ergocast", {"run", scenario_file("quadrimodal_corners"), "--out", out(),
                         "--realtime=1000", "--duration", "10000000", "--event-log-limit", "128"});
  const auto log = log_;
  ASSERT_TRUE(eventually([&] { return text_of(log).find("warning: ") != std::string::npos; }))
      << text_of(log);
  mission.send(SIGINT);
  EXPECT_EQ(wait_for(mission), 0) << text_of(log);
  const std::string printed = text_of(log);
  EXPECT_NE(
      printed.find(" % of the commands came too late for their tick, and vehicles went on with "
                   "older ones: this machine or the network is too slow. Choose a smaller "
                   "--realtime factor"),
      std::string::npos)
      << printed;
  EXPECT_EQ(printed.find("warning: "), printed.rfind("warning: ")) << "once";
}

// Agents get the coefficients with the plan; the report gets a picture with the record.
TEST_F(MissionRun, OfAMapIsVerifiedAndReportedWithoutTheMap) {
  const auto shipped = scenario_file("lake_search").parent_path();
  std::filesystem::create_directories(folder_ / "maps");
  std::filesystem::copy(shipped / "maps" / "lake.png", folder_ / "maps");
  std::filesystem::copy(shipped / "lake_search.textproto", folder_);
  ASSERT_EQ(
      ergocast({"run", folder_ / "lake_search.textproto", "--duration", "10", "--out", out()}), 0)
      << output();
  const std::string report = text_of(out() / "report.html");
  std::filesystem::remove_all(folder_ / "maps");
  EXPECT_EQ(ergocast({"verify", out()}), 0) << output();
  std::filesystem::remove(out() / "report.html");
  EXPECT_EQ(ergocast({"report", out()}), 0) << output();
  EXPECT_TRUE(text_of(out() / "report.html") == report);
}

TEST_F(MissionRun, SeventeenAgentsFillTwoWorldStatesATick) {
  const auto scenario = scenario_file("quadrimodal_corners").string();
  ASSERT_EQ(ergocast({"run", scenario, "--duration", "5", "--agents", "17", "--out", out()}), 0)
      << output();
  EXPECT_EQ(lines(text_of(out() / "trajectory.csv")), 1U + 17 * 50);
  EXPECT_EQ(ergocast({"verify", out()}), 0) << output();
}

// Eighteen agents, whose positions come in two parts. Broadcasts are frequent or rare, rarer for
// high modes, with or without dead reckoning, in doubles or in 16 bits.
TEST_F(MissionRun, IsItsSimulationHoweverItsAgentsKnowOfEachOther) {
  std::vector<std::string> trajectories;
  for (const std::string telling :
       {"agents { dead_reckoning: true", "agents { dead_reckoning: false"}) {
    for (const std::string period :
         {"1", "7", "7 contribution_encoding: FIXED16", "7 high_mode_period_factor: 3"}) {
      std::string text = text_of(scenario_file("quadrimodal_corners"));
      text.replace(text.find("time {"), 6, "time { broadcast_period_ticks: " + period);
      text.replace(text.find("agents {"), 8, telling);
      const auto folder = folder_ / std::to_string(trajectories.size());
      std::filesystem::create_directories(folder);
      std::ofstream(folder / "telling.textproto") << text;
      ASSERT_EQ(ergocast({"run", folder / "telling.textproto", "--duration", "5", "--agents", "18",
                          "--out", folder / "run"}),
                0)
          << output();
      trajectories.push_back(text_of(folder / "run" / "trajectory.csv"));
      EXPECT_EQ(lines(trajectories.back()), 1U + 18 * 50);
      EXPECT_EQ(ergocast({"verify", folder / "run"}), 0) << output();
      EXPECT_NE(output().find("identical"), std::string::npos) << output();
    }
  }
  EXPECT_TRUE(trajectories[0] == trajectories[1]) << "what is reckoned needs no telling";
  EXPECT_TRUE(trajectories[0] == trajectories[3]) << "nor do high modes";
  EXPECT_FALSE(trajectories[4] == trajectories[5]);
  EXPECT_FALSE(trajectories[5] == trajectories[7]) << "high modes are late";
  for (const std::size_t exact : {1, 5}) {
    EXPECT_FALSE(trajectories[exact] == trajectories[exact + 1]) << "16 bits are rounded";
  }
}

TEST_F(MissionRun, VerifyNamesTheFirstTickAndAgentThatDiffer) {
  ASSERT_EQ(ergocast({"simulate", scenario_file("quadrimodal_corners").string(), "--duration", "10",
                      "--out", out()}),
            0)
      << output();
  EXPECT_EQ(ergocast({"verify", out()}), 0) << output();
  std::string table = text_of(out() / "trajectory.csv");
  const auto row = table.find("\n42,");
  const auto second = table.find("\n42,", row + 1);
  const auto end = table.find('\n', second + 1);
  table[end - 1] = table[end - 1] == '1' ? '2' : '1';
  std::ofstream(out() / "trajectory.csv", std::ios::binary) << table;
  EXPECT_EQ(ergocast({"verify", out()}), 1);
  EXPECT_NE(output().find("first at tick 42, agent 1"), std::string::npos) << output();
}

TEST_F(MissionRun, RealTimeKeepsTheClockAndCountsWhatItMissed) {
  ASSERT_EQ(ergocast({"run", scenario_file("quadrimodal_corners").string(), "--duration", "20",
                      "--realtime=10", "--out", out()}),
            0)
      << output();
  const auto facts = summary();
  EXPECT_EQ(facts["result"], "done");
  EXPECT_EQ(facts["mode"], "realtime");
  EXPECT_EQ(facts["realtime_factor"], 10);
  EXPECT_TRUE(facts["missed_deadlines"].is_number());
  EXPECT_TRUE(facts["skipped_ticks"].is_number());
  EXPECT_LE(facts["ticks"], 200);
  EXPECT_EQ(ergocast({"verify", out()}), 2);
  EXPECT_NE(output().find("real time"), std::string::npos) << output();
}

TEST_F(MissionRun, EventsReplayWithLcmLogplayer) {
  const std::string url = "udpm://239.255.76.67:24500?ttl=0";
  ASSERT_EQ(ergocast({"run", scenario_file("quadrimodal_corners").string(), "--duration", "3",
                      "--out", out()}),
            0)
      << output();
  // A second logger records the replay and must make the same record.
  const auto again = folder_ / "again";
  std::filesystem::create_directory(again);
  const std::string run_id = summary()["run_id"];
  Child listener = start("ergocast-logger", {"--out", again, "--lcm-url", url, "--run-id", run_id});
  const auto log = log_;
  ASSERT_TRUE(eventually([&] { return text_of(log).find("recording") != std::string::npos; }));
  Child player = begin({"/usr/bin/lcm-logplayer", "--lcm-url=" + url, "--speed=0.5",
                        (out() / "events-000.lcm").string()});
  EXPECT_EQ(wait_for(player), 0) << output();
  listener.send(SIGTERM);
  EXPECT_EQ(wait_for(listener), 0) << text_of(log);
  const auto replayed = nlohmann::json::parse(text_of(again / "summary.json"));
  EXPECT_EQ(replayed["run_id"], run_id);
  EXPECT_EQ(replayed["scenario_hash"], summary()["scenario_hash"]);
  EXPECT_EQ(replayed["agents"].size(), 4U);
}

TEST_F(MissionRun, AnAgentNeedsNoMoreThanThirtyMegabytes) {
  if (std::getenv("ERGOCAST_BIN_DIR") != nullptr) {
    GTEST_SKIP() << "the programs are of another build, whose memory is not ours to judge";
  }
  Child mission =
      start("ergocast", {"run", scenario_file("quadrimodal_corners").string(), "--duration",
                         "10000000", "--event-log-limit", "128", "--out", out()});
  ASSERT_TRUE(recorded(100000)) << output();
  int agents = 0;
  for (const auto& process : std::filesystem::directory_iterator("/proc")) {
    std::istringstream command(text_of(process.path() / "cmdline"));
    std::string program;
    std::getline(command, program, '\0');
    if (!program.ends_with("/ergocast-agent")) continue;
    const std::string status = text_of(process.path() / "status");
    const auto peak = status.find("VmHWM:");
    ASSERT_NE(peak, std::string::npos);
    EXPECT_LE(std::stol(status.substr(peak + 6)), 30 * 1024) << "kB";
    ++agents;
  }
  EXPECT_GE(agents, 4);
  mission.send(SIGTERM);
  EXPECT_EQ(wait_for(mission), 0) << output();
}

TEST_F(MissionRun, StartsAnotherProgramInTheWorldsPlace) {
  ASSERT_EQ(ergocast({"run", scenario_file("paper_fig1a"), "--realtime=20", "--duration", "20",
                      "--world", "ergocast-example-driver", "--out", out()}),
            0)
      << output();
  EXPECT_TRUE(std::filesystem::exists(out() / "log/world.log"));
  EXPECT_FALSE(std::filesystem::exists(out() / "log/sim.log"));
  // The driver refuses lockstep and reports it.
  EXPECT_EQ(ergocast({"run", scenario_file("paper_fig1a"), "--lockstep", "--world",
                      (program_folder() / "ergocast-example-driver").string(), "--out",
                      out().string() + "-2"}),
            4);
  EXPECT_NE(output().find("lockstep"), std::string::npos) << output();
  EXPECT_EQ(ergocast({"run", scenario_file("paper_fig1a"), "--world", "./no-such-program"}), 2);
  EXPECT_NE(output().find("--world ./no-such-program: there is no program"), std::string::npos)
      << output();
}

TEST_F(MissionRun, CompressesFinishedSegmentsWhereItIsAskedTo) {
  // Every tick writes about 45 kB, so the first 64 MiB take some 1500 ticks.
  ASSERT_EQ(ergocast({"run", scenario_file("paper_fig1a"), "--agents", "16", "--duration", "200",
                      "--event-log-zstd", "--out", out()}),
            0)
      << output();
  EXPECT_FALSE(std::filesystem::exists(out() / "events-000.lcm"));
  EXPECT_TRUE(std::filesystem::exists(out() / "events-001.lcm")) << "not finished before the end";
}

}  // namespace
}  // namespace ergocast::test
