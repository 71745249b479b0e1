// SPDX-License-Identifier: BSD-3-Clause
// Missions that get another end: agents are at their stations in time, and nothing goes on after
// it.
#include <gtest/gtest.h>

#include "core/mission/end_schedule.h"
#include "core/mission/station.h"
#include "tests/support/simulated_team.h"

namespace ergocast::test {
namespace {

/// A team with stations, in lockstep.
Mission dusk() {
  Overrides overrides;
  overrides.pace = Pace::kLockstep;
  overrides.duration_s = 200;
  return shipped_mission("home_by_dusk", overrides);
}

struct Ended {
  Ended(const Mission& mission, const Amendments& list)
      : simulation({.plan = encode_plan(mission), .amendments = list}, trajectory, metrics) {
    simulation.run();
    EXPECT_EQ(simulation.coordinator().state(), MissionState::kEnded)
        << simulation.coordinator().reason();
  }
  const RunFacts& facts() const { return simulation.recorder().facts(); }

  std::ostringstream trajectory, metrics;
  lab::Simulation simulation;
};

double farthest_m(const Ended& ended) {
  double most_m = 0;
  for (const auto& [id, away_m] : ended.facts().from_home_m) most_m = std::max(most_m, away_m);
  return most_m;
}

TEST(PlannedEnds, AgentsAreHomeBeforeAnEarlierAndALaterEnd) {
  const Mission mission = dusk();
  const auto ticks = [&](double t_s) { return static_cast<Tick>(t_s / mission.timing.dt_s); };
  const Ended planned(mission, {});
  for (const double end_s : {150.0, 300.0}) {
    Amendments list;
    name_end(list, ticks(30), ticks(end_s));
    const Ended ended(mission, list);
    EXPECT_EQ(ended.facts().ticks, ticks(end_s));
    EXPECT_LE(farthest_m(ended), farthest_m(planned) + 1) << end_s;
    EXPECT_EQ(ended.facts().from_home_m.size(), planned.facts().from_home_m.size());
    EXPECT_EQ(ended.simulation.recorder().amendments().list(), list);
    const auto rows = ended.trajectory.str().substr(0, 500);
    EXPECT_EQ(rows, planned.trajectory.str().substr(0, 500)) << "nothing changes before";
  }
}

TEST(PlannedEnds, AgentsThatRestStayAtTheirStations) {
  const Mission mission = dusk();
  const auto rest = rest_from(mission, 0);
  ASSERT_LT(rest, mission.timing.tick_count - 110);
  Amendments list;
  name_end(list, mission.timing.tick_count - 100, mission.timing.tick_count + 300);
  const Ended ended(mission, list), planned(mission, {});
  EXPECT_EQ(ended.facts().ticks, mission.timing.tick_count + 300);
  EXPECT_LE(farthest_m(ended), farthest_m(planned) + 1);
}

TEST(PlannedEnds, AnEndThatIsTakenBackChangesNothing) {
  Mission mission = dusk();
  Amendments list;
  name_end(list, 100, 900);
  name_end(list, 100, mission.timing.tick_count);
  const Ended ended(mission, list), planned(mission, {});
  EXPECT_EQ(ended.trajectory.str(), planned.trajectory.str());
}

}  // namespace
}  // namespace ergocast::test
