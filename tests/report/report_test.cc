// SPDX-License-Identifier: BSD-3-Clause
// The report of a run: its values are read back from its page, which is self-contained and small.
#include "report/report.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <regex>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "logger/recorder.h"
#include "logger/slope.h"
#include "report/base64.h"
#include "report/markup.h"
#include "report/target_density.h"
#include "report/track_grid.h"
#include "target/target.h"
#include "tests/support/temp_folder.h"

namespace ergocast {
namespace {

namespace fs = std::filesystem;

constexpr const char* kHostile = "<script>alert(\"x\")</script> & ']]>\x01";
std::string read(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

void write(const fs::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
}

/// A run directory of its own, with the mission it belongs to.
class Report : public testing::Test {
 protected:
  Report() {
    mission.name = "two circles";
    mission.seed = 18446744073709551615u;
    mission.domain.size_m = {2000, 1000, 0};
    mission.basis.modes_x = 8;
    mission.basis.modes_y = 6;
    mission.law.u_max_mps = 10;
    mission.timing.tick_count = 1000;
    cover({{{1, {500, 500, 0}, Eigen::Matrix3d::Identity() * 1e4}}, 0});
  }

  void cover(const TargetDensity& target) {
    mission.target_coefficients = target_coefficients(target, mission.domain, mission.basis).values;
  }

  /// Agents on noisy circles, φ² falling like 1/t.
  void record(int agents, int ticks) {
    std::ostringstream track, metrics;
    track << kTrajectoryHeader << '\n';
    metrics << kMetricsHeader << '\n';
    track.precision(17);
    for (int tick = 0; tick < ticks; ++tick) {
      const double t_s = 0.1 * tick;
      for (int agent = 0; agent < agents; ++agent) {
        const double angle = 0.02 * tick + agent, radius = 300 + 60 * std::sin(0.37 * tick);
        track << tick << ',' << t_s << ',' << agent << ',' << 900 + radius * std::cos(angle) << ','
              << 500 + radius * std::sin(angle) << ',' << 10 * std::cos(angle) << ",0\n";
      }
      if (tick % 10 == 0) {
        metrics << tick << ',' << t_s << ',' << 1 / (1 + t_s) << ",0.25,0,0.1," << tick << ",0,0\n";
      }
    }
    write(dir / "trajectory.csv", track.str());
    write(dir / "metrics.csv", metrics.str());
  }

  std::optional<std::string> report() { return write_report(dir, mission, nullptr); }
  std::string page() { return read(dir / "report.html"); }

  /// The data in the page.
  nlohmann::json data() {
    const std::string html = page(), begin = "<script type=\"application/json\" id=\"data\">";
    const auto at = html.find(begin) + begin.size();
    return nlohmann::json::parse(html.substr(at, html.find("</script>", at) - at));
  }

  void expect_sound() { EXPECT_TRUE(data()["record"]["mission"].is_object()); }

  const test::TempFolder own;
  const fs::path& dir = own.path();
  Mission mission;
};

/// How often `part` is in `text`.
std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (auto at = text.find(part); at != text.npos; at = text.find(part, at + 1)) ++found;
  return found;
}

// What a browser makes of it: tests/page.
TEST_F(Report, HasOnePageThatLoadsNothing) {
  record(4, 1000);
  ASSERT_EQ(report(), std::nullopt);
  expect_sound();
  const std::string html =
      std::regex_replace(page(), std::regex("http://www.w3.org/(2000/svg|1999/xlink)"), "");
  for (const char* reference : {"http:", "https:", "<link", "@import", "src=", "<script>alert"}) {
    EXPECT_EQ(html.find(reference), std::string::npos) << reference;
  }
  EXPECT_EQ(count(html, "<script"), 2U);  // the data and the one script
  EXPECT_EQ(count(html, "<style"), 1U);
  EXPECT_NE(html.find("default-src 'none'; script-src 'sha256-"), std::string::npos);
  EXPECT_EQ(html.find("unsafe"), std::string::npos);
  for (const auto& entry : fs::recursive_directory_iterator(dir)) {
    EXPECT_NE(entry.path().extension(), ".tmp");
  }
}

TEST_F(Report, HasTheValuesOfTheSummaryAndNoTextEndsTheData) {
  record(2, 1000);
  mission.name = kHostile;
  const std::string hostile = R"(</script><script>alert(\"x\")</script><!-- & ']]>\u0001)";
  write(dir / "summary.json", R"({"result":"failed","reason":")" + hostile +
                                  R"(","mode":"lockstep","agents":[{"id":1,"host":")" + hostile +
                                  R"(","messages_sent":4321}]})");
  ASSERT_EQ(report(), std::nullopt);
  expect_sound();
  EXPECT_EQ(count(page(), "<script"), 2U);
  EXPECT_EQ(count(page(), "</script"), 2U);
  EXPECT_EQ(page().find('\x01'), std::string::npos);
  const auto found = data()["record"];
  EXPECT_EQ(found["summary"]["reason"].get<std::string>().find("</script><script>alert"), 0U);
  EXPECT_EQ(found["summary"]["agents"][0]["messages_sent"], 4321);
  EXPECT_EQ(found["mission"]["name"], kHostile);
  EXPECT_EQ(found["mission"]["seed"], "18446744073709551615");
}

