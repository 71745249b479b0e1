// SPDX-License-Identifier: BSD-3-Clause
// An agent's forecast from the positions of its teammates. Positions since a teammate's last block
// count as if they were broadcast, the next block replaces them, and they are never sent.
#include <gtest/gtest.h>

#include <cmath>

#include "core/law/look_ahead.h"
#include "core/law/lost_places.h"
#include "tests/agent/driven_agent.h"

namespace ergocast {
namespace {

using namespace test;

using Path = std::vector<Eigen::Vector3d>;

constexpr Tick kPeriod = 40;

Mission dead_reckoning_mission(Pace pace = Pace::kLockstep) {
  Mission mission = small_mission(2);
  mission.law.anticipation = 2;
  mission.dead_reckoning = true;
  mission.timing.pace = pace;
  mission.timing.broadcast_period_ticks = kPeriod;
  return mission;
}

Eigen::Vector3d own_place(Tick tick) { return {100.0 + 7 * static_cast<double>(tick), 500, 0}; }
Eigen::Vector3d their_place(Tick tick) { return {900, 600.0 + 9 * static_cast<double>(tick), 0}; }

Path their_path(Tick from, Tick until) {
  Path path;
  for (Tick tick = from; tick < until; ++tick) path.push_back(their_place(tick));
  return path;
}

/// Σ f(x) dt.
Coefficients sums_of(const Mission& mission, const Path& path_m) {
  Coefficients sums = Coefficients::Zero(20);
  for (const Eigen::Vector3d& x_m : path_m) {
    accumulate_basis(BasisAt(x_m, mission.domain, mission.basis), mission.basis,
                     mission.timing.dt_s, sums.data());
  }
  return sums;
}

/// ĉ at `tick` of an agent with its own path since `own_from` and one teammate. The teammate has
/// been at the positions `theirs`, and it continues as in the last `gained` of them. The last known
/// one is `age` ticks old.
Coefficients foreseen(const Mission& mission, Tick own_from, Tick tick, const Path& theirs,
                      std::size_t gained, Tick age) {
  const double dt_s = mission.timing.dt_s;
  const double h_s = LookAhead(mission).horizon_s(2, 0);
  const double weight_s = h_s + static_cast<double>(static_cast<Tick>(gained) + age) * dt_s;
  Path own;
  for (Tick t = own_from; t <= tick; ++t) own.push_back(own_place(t));
  const Path last(theirs.end() - static_cast<std::ptrdiff_t>(gained), theirs.end());
  const double known_s = static_cast<double>(own.size() + theirs.size()) * dt_s;
  return (sums_of(mission, own) + sums_of(mission, theirs) +
          weight_s / (static_cast<double>(gained) * dt_s) * sums_of(mission, last)) /
         (known_s + weight_s);
}

WorldState world_answered(Tick tick, Tick answered_tick) {
  return world_state(tick, {own_place(tick), their_place(tick)}, answered_tick);
}

class Reckoning : public ::testing::Test {
 protected:
  void begin(const Mission& mission, Tick active_from = 0) {
    mission_ = mission;
    announce(mission);
    agent_.emplace(identity_of(0));
    std::vector<RosterEntry> roster = roster_of(2);
    roster[0].active_from = active_from;
    give(*agent_, mission_part(0, MissionState::kRunning, roster), at(0s));
  }
  void hear_block(const Path& path, Tick next = kPeriod) {
    give(*agent_, block_of(mission_, 1, path, next), at(0s));
  }
  /// Ticks `from` to `until`, without the last.
  void run_ticks(Tick from, Tick until) {
    for (Tick tick = from; tick < until; ++tick) deliver(*agent_, world_answered(tick, tick - 1));
  }
  void expect_foreseen(const Coefficients& expected) const {
    EXPECT_LT((agent_->foreseen_coverage() - expected).cwiseAbs().maxCoeff(), 1e-13)
        << agent_->foreseen_coverage() << "\n\nbut expected\n"
        << expected;
  }

