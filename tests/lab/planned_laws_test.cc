// SPDX-License-Identifier: BSD-3-Clause
// Missions whose law changes: agents obey at its tick, and go home as fast as planned.
#include <gtest/gtest.h>

#include "core/mission/law_change.h"
#include "tests/support/simulated_team.h"

namespace ergocast::test {
namespace {

struct Simulated {
  Simulated(const Mission& mission, const Amendments& list)
      : simulation({.plan = encode_plan(mission), .amendments = list}, trajectory, metrics) {
    simulation.run();
    EXPECT_EQ(simulation.coordinator().state(), MissionState::kEnded)
        << simulation.coordinator().reason();
  }

  std::ostringstream trajectory, metrics;
  lab::Simulation simulation;
};

Mission lockstep(const std::string& name, double duration_s) {
  Overrides overrides;
  overrides.pace = Pace::kLockstep;
  overrides.duration_s = duration_s;
  return shipped_mission(name, overrides);
}

LawChange slower(const Mission& mission, double share) {
  LawChange law = plans_law(mission);
  for (LawNumbers& numbers : law.kinds) numbers.u_max_mps *= share;
  return law;
}

/// The list of a mission that a simulation knows from the beginning: any number of laws.
void plan_law(Amendments& list, Tick from, LawChange law) {
  law.number = list.named++;
  law.from = from;
  list.recent.push_back({law.number, AmendmentKind::kLaw, from, law_hash(law)});
  list.laws.push_back(std::move(law));
}

TEST(PlannedLaws, ThePlansNumbersChangeNothing) {
  const Mission mission = lockstep("quadrimodal_corners", 20);
  Amendments list;
  plan_law(list, 50, plans_law(mission));
  EXPECT_EQ(Simulated(mission, list).trajectory.str(), Simulated(mission, {}).trajectory.str());
}

TEST(PlannedLaws, AnyNumberOfThemHoldsOneAfterTheOther) {
  const Mission mission = lockstep("quadrimodal_corners", 30);
  Amendments list;
  for (int i = 1; i <= 5; ++i) plan_law(list, 40 * i, slower(mission, 1.0 / (1 + i)));
  const Simulated changed(mission, list);
  EXPECT_EQ(changed.simulation.recorder().amendments().list(), list);
  EXPECT_NE(changed.trajectory.str(), Simulated(mission, {}).trajectory.str());
}

TEST(PlannedLaws, AgentsAreHomeInTimeHoweverSlowTheyCover) {
  const Mission mission = lockstep("home_by_dusk", 200);
  Amendments list;
  plan_law(list, mission.timing.tick_count / 4, slower(mission, 0.1));
  const Simulated slow(mission, list), planned(mission, {});
  const auto farthest_m = [](const Simulated& ended) {
    double most_m = 0;
    for (const auto& [id, away_m] : ended.simulation.recorder().facts().from_home_m)
      most_m = std::max(most_m, away_m);
    return most_m;
  };
  EXPECT_NE(slow.trajectory.str(), planned.trajectory.str());
  EXPECT_FALSE(planned.simulation.recorder().facts().from_home_m.empty());
  EXPECT_EQ(slow.simulation.recorder().facts().from_home_m.size(),
            planned.simulation.recorder().facts().from_home_m.size());
  EXPECT_LE(farthest_m(slow), farthest_m(planned) + 1);
}

}  // namespace
}  // namespace ergocast::test