TEST_F(Report, HasTheSizesOfBodiesAndWhenAgentsGoHome) {
  mission.starts_m.assign(2, {500, 500, 0});
  record(2, 1000);
  ASSERT_EQ(report(), std::nullopt);
  for (const char* key : {"body_radius_m", "stations", "vehicles"})
    EXPECT_FALSE(data()["record"]["mission"].contains(key)) << key;
  EXPECT_FALSE(data()["record"].contains("home_from"));

  mission.separation.distance_m = 3;
  mission.kinds = {{.name = "robots", .count = 1, .u_max_mps = 10}};
  mission.kinds[0].stations_m = {{600, 500, 0}};
  mission.kinds[0].reserve_s = 20;
  ASSERT_EQ(report(), std::nullopt);
  const auto record = data()["record"];
  EXPECT_EQ(record["mission"]["body_radius_m"], 1.5);
  EXPECT_EQ(record["mission"]["u_max_mps"], 10);
  EXPECT_FALSE(record["tracks"].contains("headings"));
  EXPECT_EQ(record["mission"]["stations"],
            nlohmann::json::parse(R"([{"id": 0, "at_m": [600, 500], "rest_from": 800}])"));
  // The agent circles 330 to 610 m away and moves at 10 m/s, so it goes home 33 to 61 s before tick
  // 800.
  ASSERT_EQ(record["home_from"].size(), 1U);
  EXPECT_GT(record["home_from"]["0"], 190);
  EXPECT_LT(record["home_from"]["0"], 480);
}

TEST_F(Report, ToleratesASummaryOfOtherTypesOrWithoutKeys) {
  record(1, 100);
  for (const char* summary :
       {"{}", "[]", "null", "7", R"({"agents":{"id":1},"messages":[1]})",
        R"({"agents":[null,7,{"id":[]}],"result":3,"mode":null})",
        R"({"ticks_per_s":null,"wall_time_s":"x","messages":{"refused":[]}})"}) {
    write(dir / "summary.json", summary);
    EXPECT_EQ(report(), std::nullopt) << summary;
    EXPECT_TRUE(data().is_object()) << summary;
  }
}

TEST_F(Report, NamesASummaryThatIsNotJson) {
  record(1, 100);
  write(dir / "summary.json", "{\"result\":\n\"do");
  const auto problem = report();
  ASSERT_TRUE(problem);
  EXPECT_NE(problem->find("summary.json"), std::string::npos) << *problem;
  EXPECT_NE(problem->find("line 2"), std::string::npos) << *problem;
}

TEST_F(Report, EmptyRunHasAReport) {
  record(0, 0);
  ASSERT_EQ(report(), std::nullopt);
  expect_sound();
  write(dir / "trajectory.csv", "");  // killed before the first flush
  write(dir / "metrics.csv", "");
  ASSERT_EQ(report(), std::nullopt);
  expect_sound();
}

TEST_F(Report, RunsOfAFewTicksHaveAReport) {
  for (const int ticks : {1, 2, 3, 11, 21}) {
    record(1, ticks);
    ASSERT_EQ(report(), std::nullopt) << ticks;
    expect_sound();
  }
}

