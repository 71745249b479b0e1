// SPDX-License-Identifier: BSD-3-Clause
// `ergocast study`: every combination once, after any interruption.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <sstream>

#include "tests/process/support/programs.h"

namespace ergocast::test {
namespace {

constexpr const char* kMission = R"(
domain { size_x_m: 100 size_y_m: 100 }
target { gaussians { mean_x_m: 30 mean_y_m: 60 sigma_m: 12 } }
basis { modes_x: 5 modes_y: 5 }
law { u_max_mps: 5 }
time { duration_s: 30 }
agents { starts { x_m: 50 y_m: 20 } random_count: 1 }
world { speed_limit_mps: 4 }
)";

class Study : public OwnHost {
 protected:
  Study() { write("mission.textproto", kMission); }
  void write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name) << text;
  }
  bool printed(const std::string& part) const { return output().find(part) != std::string::npos; }

  /// The arguments of a study of two noises.
  std::vector<std::string> arguments(const std::string& seeds,
                                     const std::filesystem::path& out) const {
    return {"study",   folder_ / "mission.textproto",
            "--vary",  "law.noise_intensity=0.1,1",
            "--seeds", seeds,
            "--jobs",  "2",
            "--out",   out};
  }
  int study(const std::string& seeds, const std::filesystem::path& out) {
    return ergocast(arguments(seeds, out));
  }

  /// The table of a study without interruption.
  std::string fresh(const std::string& seeds) {
    const auto folder = folder_ / ("fresh-" + seeds);
    EXPECT_EQ(study(seeds, folder), 0) << output();
    return text_of(folder / "study.csv");
  }
  std::string table() const { return text_of(out() / "study.csv"); }
  static std::size_t lines(const std::string& text) {
    return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
  }
};

/// The rows below a table's head, cell by cell.
std::vector<std::vector<std::string>> rows_of(const std::string& table) {
  std::vector<std::vector<std::string>> rows;
  std::istringstream in(table);
  std::string line;
  std::getline(in, line);
  while (std::getline(in, line)) {
    rows.emplace_back();
    std::istringstream cells(line);
    for (std::string cell; std::getline(cells, cell, ',');) rows.back().push_back(cell);
  }
  return rows;
}

TEST_F(Study, RunsEveryCombinationOnceInOrder) {
  auto words = arguments("4:6", out());
  words.insert(words.end(), {"--vary", "law.regularization=ABSOLUTE,RELATIVE"});
  ASSERT_EQ(ergocast(words), 0) << output();
  EXPECT_TRUE(printed("law.noise_intensity = 0.1, law.regularization = RELATIVE")) << output();
  const auto rows = rows_of(table());
  ASSERT_EQ(rows.size(), 12U);
  std::size_t row = 0;
  for (const char* noise : {"0.1", "1"}) {
    for (const char* form : {"ABSOLUTE", "RELATIVE"}) {
      for (const char* seed : {"4", "5", "6"}) {
        const std::vector<std::string> expected{"mission", noise, form, seed};
        EXPECT_TRUE(std::equal(expected.begin(), expected.end(), rows[row++].begin())) << row;
      }
    }
  }
  EXPECT_TRUE(text_of(out() / "report.html").ends_with("</html>\n"));
}

TEST_F(Study, DoesNotDependOnTheNumberOfJobs) {
  auto words = arguments("1:9", out());
  *std::find(words.begin(), words.end(), "2") = "5";
  ASSERT_EQ(ergocast(words), 0);
  EXPECT_EQ(table(), fresh("1:9"));
}

TEST_F(Study, ARunIsTheMissionThatSimulateRuns) {
  ASSERT_EQ(study("7", out()), 0);
  const auto simulated = folder_ / "simulated";
  auto mission = std::string(kMission);
  mission.replace(mission.find("u_max_mps: 5"), 12, "u_max_mps: 5 noise_intensity: 0.1");
  write("one.textproto", mission);
  ASSERT_EQ(ergocast({"simulate", folder_ / "one.textproto", "--seed", "7", "--out", simulated}),
            0);
  const auto summary = nlohmann::json::parse(text_of(simulated / "summary.json"));
  const double metric = summary["ergodic_metric"]["last"];
  const auto rows = rows_of(table());
  ASSERT_EQ(rows.size(), 2U);
  // The logger adds up in another order.
  EXPECT_NEAR(std::stod(rows[0][5]) / metric, 1, 1e-9);
  EXPECT_EQ(std::stod(rows[0][6]), summary["detection"]["probability"].get<double>());
  EXPECT_GT(std::stod(rows[0][6]), 0);
}

