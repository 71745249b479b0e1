// SPDX-License-Identifier: BSD-3-Clause
// Vehicles with batteries in the laboratory: they go home in time, are charged and come back, in
// both paces and whatever happens to messages and processes meanwhile.
#include "core/motion/charge.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <map>
#include <set>
#include <string>
#include <tuple>

#include "core/mission/station.h"
#include "core/motion/home.h"
#include "logger/run_data.h"
#include "logger/run_record.h"
#include "tests/support/simulated_team.h"
#include "tests/support/temp_folder.h"

namespace ergocast::test {
namespace {

/// What a battery has been through.
struct Course {
  std::int32_t now_ppm = kWhole_ppm, least_ppm = kWhole_ppm;
  int charges = 0;  ///< from below a half to full
  bool low = false;

  void note(std::int32_t charge_ppm) {
    now_ppm = charge_ppm;
    least_ppm = std::min(least_ppm, charge_ppm);
    if (low && charge_ppm >= kFull_ppm) ++charges;
    low = charge_ppm < kFull_ppm && (low || charge_ppm < kWhole_ppm / 2);
  }
};

TEST(Charged, ComeBackAndKeepTheirReserve) {
  std::map<AgentId, Course> courses;
  const auto note = [&](const Message& message, lab::NodeId) {
    const auto* state = std::get_if<WorldState>(&message);
    for (const Vehicle& vehicle :
         state == nullptr ? std::span<const Vehicle>{} : state->vehicles_in_part())
      courses[vehicle.id].note(vehicle.charge_ppm);
    return false;
  };
  SimulatedTeam team(shipped_mission("recharge"), note);
  ASSERT_TRUE(team.run());
  EXPECT_EQ(team.state(), MissionState::kEnded) << team.reason();
  ASSERT_EQ(courses.size(), 3U);
  for (const auto& [id, course] : courses) {
    EXPECT_GE(course.charges, 2) << id;
    EXPECT_GE(course.least_ppm, 150'000) << id << " goes home with 0.2 and what the way needs";
    EXPECT_LE(course.least_ppm, 260'000) << id << " goes home too early";
  }
}

TEST(Charged, BreakNoInvariantUnderFaults) {
  for (const Pace pace : {Pace::kLockstep, Pace::kRealtime}) {
    Overrides overrides;
    overrides.pace = pace;
    const Scenario scenario = shipped_scenario("recharge", overrides);
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      const TriedTeam tried(seed > 1 ? lab::drawn(seed) : lab::Faults{}, seed, scenario);
      ASSERT_EQ(tried.problem(), "") << "seed " << seed;
    }
  }
}

/// How often each vehicle's battery is charged at a tick that would otherwise be covered.
class ChargedTicks {
 public:
  explicit ChargedTicks(const Mission& mission) : mission_(mission) {}
  void note(const WorldState& state) {
    for (const Vehicle& vehicle : state.vehicles_in_part()) {
      const Tick tick = state.header.tick;
      if (tick > 0 && !rests(mission_, vehicle.id, tick) &&
          charges(mission_, vehicle.id, vehicle.position_m, vehicle.velocity_mps))
        ticks_[vehicle.id].insert(tick);
    }
  }
  std::int64_t of(AgentId id) const { return std::ssize(ticks_.at(id)); }

 private:
  Mission mission_;
  std::map<AgentId, std::set<Tick>> ticks_;
};

/// What agents have covered is also what the record's rows say, and what its metrics count.
TEST(Charged, CoverNothingMeanwhileAndNeitherDoesTheRecord) {
  const Mission mission = shipped_mission("recharge");
  ChargedTicks charged(mission);
  SimulatedTeam team(mission, [&](const Message& message, lab::NodeId) {
    if (const auto* state = std::get_if<WorldState>(&message)) charged.note(*state);
    return false;
  });
  ASSERT_TRUE(team.run());
  const CoverageTable& table = *team.simulation.agent(0).coverage();
  for (std::size_t row = 0; row < 3; ++row) {
    const AgentId id = table.author(row).agent;
    EXPECT_GT(charged.of(id), 500) << id;
    EXPECT_EQ(table.steps_held(table.author(row)), rest_from(mission, id) - charged.of(id)) << id;
  }
  Coefficients covered(mission.basis.mode_count());
  table.average(covered);
  const TempFolder folder;
  std::ofstream(folder.path() / kTrajectoryFile) << team.trajectory.str();
  const RunData rows = read_tracks(folder.path()).value();
  EXPECT_LT((coverage_of(rows, mission) - covered).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_NEAR(team.simulation.recorder().facts().ergodic_metric_last,
              ergodic_metric(covered, mission.target_coefficients,
                             sobolev_weights(mission.basis, mission.domain)),
              1e-12);
}

/// If `drops`, no agent receives any contribution before it was repeated.
std::string trajectory_of(bool drops) {
  std::set<std::tuple<AgentId, Tick, int, lab::NodeId>> dropped;
  SimulatedTeam team(shipped_mission("recharge"), [&](const Message& message, lab::NodeId to) {
    const auto* block = std::get_if<Contribution>(&message);
    return drops && block != nullptr &&
           dropped.emplace(block->header.sender, block->header.tick, block->block, to).second;
  });
  EXPECT_TRUE(team.run());
  return team.trajectory.str();
}

TEST(Charged, InLockstepALossChangesNothing) {
  const std::string whole = trajectory_of(false);
  EXPECT_GT(whole.size(), 100'000U);
  EXPECT_EQ(trajectory_of(true), whole);
}

}  // namespace
}  // namespace ergocast::test
