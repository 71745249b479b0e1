// SPDX-License-Identifier: BSD-3-Clause
// Teams with a forecast, in the laboratory: in lockstep no fault of messages, coordinator or world
// changes the forecast; in real time a stopped teammate does not count for ever.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <string>

#include "core/basis/basis.h"
#include "tests/support/simulated_team.h"

namespace ergocast::test {
namespace {

using lab::Faults;

std::string text_of(const std::string& file) {
  std::ifstream stream(std::string(ERGOCAST_SOURCE_DIR) + '/' + file);
  return {std::istreambuf_iterator<char>(stream), {}};
}
Scenario scenario_of(const std::string& text, const Overrides& overrides = {}) {
  return Scenario::parse(text, "foresight", overrides).value();
}

// ---- lockstep ----

struct Telling {
  const char* name;
  bool dead_reckoning;
  int period;
};

class LockstepForesight : public ::testing::TestWithParam<Telling> {
 protected:
  Scenario scenario() const {
    std::string text = text_of("scenarios/faulty_team.textproto");
    text = with(text, "broadcast_period_ticks: 5",
                "broadcast_period_ticks: " + std::to_string(GetParam().period));
    text = with(text, "goal_ergodic_metric: 0.12", "");
    if (!GetParam().dead_reckoning) text = with(text, "agents {", "agents { dead_reckoning: false");
    Overrides overrides;
    overrides.pace = Pace::kLockstep;
    overrides.duration_s = 30;
    return scenario_of(text, overrides);
  }

  std::string trajectory(const Faults& faults) const {
    const TriedTeam tried(faults, 7, scenario());
    EXPECT_EQ(tried.problem(), "");
    EXPECT_FALSE(tried.result.timed_out);
    figures_ = tried.result.figures;
    return tried.trajectory;
  }

  mutable lab::TrialFigures figures_;
};

TEST_P(LockstepForesight, IsTheSameWhateverHappensToMessages) {
  Faults faults;
  faults.loss = 0.2;
  faults.duplication = 0.2;
  faults.corruption = 0.1;
  faults.reordering = 0.2;
  faults.reordering_max_s = 0.3;
  faults.delay_mean_s = 0.01;
  faults.delay_max_s = 0.1;
  faults.replay = 0.3;
  faults.replay_max_s = 60;
  const std::string clean = trajectory({});
  EXPECT_TRUE(trajectory(faults) == clean);
  EXPECT_GT(figures_.faults.lost, 1000);
  EXPECT_GT(figures_.faults.reordered, 1000);
}

TEST_P(LockstepForesight, IsTheSameWhicheverAgentsCannotReceiveEachOtherForAWhile) {
  Faults faults;
  faults.loss = 0.3;
  faults.partitions_per_s = 2;
  faults.partition_max_s = 1;
  faults.one_way_share = 0.5;
  const std::string clean = trajectory({});
  EXPECT_TRUE(trajectory(faults) == clean);
  EXPECT_GT(figures_.splits, 0);
  EXPECT_GT(figures_.one_way_cuts, 0);
}

TEST_P(LockstepForesight, IsTheSameWhenCoordinatorAndWorldAreRestarted) {
  Faults faults;
  faults.coordinator_crashes_per_s = 1;
  faults.world_crashes_per_s = 1;
  faults.downtime_max_s = 1;
  const std::string clean = trajectory({});
  EXPECT_TRUE(trajectory(faults) == clean);
  EXPECT_GT(figures_.world_crashes, 0);
  EXPECT_GT(figures_.coordinator_crashes, 0);
}

INSTANTIATE_TEST_SUITE_P(Laboratory, LockstepForesight,
                         ::testing::Values(Telling{"FromRows", false, 1},
                                           Telling{"FromRowsSeldom", false, 6},
                                           Telling{"Reckoning", true, 1},
                                           Telling{"ReckoningSeldom", true, 6}),
                         [](const auto& telling) { return std::string(telling.param.name); });

// ---- a stopped teammate ----

/// φ² at 600 s as agent 0 knows it, if it receives nothing from agent 3 or its vehicle from 150 s
/// on.
double metric_after_a_death(const std::string& law, const std::string& agents, std::uint64_t seed) {
  std::string text =
      with(text_of("studies/law/random.textproto"), "u_max_mps: 20", "u_max_mps: 20 " + law);
  text = with(text, "agents {", "agents { " + agents);
  text = with(text, "dt_s: 0.1", "dt_s: 0.1 pace: REALTIME broadcast_period_ticks: 20");
  Overrides overrides;
  overrides.duration_s = 600;
  overrides.seed = seed;
  const Mission mission = scenario_of(text, overrides).mission();
  SimulatedTeam team(mission, [](const Message& message, int) {
    return header_of(message).sender == 3 && header_of(message).tick >= 1500;
  });
  team.run();
  const Agent &agent = team.simulation.agent(0), &dead = team.simulation.agent(3);
  EXPECT_EQ(agent.tick(), 6000);
  // All that it sent until then, and nothing since.
  const auto held = agent.coverage()->steps_held(dead.author());
  EXPECT_GT(held.value_or(0), 1500 - 21);
  EXPECT_LE(held.value_or(0), 1500);
  return ergodic_metric(agent.team_coverage(), mission.target_coefficients,
                        sobolev_weights(mission.basis, mission.domain));
}

TEST(DeadTeammate, IsForgottenByTheTeamsForecastsAndNotForEverLeftToCover) {
  std::vector<double> from_rows, reckoning, without;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    from_rows.push_back(metric_after_a_death("", "dead_reckoning: false", seed));
    reckoning.push_back(metric_after_a_death("", "dead_reckoning: true", seed));
    without.push_back(metric_after_a_death("anticipation: 0", "", seed));
  }
  EXPECT_LT(median(from_rows), median(without));
  EXPECT_LT(median(reckoning), median(without));
  RecordProperty("from_rows", std::to_string(median(from_rows)));
  RecordProperty("reckoning", std::to_string(median(reckoning)));
  RecordProperty("without", std::to_string(median(without)));
}

}  // namespace
}  // namespace ergocast::test