  Mission mission_;
  std::optional<Agent> agent_;
};

TEST_F(Reckoning, PlacesSinceATeammatesLastBlockCountAsIfItHadSentThem) {
  begin(dead_reckoning_mission());
  hear_block(their_path(0, 1));
  run_ticks(0, 6);
  expect_foreseen(foreseen(mission_, 0, 5, their_path(0, 6), 1, 0));
}

TEST_F(Reckoning, WithoutItTheLastBlockIsAllThatIsKnown) {
  Mission mission = dead_reckoning_mission();
  mission.dead_reckoning = false;
  begin(mission);
  hear_block(their_path(0, 1));
  run_ticks(0, 6);
  expect_foreseen(foreseen(mission_, 0, 5, their_path(0, 1), 1, 5));
}

TEST_F(Reckoning, TheNextBlockReplacesWhatWasReckoned) {
  begin(dead_reckoning_mission());
  hear_block(their_path(0, 1));
  run_ticks(0, 6);
  Path truth{
      {300, 300, 0}, {310, 300, 0}, {320, 300, 0}, {330, 300, 0}};  // as only its author knows
  hear_block(truth);
  run_ticks(6, 8);
  for (Tick tick = 4; tick < 8; ++tick) truth.push_back(their_place(tick));
  expect_foreseen(foreseen(mission_, 0, 7, truth, 1, 0));
}

TEST_F(Reckoning, NothingOfItIsHeldOrPassedOn) {
  begin(dead_reckoning_mission());
  const Contribution sent = block_of(mission_, 1, their_path(0, 1), kPeriod);
  give(*agent_, sent, at(0s));
  run_ticks(0, 20);
  EXPECT_EQ(agent_->coverage()->steps_held(author_of(1)), 1);
  EXPECT_EQ(agent_->coverage()->block(author_of(1), 0).sums, sent.sums);
  const Coefficients known =
      (sums_of(mission_, {own_place(0)}) + sums_of(mission_, their_path(0, 1))) / 0.2;
  begin(dead_reckoning_mission());
  hear_block(their_path(0, 1));
  run_ticks(0, 1);
  EXPECT_LT((agent_->team_coverage() - known).cwiseAbs().maxCoeff(), 1e-15) << "nor in c";
}

TEST_F(Reckoning, APlaceFromBeforeItTookPartIsNone) {
  begin(dead_reckoning_mission(), 3);
  hear_block(their_path(0, 1));
  run_ticks(0, 5);
  Path known = their_path(0, 1);
  for (const Eigen::Vector3d& x_m : their_path(3, 5)) known.push_back(x_m);
  expect_foreseen(foreseen(mission_, 3, 4, known, 1, 0));
}

TEST_F(Reckoning, APlaceBeyondTheRadiosRangeIsNone) {
  Mission mission = dead_reckoning_mission();
  mission.radio_range_m = 830;  // they are 806 m apart at first, then nearer
  begin(mission);
  hear_block(their_path(0, 1));
  const auto tell_of = [&](Tick tick, double away_m) {
    deliver(*agent_,
            world_state(tick, {own_place(tick), their_place(tick) + Eigen::Vector3d(away_m, 0, 0)},
                        tick - 1));
  };
  tell_of(0, 0);
  tell_of(1, 900);
  tell_of(2, 900);
  expect_foreseen(foreseen(mission_, 0, 2, their_path(0, 1), 1, 2));
  tell_of(3, 0);
  // It was about on the line meanwhile.
  expect_foreseen(foreseen(mission_, 0, 3, their_path(0, 4), 1, 0));
}

TEST_F(Reckoning, SamplesOfLostStatesAreOnTheLineBetweenOthers) {
  begin(dead_reckoning_mission(Pace::kRealtime));
  run_ticks(0, 4);
  run_ticks(4 + kMostLostPlaces, 20);
  Path own;
  for (Tick tick = 0; tick < 20; ++tick) own.push_back(own_place(tick));
  EXPECT_EQ(agent_->coverage()->steps_held(author_of(0)), 20);
  const double covered_s = 20 * mission_.timing.dt_s;
  const auto error = [&] {
    return (agent_->team_coverage() - sums_of(mission_, own) / covered_s).cwiseAbs().maxCoeff();
  };
  EXPECT_LT(error(), 1e-13);
  // What was too long is not known.
  run_ticks(20 + kMostLostPlaces + 1, 20 + kMostLostPlaces + 2);
  EXPECT_EQ(agent_->coverage()->steps_held(author_of(0)), 21);
}

TEST_F(Reckoning, InRealTimePlacesOfAVehicleWithoutNewCommandsDoNotCount) {
  begin(dead_reckoning_mission(Pace::kRealtime));  // an old command is held for 5 ticks
  hear_block(their_path(0, 1));
  for (Tick tick = 0; tick < 12; ++tick)
    deliver(*agent_, world_answered(tick, std::min<Tick>(tick - 1, 3)));
  expect_foreseen(foreseen(mission_, 0, 11, their_path(0, 9), 1, 3));
}

TEST_F(Reckoning, InLockstepNoAgentAnswersBeforeAllPartsOfTheWorldsStateAreThere) {
  begin(dead_reckoning_mission());
  hear_block(their_path(0, 1));
  WorldState first = world_answered(0, -1), second = first;
  first.parts = second.parts = 2;
  second.part = 1;
  first.vehicle_count = second.vehicle_count = 1;
  second.vehicles[0] = second.vehicles[1];
  EXPECT_TRUE(only<Command>(deliver(*agent_, first)).empty());
  EXPECT_EQ(status_after(*agent_, at(0s)).waiting_for, kWorld);
  EXPECT_EQ(only<Command>(deliver(*agent_, second)).size(), 1u);
  expect_foreseen(foreseen(mission_, 0, 0, their_path(0, 1), 1, 0));
}

// A vehicle whose agent has left is in the states of the world that knew it, and of no later one.
TEST_F(Reckoning, ARestartedWorldsStateNeedsNoPartOfTheWorldBefore) {
  begin(dead_reckoning_mission());
  hear_block(their_path(0, 1));
  WorldState before = world_answered(0, -1);
  before.parts = 2;
  EXPECT_TRUE(only<Command>(deliver(*agent_, before)).empty());
  WorldState whole = world_answered(0, -1);
  whole.header.incarnation = kWorldLife + 1;
  EXPECT_EQ(only<Command>(deliver(*agent_, whole)).size(), 1u);
}

TEST_F(Reckoning, InRealTimeAMissingPartHoldsUpNoAgent) {
  begin(dead_reckoning_mission(Pace::kRealtime));
  WorldState first = world_answered(0, -1);
  first.parts = 2;
  EXPECT_EQ(only<Command>(deliver(*agent_, first)).size(), 1u);
}

}  // namespace
}  // namespace ergocast