TEST_F(Study, PrintsTheColumnsThatAreAskedFor) {
  auto words = arguments("1:3", out());
  words.insert(words.end(), {"--measure", "path_m", "--measure", "time_to_half_s"});
  ASSERT_EQ(ergocast(words), 0) << output();
  EXPECT_TRUE(printed("path_m [95 %]")) << output();
  EXPECT_TRUE(printed("time_to_half_s [95 %]")) << output();
  EXPECT_FALSE(printed("detection_probability [95 %]")) << output();
  words.back() = "nonsense";
  EXPECT_EQ(ergocast(words), 2);
  EXPECT_TRUE(printed("nonsense")) << output();
}

TEST_F(Study, SetsFieldsOfEveryPointAndNamesTheCommandOfEachRow) {
  auto words = arguments("7:8", out());
  words.insert(words.end(), {"--set", "agents.starts[0].x_m=40", "--set", "law.epsilon=0.2"});
  ASSERT_EQ(ergocast(words), 0) << output();
  const std::string mission = folder_ / "mission.textproto";
  EXPECT_TRUE(printed("\n  ergocast run " + mission +
                      " --set 'agents.starts[0].x_m'=40 --set law.epsilon=0.2"
                      " --set law.noise_intensity=1 --seed 7\n"))
      << output();
  const auto study = nlohmann::json::parse(text_of(out() / "study.json"));
  EXPECT_EQ(study["set"],
            nlohmann::json::parse(R"(["agents.starts[0].x_m=40", "law.epsilon=0.2"])"));

  const auto simulated = folder_ / "simulated";
  ASSERT_EQ(
      ergocast({"simulate", mission, "--set", "agents.starts[0].x_m=40", "--set", "law.epsilon=0.2",
                "--set", "law.noise_intensity=1", "--seed", "7", "--out", simulated}),
      0);
  const auto summary = nlohmann::json::parse(text_of(simulated / "summary.json"));
  const double metric = summary["ergodic_metric"]["last"];
  const auto rows = rows_of(table());
  ASSERT_EQ(rows.size(), 4U);
  EXPECT_NEAR(std::stod(rows[2][5]) / metric, 1, 1e-9);
}

TEST_F(Study, GoesOnAfterCtrlCAndLosesNothing) {
  Child child = start("ergocast", arguments("1:500000", out()));
  ASSERT_TRUE(eventually([this] { return lines(table()) > 20; }));
  child.send(SIGINT);
  EXPECT_EQ(wait_for(child), 0);
  EXPECT_TRUE(printed("runs are missing: the same command runs them")) << output();
  const auto before = rows_of(table());
  ASSERT_LT(before.size(), 1000000U);
  unsigned long last = 0;
  for (const auto& row : before) last = std::max(last, std::stoul(row[2]));
  const std::string seeds = "1:" + std::to_string(last + 5);
  ASSERT_EQ(study(seeds, out()), 0) << output();
  EXPECT_TRUE(printed(std::to_string(2 * (last + 5) - before.size()) + " runs done now"))
      << output();
  EXPECT_EQ(table(), fresh(seeds));
}

TEST_F(Study, DropsALastLineThatIsTorn) {
  ASSERT_EQ(study("1:3", out()), 0);
  const std::string whole = table();
  write("run/study.csv", whole.substr(0, whole.size() - 7));
  ASSERT_EQ(study("1:3", out()), 0);
  EXPECT_TRUE(printed("1 runs done now")) << output();
  EXPECT_EQ(table(), whole);
}

TEST_F(Study, TakesMoreSeedsLaterAndKeepsThoseItHas) {
  ASSERT_EQ(study("1:3", out()), 0);
  ASSERT_EQ(study("2:8", out()), 0);
  EXPECT_TRUE(printed("10 runs done now, 16 in")) << output();
  EXPECT_EQ(table(), fresh("1:8"));
}

