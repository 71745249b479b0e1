// SPDX-License-Identifier: BSD-3-Clause
// The table of modes of a free domain: `ergocast run` passes it to its processes, and the record
// has it. A process that got none, or another one, computes it. A process that computes another
// table cannot take part. Every output of φ² of such a mission names its basis.
#include "tests/process/support/free_rooms.h"
#include "tests/process/support/mission.h"

namespace ergocast::test {
namespace {

const std::string kFreeModes = "modes of the free domain";
const std::string kInFreeModes = " in " + kFreeModes;

class TablesOfModes : public ByHand {
 protected:
  std::filesystem::path two_rooms(const std::string& more = "", int more_agents = 0) {
    return free_rooms(folder_, more, more_agents);
  }
  /// The table in a folder, empty if there is none.
  static std::filesystem::path table_in(const std::filesystem::path& folder) {
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
      if (entry.path().filename().string().starts_with("modes-")) return entry.path();
    }
    return {};
  }
  /// The mission's table as computed by another computer, which rounds a number differently.
  std::filesystem::path table_of_another_computer() {
    EXPECT_EQ(ergocast({"simulate", two_rooms(), "--out", out()}), 0) << output();
    std::string bytes = text_of(table_in(out()));
    bytes[bytes.size() / 2 / 80 * 80] ^= 1;
    std::ofstream(folder_ / "other.bin", std::ios::binary) << bytes;
    return folder_ / "other.bin";
  }
  /// Whether that process reads the table that it got; a process that computes it does not.
  bool shares_the_table(const std::vector<std::string>& words) const {
    const auto process = pids(words);
    if (process.size() != 1) return false;
    const std::string maps = text_of("/proc/" + std::to_string(process[0]) + "/maps");
    return maps.find(table_in(out()).filename()) != std::string::npos;
  }
  /// Like agent(), for numbers with several digits.
  static std::vector<std::string> just_agent(int id) {
    return {"ergocast-agent", "--id " + std::to_string(id) + ' '};
  }
  /// Starts the process again by killing it.
  void restart(const std::vector<std::string>& words, const std::string& name) {
    kill_next(words);
    ASSERT_TRUE(eventually([&] { return printed(name + ": restarted (1 of 3)"); })) << printed();
  }
  void end(Child& mission) {
    mission.send(SIGTERM);
    EXPECT_EQ(wait_for(mission), 0) << printed();
  }
};

TEST_F(TablesOfModes, ALoggerThatWasStartedByHandWritesItBesideTheRecord) {
  std::filesystem::create_directory(out());
  Program& logger = hand("ergocast-logger", {"--out", out()});
  hand("ergocast-sim");
  for (const char* id : {"0", "1"}) hand("ergocast-agent", {"--id", id});
  Program& coordinator = hand("ergocast-coordinator", {two_rooms()});
  EXPECT_EQ(wait_for(coordinator.child), 0) << coordinator.printed();
  EXPECT_EQ(wait_for(logger.child), 0) << logger.printed();
  EXPECT_FALSE(table_in(out()).empty());
  EXPECT_EQ(ergocast({"verify", out()}), 0) << output();
}

TEST_F(TablesOfModes, ARestartedAgentIsHandedItAgain) {
  Child mission = launch_endless(two_rooms());
  ASSERT_FALSE(table_in(out()).empty());
  EXPECT_TRUE(shares_the_table(agent(1))) << printed();
  kill_next(agent(1));
  ASSERT_TRUE(logs("agent-1", ": running", 2)) << printed();
  EXPECT_TRUE(shares_the_table(agent(1))) << printed();
  ASSERT_TRUE(moves_on()) << printed();
  end(mission);
}

TEST_F(TablesOfModes, ARestartedLoggerIsHandedItAgain) {
  const std::vector<std::string> logger{"ergocast-logger"};
  Child mission = launch_endless(two_rooms());
  EXPECT_TRUE(shares_the_table(logger)) << printed();
  restart(logger, "logger");
  EXPECT_TRUE(eventually([&] { return shares_the_table(logger); })) << printed();
  ASSERT_TRUE(moves_on()) << printed();
  end(mission);
}

TEST_F(TablesOfModes, SixtyFourAgentsOfAHostShareIt) {
  constexpr int kAgents = 64;
  Child mission = launch_endless(two_rooms("", kAgents - 2));
  for (int id = 0; id < kAgents; ++id) EXPECT_TRUE(shares_the_table(just_agent(id))) << id;
  end(mission);
}

TEST_F(TablesOfModes, AProcessThatComputesAnotherOneStaysOutAndNamesTheFile) {
  const auto other = table_of_another_computer();
  Program& equipped = hand("ergocast-agent", {"--id", "0", "--modes", other});
  Program& bare = hand("ergocast-agent", {"--id", "1"});
  hand("ergocast-coordinator", {two_rooms(), "--modes", other});
  EXPECT_EQ(wait_for(bare.child), 4) << bare.printed();
  EXPECT_TRUE(bare.prints("start it with --modes and that table's file, modes-")) << bare.printed();
  EXPECT_TRUE(equipped.prints("admitted")) << equipped.printed();
  EXPECT_TRUE(equipped.child.running()) << equipped.printed();
}

TEST_F(TablesOfModes, ALoggerThatComputesAnotherOneStaysOut) {
  const auto other = table_of_another_computer();
  const auto record = folder_ / "record";
  std::filesystem::create_directory(record);
  Program& logger = hand("ergocast-logger", {"--out", record});
  hand("ergocast-coordinator", {two_rooms(), "--modes", other});
  EXPECT_EQ(wait_for(logger.child), 4) << logger.printed();
  EXPECT_TRUE(logger.prints("start it with --modes and that table's file, modes-"))
      << logger.printed();
  EXPECT_TRUE(std::filesystem::is_empty(record)) << logger.printed();
}

// The file may have been lost or changed after it was named.
TEST_F(TablesOfModes, AProcessThatIsHandedAnotherOneOrNoneComputesIt) {
  const auto other = table_of_another_computer(), damaged = folder_ / "damaged.bin";
  std::ofstream(damaged) << text_of(other).substr(0, 5000);
  Program& missing = hand("ergocast-agent", {"--id", "0", "--modes", folder_ / "missing.bin"});
  Program& cut = hand("ergocast-agent", {"--id", "1", "--modes", damaged});
  Program& wrong = hand("ergocast-agent", {"--id", "2", "--modes", other});
  hand("ergocast-coordinator", {two_rooms("", 1)});
  EXPECT_TRUE(missing.prints("missing.bin: cannot be read as a table of modes; it is computed"))
      << missing.printed();
  EXPECT_TRUE(cut.prints("damaged.bin: it is no table of modes, or a damaged one; it is computed"))
      << cut.printed();
  for (const Program* agent : {&missing, &cut, &wrong})
    EXPECT_TRUE(agent->prints("admitted")) << agent->printed();
}

TEST_F(TablesOfModes, ThePrintedAndRecordedMetricsNameTheirBasis) {
  for (const std::string command : {"run", "simulate"}) {
    std::filesystem::remove_all(out());
    ASSERT_EQ(ergocast({command, two_rooms("goal_ergodic_metric: 0.125"), "--out", out()}), 0)
        << output();
    EXPECT_TRUE(answered(", in the modes of the free domain\n            ")) << output();
    EXPECT_TRUE(answered(" in cosines\n")) << output();
    EXPECT_TRUE(answered("  goal      0.125 in the modes of the free domain, not reached\n"))
        << output();
    const auto all = summary();
    for (const char* key : {"ergodic_metric", "goal", "conventions"})
      EXPECT_EQ(all[key]["basis"], kFreeModes) << key;
    ASSERT_TRUE(all["ergodic_metric_in_cosines"]["last"].is_number());
    EXPECT_NE(all["ergodic_metric_in_cosines"]["last"], all["ergodic_metric"]["last"]);
    ASSERT_EQ(all["agents"].size(), 2U);
    for (const auto& one : all["agents"]) EXPECT_EQ(one["ergodic_metric_basis"], kFreeModes) << one;
  }
}

TEST_F(TablesOfModes, StatusNamesTheBasis) {
  Child mission = launch_endless(two_rooms());
  ergocast({"status"});
  EXPECT_TRUE(answered(" in modes of the free domain (median)")) << output();
  end(mission);
}

TEST_F(TablesOfModes, TrialsNameTheBasis) {
  const auto table = folder_ / "trials.csv";
  ASSERT_EQ(ergocast({"simulate", two_rooms(), "--seeds", "1:2", "--out", table}), 0) << output();
  const std::string rows = text_of(table);
  EXPECT_TRUE(rows.substr(0, rows.find('\n')).ends_with(",basis")) << rows;
  EXPECT_TRUE(rows.ends_with(',' + kFreeModes + '\n')) << rows;
  const auto greatest = output().find("greatest phi^2 at the end");
  ASSERT_NE(greatest, std::string::npos) << output();
  EXPECT_TRUE(output().substr(0, output().find('\n', greatest)).ends_with(kInFreeModes))
      << output();
  const auto goal = two_rooms("goal_ergodic_metric: 0.125");
  ASSERT_EQ(ergocast({"simulate", goal, "--seeds", "1"}), 4) << output();
  EXPECT_TRUE(answered(" > 0.125" + kInFreeModes + '\n')) << output();
}

TEST_F(TablesOfModes, ExportedMetricsNameTheBasis) {
  ASSERT_EQ(ergocast({"simulate", two_rooms(), "--out", out()}), 0) << output();
  ASSERT_EQ(ergocast({"export", out(), "--to", "csv"}), 0) << output();
  const std::string rows = text_of(out() / "export" / "metrics.csv");
  EXPECT_TRUE(rows.substr(0, rows.find('\n')).ends_with(",basis")) << rows;
  EXPECT_TRUE(rows.ends_with(',' + kFreeModes + '\n')) << rows;
}

}  // namespace
}  // namespace ergocast::test
