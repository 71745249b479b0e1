// SPDX-License-Identifier: BSD-3-Clause
// A paused mission in the laboratory: held ticks add nothing and take nothing away, in both paces,
// for all kinds of vehicles, and whatever happens to messages and processes meanwhile.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <map>
#include <string>
#include <vector>

#include "tests/support/simulated_team.h"

namespace ergocast::test {
namespace {

using lab::Faults;

/// A shipped team, with `more` at the beginning of one part of its scenario, or after all of them.
Scenario team(Pace pace, const std::string& name = "faulty_team", const std::string& part = "",
              const std::string& more = "") {
  std::ifstream file(ERGOCAST_SCENARIO_DIR "/" + name + ".textproto");
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  Overrides overrides;
  overrides.pace = pace;
  overrides.duration_s = 30;
  return Scenario::parse(
             with(with(text + (part.empty() ? more : ""), part, part + (part.empty() ? "" : more)),
                  name == "faulty_team" ? "goal_ergodic_metric: 0.12" : "", ""),
             name, overrides)
      .value();
}

struct RecordedRun {
  std::vector<std::vector<std::string>> rows, metrics;
  RunFacts facts;
  Tick last = 0;
};

std::vector<std::vector<std::string>> table_of(const std::string& text) {
  std::vector<std::vector<std::string>> rows;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream cells(line);
    rows.emplace_back();
    for (std::string cell; std::getline(cells, cell, ',');) rows.back().push_back(cell);
  }
  rows.erase(rows.begin());  // the header
  return rows;
}

RecordedRun simulated(const Mission& mission, std::vector<Hold> holds) {
  std::ostringstream trajectory, metrics;
  lab::Simulation simulation(
      {.plan = encode_plan(mission), .amendments = only_pauses(std::move(holds))}, trajectory,
      metrics);
  simulation.run();
  EXPECT_EQ(simulation.coordinator().state(), MissionState::kEnded);
  return {table_of(trajectory.str()), table_of(metrics.str()), simulation.recorder().facts(),
          simulation.last_tick()};
}

/// The rows of ticks that count, numbered by those ticks.
std::vector<std::vector<std::string>> counted(std::vector<std::vector<std::string>> rows,
                                              const std::vector<Hold>& holds) {
  std::erase_if(rows, [&](const auto& row) { return is_held(holds, std::stoll(row[0])); });
  for (auto& row : rows) {
    row[0] = std::to_string(counted_ticks(holds, std::stoll(row[0])));
    row[1].clear();  // the time, which goes on
  }
  return rows;
}

const std::vector<Hold> kHolds{{0, 3}, {77, 78}, {120, 151}, {151, 160}, {299, 340}};

struct Law {
  const char *part, *more;
};
class PausedLockstep : public ::testing::TestWithParam<Law> {};

TEST_P(PausedLockstep, IsTheSameMissionWithTicksInBetween) {
  const Mission mission =
      team(Pace::kLockstep, "faulty_team", GetParam().part, GetParam().more).mission();
  const RecordedRun through = simulated(mission, {}), paused = simulated(mission, kHolds);
  EXPECT_EQ(counted(paused.rows, kHolds), counted(through.rows, {}));
  EXPECT_EQ(through.last, 300);
  EXPECT_EQ(paused.last, 300 + 3 + 1 + 31 + 9 + 41);
  EXPECT_EQ(paused.facts.held_ticks, 85);
  EXPECT_EQ(paused.facts.ticks, 385);
  EXPECT_EQ(paused.facts.ergodic_metric, through.facts.ergodic_metric);
  EXPECT_EQ(paused.facts.t_s, through.facts.t_s);
}

INSTANTIATE_TEST_SUITE_P(
    Laws, PausedLockstep,
    ::testing::Values(Law{"", ""}, Law{"agents {", " dead_reckoning: false"},
                      Law{"law {", " anticipation: 0 "}, Law{"law {", " ends_with_plan: true "},
                      Law{"time {", " contribution_encoding: FIXED16 high_mode_period_factor: 3"}));

TEST(PausedLockstep, StandsStillInEveryHeldTick) {
  const RecordedRun paused = simulated(team(Pace::kLockstep).mission(), kHolds);
  int held = 0;
  for (const auto& row : paused.rows) {
    if (!is_held(kHolds, std::stoll(row[0]))) continue;
    ++held;
    EXPECT_EQ(row[5] + ' ' + row[6], "0 0") << row[0];
  }
  EXPECT_EQ(held, 4 * 85);
}

// ---- an operator pauses it, under faults ----

struct Case {
  const char* name;
  Pace pace;
  const char* scenario;
  const char* more;
};

class PausedUnderFaults : public ::testing::TestWithParam<Case> {};

TEST_P(PausedUnderFaults, BreaksNoInvariant) {
  const Case& one = GetParam();
  const Scenario scenario = team(one.pace, one.scenario, "", one.more);
  std::int64_t pauses = 0, held = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    Faults faults;
    if (seed > 3) faults = lab::drawn(seed);
    faults.pauses_per_s = 0.3;
    faults.pause_max_s = 5;
    const TriedTeam tried(faults, seed, scenario);
    ASSERT_EQ(tried.problem(), "") << "seed " << seed;
    pauses += tried.result.figures.pauses;
    held += tried.result.figures.held_ticks;
  }
  EXPECT_GT(pauses, 20);
  EXPECT_GT(held, 5 * pauses);
}

constexpr const char* kBraking = "vehicle { kind: ACCELERATION max_acceleration_mps2: 20 }";
constexpr const char* kTurning = "vehicle { kind: UNICYCLE max_turn_radps: 1 }";

INSTANTIATE_TEST_SUITE_P(
    Teams, PausedUnderFaults,
    ::testing::Values(Case{"points", Pace::kLockstep, "faulty_team", ""},
                      Case{"points_in_real_time", Pace::kRealtime, "faulty_team", ""},
                      Case{"box", Pace::kLockstep, "mixed_team", ""},
                      Case{"crowd", Pace::kLockstep, "crowded_team", ""},
                      Case{"crowd_in_real_time", Pace::kRealtime, "crowded_team", ""},
                      Case{"braking", Pace::kLockstep, "crowded_team", kBraking},
                      Case{"turning", Pace::kLockstep, "crowded_team", kTurning},
                      Case{"wings", Pace::kLockstep, "faulty_team",
                           "separation { distance_m: 15 } world { speed_limit_mps: 20 } "
                           "vehicle { kind: FIXED_WING max_turn_radps: 1.5 min_speed_mps: 5 }"}),
    [](const auto& one) { return one.param.name; });

}  // namespace
}  // namespace ergocast::test