TEST_F(Study, DrawsAFinishedStudyAgain) {
  ASSERT_EQ(study("1:3", out()), 0);
  const std::string page = text_of(out() / "report.html");
  std::filesystem::remove(out() / "report.html");
  ASSERT_EQ(study("1:3", out()), 0);
  EXPECT_TRUE(printed("0 runs done now, 6 in")) << output();
  EXPECT_EQ(text_of(out() / "report.html"), page);
}

TEST_F(Study, AWorkerThatCrashesCostsItsRun) {
  auto words = arguments("1", out());
  words.insert(words.end(), {"--duration", "10000000"});
  Child child = start("ergocast", words);
  std::vector<std::string> running;
  ASSERT_TRUE(eventually([&] { return (running = processes_on_own_host()).size() == 3; }));
  for (const std::string& process : running) {
    const pid_t pid = pid_of(process);
    if (pid != child.pid()) kill(pid, SIGKILL);
  }
  EXPECT_EQ(wait_for(child), 4);
  EXPECT_TRUE(printed("law.noise_intensity = 1, seed 1: its process was killed by SIGKILL"))
      << output();
  EXPECT_TRUE(printed("2 runs are missing, 2 of them failed")) << output();
  EXPECT_EQ(lines(table()), 1U);
}

/// The shards of one study, and their merged folder.
class Shards : public Study {
 protected:
  std::filesystem::path part(int index) const {
    return folder_ / ("part-" + std::to_string(index));
  }
  void run_shard(int index, const std::string& seeds, const std::string& of = "3") {
    auto words = arguments(seeds, part(index));
    words.insert(words.end(), {"--shard", std::to_string(index) + "/" + of});
    EXPECT_EQ(ergocast(words), 0) << output();
  }
  int merge(const std::vector<std::filesystem::path>& parts) {
    std::vector<std::string> words{"study", "merge", "--out", out()};
    words.insert(words.end(), parts.begin(), parts.end());
    return ergocast(words);
  }
  void refused(const std::vector<std::filesystem::path>& parts, const std::string& why) {
    EXPECT_EQ(merge(parts), 2) << why;
    EXPECT_TRUE(printed(why)) << why << " in\n" << output();
    EXPECT_FALSE(std::filesystem::exists(out()));
  }
};

TEST_F(Shards, MergedAreTheBytesOfOneRunOfAll) {
  ASSERT_EQ(study("4:10", out()), 0) << output();
  const auto whole = folder_ / "whole";
  std::filesystem::rename(out(), whole);
  for (const int index : {1, 2, 3}) run_shard(index, "4:10");
  EXPECT_EQ(lines(text_of(part(1) / "study.csv")), 6U);
  EXPECT_EQ(lines(text_of(part(3) / "study.csv")), 5U);
  ASSERT_EQ(merge({part(2), part(3), part(1)}), 0) << output();
  EXPECT_TRUE(printed("ergocast run ")) << output();
  for (const char* file : {"study.csv", "study.json", "report.html"}) {
    EXPECT_EQ(text_of(out() / file), text_of(whole / file)) << file;
  }
  EXPECT_EQ(merge({part(1), part(2), part(3)}), 2);
  EXPECT_TRUE(printed("is not empty; give a new folder")) << output();
}

TEST_F(Shards, OnlyAllShardsOfOneStudyEachOnceAreMerged) {
  for (const int index : {1, 2, 3}) run_shard(index, "1:2");
  refused({part(1), part(3)}, "1 of 3 shards are missing, the first is 2/3");
  refused({part(1), part(2), part(1), part(3)},
          "is shard 1/3 of seeds 1:2, and so is " + part(1).string());
  refused({part(1), folder_ / "nothing"}, "nothing: is no study");
  run_shard(4, "1:2", "4");
  refused({part(1), part(2), part(4)}, "is shard 4/4 of seeds 1:2, but " + part(1).string());
  run_shard(5, "1:3", "5");
  refused({part(1), part(5)}, "is shard 5/5 of seeds 1:3, but ");
  const auto whole = folder_ / "whole";
  ASSERT_EQ(study("1:2", whole), 0);
  refused({part(1), whole}, "whole: is no shard of a study");
  auto other = arguments("1:2", part(6));
  other.insert(other.end(), {"--shard", "2/3", "--set", "law.epsilon=1"});
  ASSERT_EQ(ergocast(other), 0) << output();
  refused({part(1), part(6), part(3)}, "its study sets [\"law.epsilon=1\"]; it is no shard of");
}

