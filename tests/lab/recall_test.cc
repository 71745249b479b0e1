// SPDX-License-Identifier: BSD-3-Clause
// Recalled agents in the laboratory: they rest at home or leave, and the others go on, in both
// paces and whatever happens to messages and processes meanwhile.
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <set>
#include <string>
#include <tuple>

#include "tests/support/simulated_team.h"

namespace ergocast::test {
namespace {

using lab::Faults;

struct Case {
  const char* name;
  Pace pace;
  const char* scenario;
  double departure_share;
};

Scenario scenario_of(const Case& one) {
  std::ifstream file(std::string(ERGOCAST_SCENARIO_DIR "/") + one.scenario + ".textproto");
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  Overrides overrides;
  overrides.pace = one.pace;
  return Scenario::parse(text, one.scenario, overrides).value();
}

class RecalledUnderFaults : public ::testing::TestWithParam<Case> {};

TEST_P(RecalledUnderFaults, BreaksNoInvariant) {
  const Scenario scenario = scenario_of(GetParam());
  std::int64_t recalls = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    Faults faults;
    if (seed > 3) faults = lab::drawn(seed);
    faults.recalls_per_s = 0.1;
    faults.departure_share = GetParam().departure_share;
    const TriedTeam tried(faults, seed, scenario);
    ASSERT_EQ(tried.problem(), "") << "seed " << seed;
    recalls += tried.result.figures.recalls;
  }
  EXPECT_GT(recalls, 12);
}

INSTANTIATE_TEST_SUITE_P(
    Teams, RecalledUnderFaults,
    ::testing::Values(Case{"home", Pace::kLockstep, "faulty_team", 0},
                      Case{"home_in_real_time", Pace::kRealtime, "faulty_team", 0},
                      Case{"out", Pace::kLockstep, "faulty_team", 1},
                      Case{"out_in_real_time", Pace::kRealtime, "faulty_team", 1},
                      Case{"crowd", Pace::kLockstep, "crowded_team", 0.5}),
    [](const auto& one) { return one.param.name; });

/// The trajectory of a mission in which agents are recalled. If `drops`, no agent receives any
/// contribution before it was repeated.
std::string trajectory_of(const Mission& mission, bool drops) {
  std::ostringstream trajectory, metrics;
  std::set<std::tuple<AgentId, Tick, int, lab::NodeId>> dropped;
  const auto drop = [&](const Message& message, lab::NodeId to) {
    const auto* block = std::get_if<Contribution>(&message);
    return drops && block != nullptr &&
           dropped.emplace(block->header.sender, block->header.tick, block->block, to).second;
  };
  Faults faults;
  faults.recalls_per_s = 0.1;
  lab::Simulation simulation({.plan = encode_plan(mission), .faults = faults, .drop = drop},
                             trajectory, metrics);
  simulation.run();
  EXPECT_EQ(simulation.coordinator().state(), MissionState::kEnded);
  EXPECT_GT(simulation.recorder().facts().recalls.size(), 0U);
  return trajectory.str();
}

TEST(Recalled, InLockstepALossChangesNothing) {
  const Mission mission = scenario_of({"", Pace::kLockstep, "faulty_team", 0}).mission();
  EXPECT_TRUE(trajectory_of(mission, false) == trajectory_of(mission, true));
}

}  // namespace
}  // namespace ergocast::test