TEST_F(Report, TornLastLineIsLeftOut) {
  record(2, 50);
  ASSERT_EQ(report(), std::nullopt);
  const std::string whole = page();
  write(dir / "trajectory.csv", read(dir / "trajectory.csv") + "50,5,0,1e3,12");
  write(dir / "metrics.csv", read(dir / "metrics.csv") + "50,5,0.0");
  ASSERT_EQ(report(), std::nullopt);
  EXPECT_EQ(page(), whole);
}

TEST_F(Report, SegmentsReadAsOneTable) {
  record(2, 50);
  ASSERT_EQ(report(), std::nullopt);
  const std::string whole = page();
  for (const std::string table : {"trajectory", "metrics"}) {
    const std::string text = read(dir / (table + ".csv")),
                      header = text.substr(0, text.find('\n') + 1);
    const auto first = text.find("\n20,") + 1, second = text.find("\n30,") + 1;
    write(dir / (table + ".csv"), text.substr(0, first) + "20,2,0,1");
    write(dir / (table + "-001.csv"), header + text.substr(first, second - first) + "30,3");
    write(dir / (table + "-002.csv"), header.substr(0, 9));  // killed amid its header
    write(dir / (table + "-003.csv"), header + text.substr(second));
  }
  ASSERT_EQ(report(), std::nullopt);
  EXPECT_EQ(page(), whole);
  write(dir / "trajectory-001.csv", std::string(kTrajectoryHeader) + "\n19,1.9,0,1,1,1,1\n");
  const auto problem = report();
  ASSERT_TRUE(problem);
  EXPECT_NE(problem->find("trajectory-001.csv:2: "), std::string::npos) << *problem;
}

TEST_F(Report, MalformedLineIsNamedAndNothingIsWritten) {
  const std::vector<std::string> lines = {
      "2,0.2,0,1,1,1",     "2,0.2,0,1,1,1,1,1",  "2,0.2,0,nan,1,1,1", "2,0.2,0,1e300,1,1,1",
      "2,0.2,x,1,1,1,1",   "2,0.2,1024,1,1,1,1", "2,0.2,0,1,1,1,1\r", "0,0.2,0,1,1,1,1",
      "2.5,0.2,0,1,1,1,1", "2,-1,1,1,1,1,1",     "-2,0.2,1,1,1,1,1",  ""};
  for (const std::string& line : lines) {
    record(1, 2);
    write(dir / "trajectory.csv", read(dir / "trajectory.csv") + line + "\n3,0.3,0,1,1,1,1\n");
    const auto problem = report();
    ASSERT_TRUE(problem) << line;
    EXPECT_NE(problem->find("trajectory.csv:4: "), std::string::npos) << *problem;
    EXPECT_EQ(problem->find('\n'), std::string::npos) << *problem;
    EXPECT_FALSE(fs::exists(dir / "report.html"));
  }
}

TEST_F(Report, CountsOfContributionsThatCannotBeAreNamed) {
  for (const char* counts : {"-1,0", "0.5,0", "1e30,0", "0,1e30"}) {
    record(1, 2);
    write(dir / "metrics.csv", std::string(kMetricsHeader) +
                                   "\n0,0,0.5,0,0,0,4711,0,0\n1,0.1,0.5,0,0,0," + counts + ",0\n");
    const auto problem = report();
    ASSERT_TRUE(problem) << counts;
    EXPECT_NE(problem->find("metrics.csv:3: the contributions"), std::string::npos) << *problem;
  }
}

TEST_F(Report, MissingTablesAreNamed) {
  const auto problem = report();
  ASSERT_TRUE(problem);
  EXPECT_NE(problem->find("trajectory.csv"), std::string::npos) << *problem;
}

TEST_F(Report, WhatCannotBeWrittenIsNamed) {
  record(1, 100);
  fs::create_directories(dir / "report.html" / "a folder where the file belongs");
  const auto problem = report();
  ASSERT_TRUE(problem);
  EXPECT_NE(problem->find("report.html"), std::string::npos) << *problem;
}

TEST_F(Report, UniformTargetAndExtremeDomainsAreDrawn) {
  for (const auto& [width_m, height_m] : {std::pair(1e5, 1.0), {1.0, 1e5}, {1.0, 1.0}}) {
    mission.domain.size_m = {width_m, height_m, 0};
    cover({{}, 1});
    record(3, 200);  // mostly outside: an observer takes what the files have
    ASSERT_EQ(report(), std::nullopt);
    expect_sound();
  }
}

