// SPDX-License-Identifier: BSD-3-Clause
// A record is falsified, one value at a time: `ergocast verify` finds the change and names the
// place.
#include <algorithm>
#include <set>
#include <sstream>

#include "tests/process/support/programs.h"

namespace ergocast::test {
namespace {

using Json = nlohmann::ordered_json;

class Falsified : public OwnHost {
 protected:
  void write(const std::string& file, const std::string& text) const {
    std::ofstream(out() / file, std::ios::binary) << text;
  }
  void record(const std::string& command) {
    ASSERT_EQ(ergocast({command, scenario_file("quadrimodal_corners"), "--duration", "5", "--out",
                        out()}),
              0)
        << output();
    ASSERT_EQ(ergocast({"verify", out()}), 0) << output();
  }
  /// Expects `verify` to report a difference at `place` when `file` contains `text`.
  void expect_found(const std::string& file, const std::string& text, const std::string& place) {
    const std::string honest = text_of(out() / file);
    ASSERT_NE(text, honest);
    write(file, text);
    EXPECT_EQ(ergocast({"verify", out()}), 1) << place << ": " << output();
    EXPECT_NE(output().find("differs from its simulation"), std::string::npos) << output();
    EXPECT_NE(output().find(place), std::string::npos) << place << " is not in: " << output();
    write(file, honest);
  }
  bool printed(const std::string& part) const { return output().find(part) != std::string::npos; }
  /// `text` with the last digit of cell `column` of line `line`, from 1, changed.
  static std::string with_another_digit(const std::string& text, int line, int column) {
    std::size_t at = 0;
    for (int i = 1; i < line; ++i) at = text.find('\n', at) + 1;
    for (int i = 0; i < column; ++i) at = text.find(',', at) + 1;
    const std::size_t end = text.find_first_of(",\n", at) - 1;
    std::string other = text;
    other[end] = other[end] == '9' ? '8' : static_cast<char>(other[end] + 1);
    return other;
  }
  /// Changes each value of the summary but `free` ones, one after the other.
  void expect_each_value_found(const std::set<std::string>& free) {
    const Json summary = Json::parse(text_of(out() / "summary.json")), flat = summary.flatten();
    for (const auto& [pointer, value] : flat.items()) {
      const bool is_free =
          std::any_of(free.begin(), free.end(), [&p = pointer](const std::string& key) {
            return p.starts_with(key) || p.ends_with(key);
          });
      if (is_free) continue;
      Json changed = flat;
      changed[pointer] = value.is_number() ? Json(value.get<double>() + 1) : Json("other");
      expect_found("summary.json", changed.unflatten().dump(2), pointer);
      Json cut = flat;
      cut.erase(pointer);
      if (pointer.starts_with("/agents")) continue;  // an array with a hole is none
      expect_found("summary.json", cut.unflatten().dump(2), pointer);
    }
    Json more = summary;
    more["emergency_stop"] = true;
    expect_found("summary.json", more.dump(2), "emergency_stop");
  }
};

constexpr const char* kMetricsColumns[] = {"tick",
                                           "t_s",
                                           "ergodic_metric",
                                           "detection_probability",
                                           "metric_spread",
                                           "max_staleness_s",
                                           "contributions_received",
                                           "contributions_lost",
                                           "blocked_share"};

TEST_F(Falsified, SimulationIsFoundInEveryColumnAndValue) {
  record("simulate");
  const std::string metrics = text_of(out() / "metrics.csv");
  for (int column = 0; column < 9; ++column) {
    expect_found("metrics.csv", with_another_digit(metrics, 4, column),
                 std::string("metrics.csv:4, column ") + kMetricsColumns[column]);
  }
  expect_each_value_found(
      {"/started", "/build", "/cpu_fma", "/wall_time_s", "/ticks_per_s", "/host"});
}

TEST_F(Falsified, RunIsFoundInAllThatItsSimulationDetermines) {
  record("run");
  const std::string metrics = text_of(out() / "metrics.csv");
  for (int column = 0; column < 4; ++column) {
    expect_found("metrics.csv", with_another_digit(metrics, 4, column),
                 std::string("metrics.csv:4, column ") + kMetricsColumns[column]);
  }
  const Json summary = Json::parse(text_of(out() / "summary.json"));
  Json changed = summary;
  for (const char* key : {"result", "scenario", "mode", "version"}) {
    changed[key] = "other";
    expect_found("summary.json", changed.dump(2), std::string("/") + key);
    changed = summary;
  }
  for (const char* key : {"scenario_hash", "seed", "dt_s", "tick_count", "ticks", "log_log_slope",
                          "gaps", "segments", "missed_deadlines", "skipped_ticks"}) {
    changed[key] = 7;
    expect_found("summary.json", changed.dump(2), std::string("/") + key);
    changed = summary;
  }
  for (const char* key : {"first", "last"}) {
    changed["ergodic_metric"][key] = summary["ergodic_metric"][key].get<double>() * (1 + 1e-12);
    expect_found("summary.json", changed.dump(2), std::string("/ergodic_metric/") + key);
    changed = summary;
  }
}

TEST_F(Falsified, RowsAreFoundThatAreSwappedTwiceOrMissing) {
  record("run");
  for (const std::string file : {"trajectory.csv", "metrics.csv"}) {
    const std::string table = text_of(out() / file);
    const auto row = [&table](int line) {
      std::istringstream lines(table);
      std::string text;
      for (int i = 0; i < line; ++i) std::getline(lines, text);
      return text + '\n';
    };
    const auto at = table.find(row(4));
    const std::string before = table.substr(0, at),
                      after = table.substr(at + row(4).size() + row(5).size());
    expect_found(file, before + row(5) + row(4) + after, file + ":");
    expect_found(file, before + row(4) + row(4) + row(5) + after, file + ":5");
    expect_found(file, before + row(4) + after, file);
    expect_found(file, table.substr(0, table.size() - 1), file);
    expect_found(file, table.substr(0, table.rfind('\n', table.size() - 2) + 1), file);
    expect_found(file, table + table.substr(table.rfind('\n', table.size() - 2) + 1), file);
  }
}

TEST_F(Falsified, TrajectoryIsNamedByLineAndColumn) {
  record("simulate");
  const std::string table = text_of(out() / "trajectory.csv");
  expect_found("trajectory.csv", with_another_digit(table, 30, 4), "trajectory.csv:30, column y_m");
  expect_found("trajectory.csv", with_another_digit(table, 2, 6),
               "trajectory.csv:2, column vy_mps");
}

TEST_F(Falsified, PlanScenarioTargetAndReportAreFound) {
  record("simulate");
  std::string plan = text_of(out() / "plan.binpb");
  const auto mu = plan.size() / 2;  // most of a plan are coefficients of the target
  plan[mu] = static_cast<char>(plan[mu] ^ 1);
  expect_found("plan.binpb", plan, "plan.binpb");
  for (const std::string file : {"scenario.textproto", "target_density.csv", "report.html"}) {
    std::string text = text_of(out() / file);
    const auto digit = text.find_first_of("123456789", text.size() / 2);
    text[digit] = text[digit] == '1' ? '2' : '1';
    expect_found(file, text, file == "scenario.textproto" ? file : file + ':');
  }
}

// A record whose files agree with each other, but not with its plan.
TEST_F(Falsified, PlanOfAnotherSeedIsFoundThoughEverythingNamesIt) {
  record("simulate");
  ASSERT_EQ(ergocast({"simulate", out() / "scenario.textproto", "--seed", "99", "--out",
                      folder_ / "other"}),
            0);
  for (const char* file : {"plan.binpb", "scenario.textproto"}) {
    std::filesystem::copy_file(folder_ / "other" / file, out() / file,
                               std::filesystem::copy_options::overwrite_existing);
  }
  Json summary = Json::parse(text_of(out() / "summary.json"));
  const Json other = Json::parse(text_of(folder_ / "other" / "summary.json"));
  for (const char* key : {"scenario_hash", "seed", "run_id"}) summary[key] = other[key];
  write("summary.json", summary.dump(2));
  EXPECT_EQ(ergocast({"verify", out()}), 1) << output();
  EXPECT_TRUE(printed("trajectory.csv:")) << output();
}

TEST_F(Falsified, HonestRecordListsWhatWasComparedAndWhatNot) {
  record("run");
  const auto compared = output().find("\ncompared:"),
             not_compared = output().find("\nnot compared:");
  ASSERT_TRUE(compared != std::string::npos && not_compared != std::string::npos) << output();
  for (const char* file : {"plan.binpb", "scenario.textproto", "target_density.csv",
                           "trajectory.csv", "metrics.csv", "summary.json", "report.html"}) {
    const auto at = output().find(std::string("\n  ") + file);
    EXPECT_TRUE(at > compared && at < not_compared) << file << ": " << output();
  }
  for (const char* file : {"metrics.csv", "summary.json", "events-000.lcm", "log"}) {
    EXPECT_NE(output().find(std::string("\n  ") + file, not_compared), std::string::npos)
        << file << ": " << output();
  }
}

TEST_F(Falsified, MissingFilesAreRefusedOrNamed) {
  record("simulate");
  for (const char* file : {"report.html", "target_density.csv", "scenario.textproto"}) {
    std::filesystem::remove(out() / file);
    EXPECT_EQ(ergocast({"verify", out()}), 0) << output();
    const auto not_compared = output().find("\nnot compared:");
    EXPECT_NE(output().find(file, not_compared), std::string::npos) << file << ": " << output();
    EXPECT_TRUE(printed("is not there")) << output();
  }
  std::filesystem::remove(out() / "summary.json");
  EXPECT_EQ(ergocast({"verify", out()}), 0) << output();
  EXPECT_TRUE(printed("summary.json                 is not there")) << output();
  for (const char* file : {"metrics.csv", "plan.binpb"}) {
    std::filesystem::remove(out() / file);
    EXPECT_EQ(ergocast({"verify", out()}), 2) << output();
    EXPECT_TRUE(printed(file)) << output();
  }
}

TEST_F(Falsified, EmergencyStopIsBelievedOnlyWhereAllStandStill) {
  record("simulate");
  Json summary = Json::parse(text_of(out() / "summary.json"));
  std::string table = text_of(out() / "trajectory.csv");
  const auto cut = table.find("\n30,") + 1;
  write("trajectory.csv", table.substr(0, cut));
  summary["result"] = "stopped";
  summary["emergency_stop"] = true;
  write("summary.json", summary.dump(2));
  EXPECT_EQ(ergocast({"verify", out()}), 1) << output();
  EXPECT_TRUE(printed("summary.json") || printed("metrics.csv")) << output();
}

}  // namespace
}  // namespace ergocast::test
