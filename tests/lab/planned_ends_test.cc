// SPDX-License-Identifier: BSD-3-Clause
// Missions that get another end: agents are at their stations in time, and nothing goes on after
// it.
#include <gtest/gtest.h>

#include <random>

#include "core/mission/end_by_finding.h"
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

/// Six objects are hidden.
Mission finding(int end_when_found) {
  Overrides overrides;
  overrides.pace = Pace::kLockstep;
  overrides.duration_s = 120;
  Mission mission = shipped_mission("quadrimodal_corners", overrides);
  mission.sensor.radius_m = 150;
  mission.objects.count = 6;
  mission.objects.end_when_found = end_when_found;
  return mission;
}

// In lockstep the world stays at the tick of the last find, so the end is a function of the plan.
TEST(EndByFinding, IsThreeTicksAfterTheFindAndRepeatsBitForBit) {
  const Ended whole(finding(0), {}), ended(finding(2), {});
  const std::vector<Find>& finds = whole.facts().finds.list();
  ASSERT_GT(finds.size(), 2u);
  const Tick last = finds[1].tick;
  EXPECT_EQ(ended.facts().ticks, last + 3);
  EXPECT_EQ(ended.facts().finds.list().size(), 2u);
  EXPECT_EQ(ended.simulation.coordinator().reason(), "2 of 6 objects are found");
  const Amendments& list = ended.simulation.coordinator().amendments();
  ASSERT_EQ(list.ends.size(), 1u);
  EXPECT_EQ(list.ends[0], (EndChange{0, last + 2, last + 3}));
  EXPECT_EQ(list.recent[0].by, kByFinding);
  const std::string rows = ended.trajectory.str(), until = std::to_string(last + 2) + ",";
  EXPECT_EQ(whole.trajectory.str().substr(0, rows.find("\n" + until)),
            rows.substr(0, rows.find("\n" + until)));
  const Ended again(finding(2), list);  // as verify repeats it
  EXPECT_EQ(again.trajectory.str(), rows);
  EXPECT_EQ(again.simulation.coordinator().amendments(), list);
}

TEST(EndByFinding, IsTheSameIfMessagesAreLost) {
  const Ended ended(finding(2), {});
  std::ostringstream trajectory, metrics;
  std::mt19937 random(7);
  lab::Simulation lossy({.plan = encode_plan(finding(2)),
                         .drop = [&](const Message&, lab::NodeId) { return random() % 4 == 0; }},
                        trajectory, metrics);
  lossy.run();
  EXPECT_EQ(lossy.coordinator().reason(), "2 of 6 objects are found");
  EXPECT_EQ(trajectory.str(), ended.trajectory.str());
  EXPECT_EQ(lossy.coordinator().amendments().ends,
            ended.simulation.coordinator().amendments().ends);
}

TEST(EndByFinding, IsNotNamedIfThePlansEndIsNear) {
  Mission mission = finding(2);
  const Ended ended(mission, {});
  mission.timing.tick_count = ended.facts().ticks;
  const Ended by_plan(mission, {});
  EXPECT_TRUE(by_plan.simulation.coordinator().amendments().ends.empty());
  EXPECT_EQ(by_plan.facts().ticks, ended.facts().ticks);
}

}  // namespace
}  // namespace ergocast::test