TEST_F(Report, HasTheRecordedTarget) {
  record(2, 50);
  ASSERT_EQ(report(), std::nullopt);
  EXPECT_TRUE(data()["record"]["mission"]["density"].is_null());
  Field density(4, 2);
  density << 0, 0, 1.25, 3, 0, 0, 0, 3.75;
  ASSERT_EQ(write_target_density(dir / kTargetDensityFile, density), std::nullopt);
  EXPECT_EQ(read_target_density(dir / kTargetDensityFile).value(), density);
  ASSERT_EQ(report(), std::nullopt);
  const auto drawn = data()["record"]["mission"]["density"];
  EXPECT_EQ(drawn["width"], 4);
  EXPECT_EQ(drawn["height"], 2);
  expect_sound();
}

TEST_F(Report, NamesARecordedTargetThatIsDamaged) {
  record(2, 50);
  write(dir / kTargetDensityFile, "1,2\n1,x\n");
  const auto problem = report();
  ASSERT_TRUE(problem);
  EXPECT_NE(problem->find("target_density.csv, line 2: x is not a number"), std::string::npos)
      << *problem;
}

TEST_F(Report, StaysBelowTwoMegabytesForALargeRun) {
  ASSERT_EQ(write_target_density(dir / kTargetDensityFile, Field::Constant(256, 256, 1)),
            std::nullopt);
  record(64, 6000);  // each tick turns sharply, so that hardly a point can be left out
  ASSERT_EQ(report(), std::nullopt);
  EXPECT_LT(fs::file_size(dir / "report.html"), 2'000'000u);
  EXPECT_EQ(data()["record"]["stride"], 1);
}

