// SPDX-License-Identifier: BSD-3-Clause
// `ergocast simulate --seeds`: each seed simulates the mission of `--seed` and is recorded. If it
// fails, the printed command repeats it.
#include <cmath>
#include <set>
#include <sstream>

#include "tests/process/support/programs.h"

namespace ergocast::test {
namespace {

constexpr const char* kSwiftMission = R"(
domain { size_x_m: 100 size_y_m: 100 }
target { gaussians { mean_x_m: 30 mean_y_m: 60 sigma_m: 12 } }
basis { modes_x: 5 modes_y: 5 }
law { u_max_mps: 5 }
time { duration_s: 30 }
agents { starts { x_m: 50 y_m: 20 } random_count: 2 }
)";

class Trials : public OwnHost {
 protected:
  Trials() { write("mission.textproto", kSwiftMission); }

  std::filesystem::path write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name) << text;
    return folder_ / name;
  }

  /// The column of a table with a head, by its name.
  static std::vector<std::string> column(const std::string& table, const std::string& name) {
    std::vector<std::string> column;
    std::istringstream lines(table);
    std::size_t wanted = 0;
    bool head = true;
    for (std::string line; std::getline(lines, line); head = false) {
      std::istringstream cells(line);
      std::size_t at = 0;
      for (std::string cell; std::getline(cells, cell, ','); ++at) {
        if (head && cell == name) wanted = at;
        if (!head && at == wanted) column.push_back(cell);
      }
    }
    return column;
  }

  /// φ² at the end of the mission of `simulate --seed` with these arguments, as written.
  std::string simulated(std::vector<std::string> arguments, int seed) {
    const auto folder = folder_ / ("simulated-" + std::to_string(seed));
    arguments.insert(arguments.begin(), "simulate");
    arguments.insert(arguments.end(), {"--seed", std::to_string(seed), "--out", folder});
    EXPECT_EQ(ergocast(arguments), 0) << output();
    const auto metric = column(text_of(folder / "metrics.csv"), "ergodic_metric");
    return metric.empty() ? "none" : metric.back();
  }

  /// The text after `before` in each line that has it, up to `after` or the line's end.
  std::vector<std::string> texts_between(const std::string& before,
                                         const std::string& after = "\n") const {
    std::vector<std::string> parts;
    const std::string text = output();
    for (auto at = text.find(before); at != text.npos; at = text.find(before, at + 1)) {
      const auto begin = at + before.size();
      parts.push_back(
          text.substr(begin, std::min(text.find(after, begin), text.find('\n', begin)) - begin));
    }
    return parts;
  }
};

TEST_F(Trials, AGoalOutOfReachFailsEverySeedWithTheMetricThatSimulateRecords) {
  const auto mission =
      write("impossible.textproto", std::string(kSwiftMission) + "goal_ergodic_metric: 1e-9\n");
  EXPECT_EQ(ergocast({"simulate", mission, "--seeds", "1:20"}), 4);
  EXPECT_EQ(texts_between("failures")[0].substr(texts_between("failures")[0].rfind(' ')), " 20")
      << output();
  std::vector<double> reached;
  for (int seed = 1; seed <= 20; ++seed) {
    const auto printed = texts_between(
        "seed " + std::to_string(seed) + ": the goal is reached: the team at t = ", " > ");
    ASSERT_EQ(printed.size(), 1U) << seed << "\n" << output();
    reached.push_back(std::stod(printed[0].substr(printed[0].find("phi^2 = ") + 8)));
  }
  for (const int seed : {1, 7, 20}) {
    const double metric = std::stod(simulated({folder_ / "mission.textproto"}, seed));
    EXPECT_EQ(reached[static_cast<std::size_t>(seed - 1)], metric) << seed;
  }
}

TEST_F(Trials, EachSeedDrawsItsStartsAsSimulateDoes) {
  // After one tick φ² is that of the start places.
  const std::vector<std::string> one_tick = {folder_ / "mission.textproto", "--duration", "0.1"};
  auto words = one_tick;
  words.insert(words.begin(), "simulate");
  words.insert(words.end(), {"--seeds", "1:20", "--out", folder_ / "trials.csv"});
  ASSERT_EQ(ergocast(words), 0) << output();
  const auto metrics = column(text_of(folder_ / "trials.csv"), "ergodic_metric");
  ASSERT_EQ(metrics.size(), 20U);
  EXPECT_EQ(std::set(metrics.begin(), metrics.end()).size(), 20U) << "the same starts again";
  for (const int seed : {1, 2, 20}) {
    EXPECT_EQ(std::stod(metrics[static_cast<std::size_t>(seed - 1)]),
              std::stod(simulated(one_tick, seed)))
        << seed;
  }
}

TEST_F(Trials, ThePrintedCommandRunsTheSameMissionAgain) {
  const auto mission =
      write("it's a goal.textproto", std::string(kSwiftMission) + "goal_ergodic_metric: 1e-9\n");
  const auto faults = write("some faults.ini", "loss = 0.2\nagent_crashes_per_s = 0.1\n");
  for (const auto& pace :
       {std::vector<std::string>{"--realtime=2"}, {"--realtime"}, {"--lockstep"}}) {
    std::vector<std::string> words = {"simulate",   mission, "--seeds",  "7340000:7340002",
                                      "--agents",   "4",     "--faults", faults,
                                      "--duration", "20.1"};
    words.insert(words.end(), pace.begin(), pace.end());
    std::filesystem::remove(folder_ / "again.log");
    EXPECT_EQ(ergocast(words), 4) << output();
    const auto failed = texts_between("seed ");
    const auto again = texts_between("again: ergocast ");
    ASSERT_EQ(failed.size(), 3U) << output();
    ASSERT_EQ(again.size(), 3U) << output();
    log_ = folder_ / "again.log";
    Child child =
        Child::start({{"/bin/sh", "-c", (program_folder() / "ergocast").string() + ' ' + again[1]},
                      log_,
                      SIGKILL})
            .value();
    EXPECT_EQ(wait_for(child), 4) << again[1];
    EXPECT_EQ(texts_between("seed "), std::vector<std::string>{failed[1]}) << again[1];
  }
}

}  // namespace
}  // namespace ergocast::test