TEST_F(Shards, AShardThatIsIncompleteOrDamagedIsNotMerged) {
  for (const int index : {1, 2}) run_shard(index, "1:3", "2");
  const auto table = part(2) / "study.csv";
  const std::string good = text_of(table);
  const auto with = [&](const std::string& text) { std::ofstream(table) << text; };
  with(good.substr(0, good.rfind('\n', good.size() - 2) + 1));
  refused({part(1), part(2)}, "1 of its 3 runs are missing (the command that made it runs them)");
  with(good + good.substr(good.rfind('\n', good.size() - 2) + 1));
  refused({part(1), part(2)}, "has a run that is there already");
  with(text_of(part(1) / "study.csv"));
  refused({part(1), part(2)}, "has a run that is of another shard");
  with(good + "nonsense\n");
  refused({part(1), part(2)}, "is no row of this study");
  with(good);
  const auto json = part(2) / "study.json";
  const std::string identity = text_of(json);
  std::string later = identity;
  const auto at = later.find("\"version\": \"") + 12;
  later.insert(at, "9");
  std::ofstream(json) << later;
  refused({part(1), part(2)}, "its study was begun by ergocast \"9");
  refused({part(2), part(1)}, "(merge with the version that ran it)");
  std::ofstream(json) << identity.substr(0, identity.size() / 2);
  refused({part(1), part(2)}, "its study.json is damaged");
  std::ofstream(json) << identity;
  EXPECT_EQ(merge({part(1), part(2)}), 0) << output();
}

TEST_F(Shards, AFolderIsOfOneShard) {
  run_shard(1, "1:3");
  const auto again = [&](std::vector<std::string> more, const std::string& seeds,
                         const std::string& why) {
    auto words = arguments(seeds, part(1));
    words.insert(words.end(), more.begin(), more.end());
    EXPECT_EQ(ergocast(words), 2);
    EXPECT_TRUE(printed("its study is shard 1/3 of seeds 1:3, this one " + why)) << output();
  };
  again({"--shard", "2/3"}, "1:3", "shard 2/3 of seeds 1:3; give a new folder");
  again({"--shard", "1/3"}, "1:4", "shard 1/3 of seeds 1:4");
  again({}, "1:3", "no shard");
  for (const char* shard : {"0/3", "4/3", "1", "1/", "/3", "a/b", "1/1000001", "-1/3"}) {
    auto words = arguments("1:3", out());
    words.insert(words.end(), {"--shard", shard});
    EXPECT_EQ(ergocast(words), 2);
    EXPECT_TRUE(printed("is not I/N with I from 1 to N")) << output();
  }
  EXPECT_EQ(ergocast({"study", "--seeds", "1:3", "merge", part(1), "--out", out()}), 2);
  EXPECT_TRUE(printed("stands before all options")) << output();
}

TEST_F(Study, RefusesAnotherStudysFolder) {
  ASSERT_EQ(study("1:2", out()), 0);
  const std::string before = table();
  const auto refused = [&](std::vector<std::string> more, const std::string& why) {
    std::vector<std::string> words{
        "study", folder_ / "mission.textproto", "--seeds", "1:2", "--out", out()};
    words.insert(words.end(), more.begin(), more.end());
    EXPECT_EQ(ergocast(words), 2) << why;
    EXPECT_TRUE(printed(why) && printed("give a new folder")) << output();
  };
  refused({}, "its study varies [\"law.noise_intensity\"]");
  refused({"--vary", "law.noise_intensity=0.1"}, "its study has 2 points, this one 1");
  refused({"--vary", "law.noise_intensity=0.1,2"}, "differs at point 2");
  refused({"--vary", "law.noise_intensity=0.1,1", "--duration", "31"}, "differs at point 1");
  refused({"--vary", "law.noise_intensity=0.1,1", "--set", "law.epsilon=1"}, "its study sets []");
  EXPECT_EQ(table(), before);
}