TEST_F(Report, OfALongMissionThePageHasEveryFewTicks) {
  record(2, 300'001);
  ASSERT_EQ(report(), std::nullopt);
  EXPECT_EQ(data()["record"]["stride"], 2);
  EXPECT_EQ(data()["record"]["ticks"], 300'001);
  EXPECT_EQ(data()["record"]["rows"], 150'001);
  EXPECT_LT(fs::file_size(dir / "report.html"), 2'000'000u);
}

// --- tracks ---

TEST(TrackGrid, CodesRunsBetweenGapsAsSecondDifferences) {
  TrackGrid grid({{100, 0, 0}, {16383, 16383, 0}}, 1);
  for (const Tick tick : {0, 1, 2, 5})
    grid.put(7, tick, {100.0 + 10 * static_cast<double>(tick), 64, 0});
  EXPECT_EQ(grid.rows(), 6);
  const auto coded = grid.encode(0, grid.rows());
  EXPECT_EQ(coded["agents"].dump(), R"([{"id":7,"runs":[0,3,5,1]}])");
  // x 0 10 20, y 64 64 64, then x 50, y 64; zigzag doubles positive numbers.
  EXPECT_EQ(coded["data"], base64(std::string("\x00\x14\x00\x80\x01\x7f\x00\x64\x80\x01", 10)));
  EXPECT_EQ(grid.encode(3, 5)["agents"].size(), 0U);
  EXPECT_EQ(grid.encode(1, 2)["agents"].dump(), R"([{"id":7,"runs":[1,1]}])");
}

TEST(TrackGrid, CodesHeadingsWhereVehiclesTurn) {
  TrackGrid grid({{0, 0, 0}, {16383, 16383, 0}}, 1, true);
  grid.put(7, 0, {1, 2, 0}, {0, 3, 0});
  grid.put(7, 1, {1, 2, 0}, {0, -3, 0});
  const auto coded = grid.encode(0, 2);
  EXPECT_EQ(coded["headings"], true);
  // 64 of 256 to the left, then 192: second differences 64 and 64, zigzag coded.
  EXPECT_EQ(coded["data"], base64(std::string("\x02\x01\x04\x03\x80\x01\x80\x01", 8)));
}

TEST(TrackGrid, KeepsEveryOtherRowWhenThereAreTooMany) {
  TrackGrid grid({{0, 0, 0}, {16383, 16383, 0}}, 1);
  for (Tick tick = 0; tick < TrackGrid::kMostPositions; ++tick) {
    grid.put(3, tick, {static_cast<double>(tick % 1000), 0, 0});
  }
  EXPECT_EQ(grid.stride(), 1);
  grid.put(3, TrackGrid::kMostPositions, {0, 0, 0});
  EXPECT_EQ(grid.stride(), 2);
  EXPECT_EQ(grid.rows(), TrackGrid::kMostPositions / 2 + 1);
  // The places 0, 2, 4 of the ticks 0, 2, 4.
  EXPECT_EQ(grid.encode(0, 3)["data"], base64(std::string("\x00\x04\x00\x00\x00\x00", 6)));
  grid.put(3, Tick{1} << 52, {1, 1, 0});  // as a damaged record may
  EXPECT_LE(grid.rows(), TrackGrid::kMostPositions);
}

TEST(TrackGrid, TakesPlacesFarOutside) {
  TrackGrid grid({{0, 0, 0}, {1, 1, 0}}, 1);
  grid.put(0, 0, {1e100, -1e100, 0});
  const auto coded = grid.encode(0, 1);
  EXPECT_EQ(coded["agents"].dump(), R"([{"id":0,"runs":[0,1]}])");
}

TEST(TrackGrid, CodesHeightsInABox) {
  TrackGrid grid({{0, 0, -100}, {16383, 16383, 16383}}, 1);
  for (const Tick tick : {0, 1}) grid.put(2, tick, {1, 2, -100.0 + static_cast<double>(tick)});
  // x 1 1, y 2 2, z 0 1.
  EXPECT_EQ(grid.encode(0, 2)["data"], base64(std::string("\x02\x01\x04\x03\x00\x02", 6)));
}

// --- slope ---

/// A row each second up to `end_s` of 3·t^power.
std::pair<std::vector<double>, std::vector<double>> power_law(double power, double end_s) {
  std::vector<double> t_s, values;
  for (double t = 0; t <= end_s; ++t) {
    t_s.push_back(t);
    values.push_back(t == 0 ? 1 : 3 * std::pow(t, power));
  }
  return {t_s, values};
}

TEST(Slope, PowerLawsGiveTheirExponent) {
  for (const double power : {-2.0, -1.0, -0.37, 0.0, 1.5}) {
    const auto [t_s, values] = power_law(power, 1000);
    const auto law = fit_last_decade(t_s, values);
    ASSERT_TRUE(law);
    EXPECT_NEAR(law->slope, power, 1e-12);  // rounding of logarithms up to 14, over 900 rows
    EXPECT_NEAR(law->at(500), 3 * std::pow(500, power), 1e-10 * law->at(500));
    EXPECT_NEAR(law->from_s, 100, 1e-9);
    EXPECT_NEAR(law->to_s, 1000, 1e-9);
  }
}

TEST(Slope, OnlyTheLastDecadeCounts) {
  auto [t_s, values] = power_law(-1, 1000);
  for (std::size_t i = 0; i < 100; ++i) values[i] = 1e6;
  EXPECT_NEAR(log_log_slope(t_s, values).value(), -1, 1e-12);
}

TEST(Slope, IsNotGuessedFromTooLittle) {
  EXPECT_FALSE(log_log_slope({}, {}));
  EXPECT_FALSE(log_log_slope(std::vector{0.0, 1.0, 2.0}, std::vector{1.0, 0.5, 0.2}));
  EXPECT_FALSE(log_log_slope(std::vector{10.0, 11.0, 12.0}, std::vector{1.0, 0.5, 0.2}));
  EXPECT_FALSE(log_log_slope(std::vector{1.0, 2.0, 4.0}, std::vector{0.0, 0.0, 0.0}));
}

// --- text ---

TEST(Numbers, AreShortForPeople) {
  EXPECT_EQ(readable(0.36812), "0.368");
  EXPECT_EQ(readable(143976), "143\u202f976");
  EXPECT_EQ(readable(1234567), "1\u202f234\u202f567");
  EXPECT_EQ(readable(-9.329e-4), "−9.33 × 10⁻⁴");
  EXPECT_EQ(readable(9.999e-6), "1 × 10⁻⁵");
  EXPECT_EQ(readable(std::nan("")), "–");
  EXPECT_EQ(escape("<a b='\"'>&\x02"), "&lt;a b=&#39;&quot;&#39;&gt;&amp;\ufffd");
}

}  // namespace
}  // namespace ergocast
