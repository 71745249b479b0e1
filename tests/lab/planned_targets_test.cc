// SPDX-License-Identifier: BSD-3-Clause
// A simulation that is given many targets from its beginning: each agent counts each tick against
// the target of this tick, and so does the recorder. `ergocast verify` relies on it.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <regex>
#include <sstream>
#include <string>

#include "tests/support/simulated_team.h"

namespace ergocast::test {
namespace {

/// The plan's target with mode k in the place of 1: other densities, all within limits.
TargetChange target_of(const Mission& mission, int k) {
  TargetChange change;
  change.target = mission.target_coefficients;
  change.target[1 + k] = std::cos(k);
  change.target.tail(20) *= std::sin(k);
  return change;
}

/// The team of the laboratory in lockstep, for 30 s.
Mission lockstep_mission(const std::string& half_life_s) {
  Overrides overrides;
  overrides.fields = {{"law.memory_half_life_s", half_life_s, "HALF_LIFE"}};
  overrides.pace = Pace::kLockstep;
  overrides.duration_s = 30;
  return shipped_mission("faulty_team", overrides);
}

class PlannedTargets : public ::testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(HalfLife, PlannedTargets, ::testing::Values("0", "1.7", "10"),
                         [](const auto& one) {
                           return "s" + std::regex_replace(one.param, std::regex("[.]"), "_");
                         });

TEST_P(PlannedTargets, HoldFromTheirTicksOnForAgentsAndRecorder) {
  const Mission mission = lockstep_mission(GetParam());
  const double half_life_ticks = std::round(mission.law.memory_half_life_s / mission.timing.dt_s);
  Amendments list;
  for (const Tick from : {20, 22, 24, 26, 100, 140, 142, 144, 200, 202, 298}) {
    Amendments next;
    name_target(next, from, target_of(mission, list.named));
    list.recent.push_back(next.recent[0]);
    list.targets.push_back(next.targets[0]);
    list.recent.back().number = list.targets.back().number = list.named++;
  }
  ASSERT_TRUE(are_amendments(list, mission));
  std::ostringstream trajectory, metrics;
  lab::Simulation simulation({.plan = encode_plan(mission), .amendments = list}, trajectory,
                             metrics);
  simulation.run();
  ASSERT_EQ(simulation.coordinator().state(), MissionState::kEnded);
  EXPECT_LE(simulation.coordinator().amendments().targets.size(), 2U);

  std::map<AgentId, Coefficients> sums_s;
  std::map<AgentId, double> covered_s_of;
  std::istringstream rows(trajectory.str());
  std::string row;
  std::getline(rows, row);
  while (std::getline(rows, row)) {
    long long tick = 0;
    int agent = 0;
    double x_m = 0, y_m = 0;
    ASSERT_EQ(std::sscanf(row.c_str(), "%lld,%*[^,],%d,%lf,%lf", &tick, &agent, &x_m, &y_m), 4);
    Coefficients& sum_s =
        sums_s.try_emplace(agent, Coefficients::Zero(mission.basis.mode_count())).first->second;
    double& covered_s = covered_s_of[agent];
    if (half_life_ticks > 0 && tick > 0 && tick % static_cast<Tick>(half_life_ticks) == 0) {
      sum_s /= 2;
      covered_s /= 2;
    }
    covered_s += mission.timing.dt_s;
    sum_s += basis_values({x_m, y_m, 0}, mission.domain, mission.basis) * mission.timing.dt_s;
    if (const TargetChange* const change = target_at(list.targets, tick))
      sum_s -= (change->target - mission.target_coefficients) * mission.timing.dt_s;
  }
  ASSERT_EQ(sums_s.size(), 4U);
  Coefficients coverage = Coefficients::Zero(mission.basis.mode_count());
  for (const auto& [id, sum_s] : sums_s) {
    const Agent& agent = simulation.agent(id);
    const double* const own_s = agent.coverage()->sums_of(agent.author());
    for (int k = 0; k < mission.basis.mode_count(); ++k) ASSERT_NEAR(own_s[k], sum_s[k], 1e-9) << k;
    coverage += sum_s / (4 * covered_s_of[id]);
  }
  const double expected = ergodic_metric(coverage, mission.target_coefficients,
                                         sobolev_weights(mission.basis, mission.domain));
  const Recorder& recorder = simulation.recorder();
  EXPECT_NEAR(recorder.facts().ergodic_metric_last, expected, 1e-9 * expected);
  EXPECT_EQ(recorder.facts().targets.size(), 12U);
  EXPECT_EQ(recorder.amendments().list(), list);
}

}  // namespace
}  // namespace ergocast::test
