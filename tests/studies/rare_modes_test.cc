// SPDX-License-Identifier: BSD-3-Clause
// High modes that are sent every few periods: with dead reckoning, a lockstep mission is the same
// bit for bit; else they cost little. docs/network.md has the figures of many more
// seeds, from
//
//   ergocast study scenarios/quadrimodal_corners.textproto --set basis.modes_x=20
//     --set basis.modes_y=20 --set agents.dead_reckoning=false --vary agents.random_count=0,12
//     --vary time.broadcast_period_ticks=5,20 --vary time.high_mode_period_factor=1,4,10
//     --seeds 1:200 --out runs/rare
#include <gtest/gtest.h>

#include <cmath>

#include "lab/ideal_team.h"
#include "plan/plan.h"
#include "scenario/scenario.h"
#include "studies/study_run.h"

namespace ergocast {
namespace {

Mission mission_of(const std::string& file, const char* factor, const char* period_ticks,
                   const char* dead_reckons, std::uint64_t seed) {
  Overrides overrides;
  overrides.seed = seed;
  overrides.duration_s = 30;
  overrides.fields = {{"time.high_mode_period_factor", factor, ""},
                      {"time.broadcast_period_ticks", period_ticks, ""},
                      {"agents.dead_reckoning", dead_reckons, ""}};
  const auto loaded =
      Scenario::load(std::string(ERGOCAST_SCENARIO_DIR) + '/' + file + ".textproto", overrides);
  return loaded.value().mission();
}

double metric_of(const Mission& mission) {
  return studies::run_with_messages(encode_plan(mission)).metric;
}

TEST(RareModes, ChangeNoBitWhereAgentsReckon) {
  for (const char* file : {"quadrimodal_corners", "cube_corners"}) {
    const Mission usual = mission_of(file, "1", "5", "true", 1);
    const Mission rare = mission_of(file, "4", "5", "true", 1);
    EXPECT_TRUE(lab::IdealTeam::stands_for(rare));
    const double metric = metric_of(usual);
    EXPECT_EQ(metric_of(rare), metric) << file;
    EXPECT_EQ(studies::run_without_messages(rare).metric, metric);
  }
}

TEST(RareModes, CostLittleWhereAgentsKnowOnlyWhatIsSent) {
  constexpr int kSeeds = 8;
  double log_ratio = 0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const Mission usual = mission_of("quadrimodal_corners", "1", "5", "false", seed);
    const Mission rare = mission_of("quadrimodal_corners", "4", "5", "false", seed);
    EXPECT_FALSE(lab::IdealTeam::stands_for(rare));
    const double exact = metric_of(usual), late = metric_of(rare);
    EXPECT_NE(exact, late) << "they are late";
    log_ratio += std::log(late / exact) / kSeeds;
  }
  EXPECT_LE(std::abs(log_ratio), 0.1);
}

TEST(RareModes, AnIdealTeamDoesNotStandForThemWhereAllElseIsSentEachTick) {
  EXPECT_TRUE(lab::IdealTeam::stands_for(mission_of("quadrimodal_corners", "1", "1", "false", 1)));
  EXPECT_FALSE(lab::IdealTeam::stands_for(mission_of("quadrimodal_corners", "2", "1", "false", 1)));
}

}  // namespace
}  // namespace ergocast
