// SPDX-License-Identifier: BSD-3-Clause
// Vehicles with batteries in the laboratory: they go home in time, are charged and come back, in
// both paces and whatever happens to messages and processes meanwhile.
#include "core/motion/charge.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <tuple>

#include "tests/support/simulated_team.h"

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
