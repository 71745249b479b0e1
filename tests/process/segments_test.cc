// SPDX-License-Identifier: BSD-3-Clause
// A record in several segments, as left by a logger that was killed and restarted.
#include "runtime/record/event_log.h"
#include "tests/process/support/programs.h"

namespace ergocast::test {
namespace {

class Segments : public OwnHost {
 protected:
  void write(const std::string& file, const std::string& text) const {
    std::ofstream(out() / file, std::ios::binary) << text;
  }
  /// Simulates 100 ticks of four agents, then splits the trajectory before `second` and lets its
  /// first part end before `first_end`. The metrics are split likewise; their second part is still
  /// empty.
  void split(const std::string& first_end, const std::string& second) {
    ASSERT_EQ(ergocast({"simulate", scenario_file("quadrimodal_corners"), "--duration", "10",
                        "--out", out()}),
              0)
        << output();
    const std::string table = text_of(out() / "trajectory.csv");
    const auto end = table.find('\n' + first_end) + 1, begin = table.find('\n' + second) + 1;
    write("trajectory.csv", table.substr(0, end) + table.substr(end, 7));
    write("trajectory-001.csv", table.substr(0, table.find('\n') + 1) + table.substr(begin));
    const std::string metrics = text_of(out() / "metrics.csv");
    write("metrics.csv", metrics.substr(0, metrics.find('\n' + first_end.substr(0, 3)) + 1));
    write("metrics-001.csv", metrics.substr(0, metrics.find('\n') + 1));
  }
  /// The record of a logger that was killed and not restarted: no summary and no drawing.
  void forget_the_end() {
    std::filesystem::remove(out() / "summary.json");
    std::filesystem::remove(out() / "report.html");
    std::filesystem::remove_all(out() / "figures");
  }
  bool printed(const std::string& part) const { return output().find(part) != std::string::npos; }
};

TEST_F(Segments, VerifyReadsThemAsOneTable) {
  split("40,", "40,");
  forget_the_end();
  EXPECT_EQ(ergocast({"verify", out()}), 0) << output();
  EXPECT_TRUE(printed("identical") && printed("up to tick 99")) << output();
  EXPECT_FALSE(printed("missing")) << output();
}

TEST_F(Segments, VerifyCountsTheTicksBetweenThem) {
  split("40,4,2,", "47,");
  forget_the_end();
  EXPECT_EQ(ergocast({"verify", out()}), 0) << output();
  EXPECT_TRUE(printed("7 ticks") && printed("missing")) << output();
}

TEST_F(Segments, VerifyFindsADifferenceBehindAGap) {
  split("40,", "47,");
  std::string table = text_of(out() / "trajectory-001.csv");
  const auto end = table.find('\n', table.find("\n52,") + 1);
  table[end - 1] = table[end - 1] == '1' ? '2' : '1';
  write("trajectory-001.csv", table);
  EXPECT_EQ(ergocast({"verify", out()}), 1);
  EXPECT_TRUE(printed("first at tick 52, agent 0")) << output();
}

TEST_F(Segments, VerifyFindsARowThatIsThereTwice) {
  split("40,", "39,");
  EXPECT_EQ(ergocast({"verify", out()}), 1);
  EXPECT_TRUE(printed("first at tick 40, agent 0")) << output();
}

TEST_F(Segments, VerifyFindsThatTheEndIsMissing) {
  split("40,", "47,");
  const std::string table = text_of(out() / "trajectory-001.csv");
  write("trajectory-001.csv", table.substr(0, table.find("\n80,") + 1));
  EXPECT_EQ(ergocast({"verify", out()}), 1);
  EXPECT_TRUE(printed("ends after tick 79")) << output();
}

TEST_F(Segments, TheEventLogBeginsWithTheFirstFreeNumber) {
  for (const char* old : {"events-000.lcm", "events-001.lcm"})
    std::ofstream(folder_ / old) << "torn";
  EventLog log(folder_);
  log.write("CHANNEL", {});
  EXPECT_EQ(log.flush(), std::nullopt);
  EXPECT_EQ(text_of(folder_ / "events-000.lcm"), "torn");
  EXPECT_EQ(text_of(folder_ / "events-001.lcm"), "torn");
  EXPECT_GT(std::filesystem::file_size(folder_ / "events-002.lcm"), 0U);
  log.discard();
  EXPECT_FALSE(std::filesystem::exists(folder_ / "events-002.lcm"));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "events-001.lcm"));
}

TEST_F(Segments, ALoggerThatReceivesNoMissionLeavesTheRecordAsItWas) {
  split("40,", "40,");
  const std::string summary_before = text_of(out() / "summary.json");
  Child logger = start("ergocast-logger", {"--out", out(), "--resume", "--lcm-url",
                                           "udpm://239.255.76.67:24800?ttl=0"});
  ASSERT_TRUE(eventually([this] { return printed("recording"); })) << output();
  logger.send(SIGTERM);
  EXPECT_EQ(wait_for(logger), 0) << output();
  EXPECT_EQ(text_of(out() / "summary.json"), summary_before);
  EXPECT_FALSE(std::filesystem::exists(out() / "trajectory-002.csv"));
}

TEST_F(Segments, ALoggerRefusesToGoOnWithARecordWhosePlanCannotBeRead) {
  split("40,", "40,");
  for (const bool damaged : {false, true}) {
    std::filesystem::remove(out() / "plan.binpb");
    if (damaged) write("plan.binpb", "no plan");
    EXPECT_EQ(run("ergocast-logger",
                  {"--out", out(), "--resume", "--lcm-url", "udpm://239.255.76.67:24800?ttl=0"}),
              2);
    EXPECT_TRUE(printed("plan.binpb: missing or not readable")) << output();
    EXPECT_FALSE(std::filesystem::exists(out() / "trajectory-002.csv"));
    EXPECT_FALSE(std::filesystem::exists(out() / "events-000.lcm"));
  }
}

TEST_F(Segments, ALoggerRefusesToGoOnWithTheRecordOfAnotherMission) {
  split("40,", "40,");
  const std::string url = "udpm://239.255.76.67:24800?ttl=0";
  Child coordinator =
      start("ergocast-coordinator", {"--lcm-url", url, scenario_file("paper_fig2b")});
  Child logger = start("ergocast-logger", {"--out", out(), "--resume", "--lcm-url", url});
  EXPECT_EQ(wait_for(logger), 2) << output();
  EXPECT_TRUE(printed("of another mission")) << output();
  EXPECT_FALSE(std::filesystem::exists(out() / "trajectory-002.csv"));
  EXPECT_FALSE(std::filesystem::exists(out() / "events-000.lcm"));
  coordinator.send(SIGTERM);
  wait_for(coordinator);
}

}  // namespace
}  // namespace ergocast::test