TEST_F(Study, RefusesAFolderWithOtherFilesAndADamagedTable) {
  std::filesystem::create_directory(out());
  write("run/precious", "data");
  EXPECT_EQ(study("1", out()), 2);
  EXPECT_TRUE(printed("is not empty and no study")) << output();
  std::filesystem::remove(out() / "precious");
  ASSERT_EQ(study("1:3", out()), 0);
  std::string damaged = table();
  damaged.replace(damaged.find("\nmission,1,2,") + 1, 7, "mossion");
  write("run/study.csv", damaged);
  EXPECT_EQ(study("1:4", out()), 2);
  EXPECT_TRUE(printed("study.csv:6: is no row of this study")) << output();
  EXPECT_EQ(table(), damaged);
}

TEST_F(Study, RefusesWhatCannotRunBeforeItRunsAnything) {
  const auto refused = [&](std::vector<std::string> words, const std::string& why) {
    words.insert(words.begin(), {"study", folder_ / "mission.textproto", "--out", out()});
    EXPECT_EQ(ergocast(words), 2) << why;
    EXPECT_TRUE(printed(why)) << why << " in\n" << output();
    EXPECT_FALSE(std::filesystem::exists(out()));
  };
  refused({}, "--seeds");
  refused({"--seeds", "5:1"}, "--seeds");
  const auto vary = [&](const std::string& text, const std::string& why) {
    refused({"--seeds", "1:3", "--vary", text}, why);
  };
  vary("law.epsilom=1,2", "did you mean law.epsilon?");
  vary("law.noise_intensity=0,-1", "--vary law.noise_intensity=-1: -1 is below the limit 0");
  vary("law.regularization=NONE", "write one of RELATIVE or ABSOLUTE");
  vary("law.epsilon=1,,2", "has an empty value");
  vary("law.epsilon=", "has an empty value");
  vary("law.epsilon", "is not FIELD=VALUE");
  vary("law.epsilon=1,1", "has 1 twice");
  vary("law.epsilon=0.1,1e-1", "is the same mission as");
  vary("seed=1,2", "use --seeds");
  vary("law.contraction_gain_per_s=0,1", "u_max_mps: 5 is too weak for contraction_gain_per_s 1");
  EXPECT_TRUE(printed(", with law.contraction_gain_per_s=1")) << output();
  refused({"--seeds", "1", "--vary", "law.epsilon=1", "--vary", "law.epsilon=2"},
          "is varied twice");
  refused({"--seeds", "1", "--vary", "time.duration_s=1,2", "--duration", "3"},
          "--duration sets it too");
  refused({"--seeds", "1", "--set", "seed=3"}, "--set seed=3: every point gets the same seeds");
  refused({"--seeds", "1", "--set", "law.epsilom=3"}, "did you mean law.epsilon?");
  refused({"--seeds", "1", "--set", "law.epsilon"}, "is not FIELD=VALUE");
  refused({"--seeds", "1", "--set", "law.epsilon=1", "--set", "law.epsilon=2"},
          "--set law.epsilon=2: --set law.epsilon=1 sets it too");
  refused({"--seeds", "1", "--set", "law.epsilon=1", "--vary", "law.epsilon=2,3"},
          "--vary law.epsilon: --set sets it too");
  refused({"--seeds", "1:2000000"}, "are above the limit, 1000000 runs");
  refused({"--seeds", "1", "--jobs", "0"}, "--jobs");
  std::string many = "law.epsilon=0";
  for (int i = 1; i < 1001; ++i) many += ',' + std::to_string(i);
  vary(many, "1001 combinations are above the limit 1000");
  EXPECT_EQ(ergocast({"study", folder_ / "nothing", "--seeds", "1", "--out", out()}), 2);
  EXPECT_TRUE(printed("there is no such file")) << output();
}

}  // namespace
}  // namespace ergocast::test
