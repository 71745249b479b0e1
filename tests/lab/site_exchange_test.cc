// SPDX-License-Identifier: BSD-3-Clause
// Teams divided into sites, against the same team in which every agent receives all.
#include "lab/site_exchange.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>
#include <string>

#include "lab/ideal_team.h"
#include "scenario/scenario.h"

namespace ergocast::lab {
namespace {

Mission mission_of(const std::string& agents) {
  const std::string text =
      "domain { size_x_m: 1000 size_y_m: 1000 } "
      "target { gaussians { mean_x_m: 700 mean_y_m: 300 sigma_m: 150 } } "
      "basis { modes_x: 8 modes_y: 8 } law { u_max_mps: 20 } "
      "time { dt_s: 0.5 duration_s: 100 } agents { " +
      agents + " }";
  return Scenario::parse(text, "sites").value().mission();
}

/// The greatest distance between the same agents of the two teams.
double distance_m(const IdealTeam& a, const IdealTeam& b) {
  double greatest_m = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    greatest_m = std::max(greatest_m, (a.x_m(i) - b.x_m(i)).norm());
  return greatest_m;
}

double distance_after(int steps, const Mission& mission, const SiteRules& rules) {
  IdealTeam whole(mission), divided(mission);
  divided.divide(rules);
  for (int i = 0; i < steps; ++i) {
    whole.step();
    divided.step();
  }
  return distance_m(whole, divided);
}

TEST(SiteExchange, WithFreshRowsIsATeamInWhichEveryAgentReceivesAll) {
  for (const int sites : {1, 2, 5, 12})
    EXPECT_LT(distance_after(40, mission_of("random_count: 12"), {sites, 1, 0}), 1e-6) << sites;
}

TEST(SiteExchange, TheSameHoldsWhereKindsDiffer) {
  const Mission mission = mission_of(
      "kind { name: \"good\" count: 3 quality: 5 } "
      "kind { name: \"wide\" count: 3 footprint_sigma_m: 100 } random_count: 6");
  EXPECT_LT(distance_after(40, mission, {3, 1, 0}), 1e-6);
}

TEST(SiteExchange, ACutChangesNothingBeforeItBegins) {
  const Mission mission = mission_of("random_count: 12");
  EXPECT_LT(distance_after(20, mission, {3, 1, 0, 20, 40}), 1e-6);
  EXPECT_GT(distance_after(60, mission, {3, 1, 0, 20, 40}), 1);
  EXPECT_GT(distance_after(60, mission, {2, 1, 0, 20, 40}), 1);
}

TEST(SiteExchange, RareOrLostRowsChangeWhatAgentsKnow) {
  const Mission mission = mission_of("random_count: 12");
  EXPECT_GT(distance_after(40, mission, {4, 10, 0}), 1);
  EXPECT_GT(distance_after(40, mission, {4, 1, 0.5}), 1);
}

TEST(SiteExchange, RefusesATeamThatItCannotDivide) {
  IdealTeam team(mission_of("random_count: 3"));
  EXPECT_THROW(team.divide({4, 1, 0}), std::logic_error);
  EXPECT_THROW(team.divide({0, 1, 0}), std::logic_error);
  IdealTeam by_broadcasts(mission_of("random_count: 3 dead_reckoning: false"));
  EXPECT_THROW(by_broadcasts.divide({2, 1, 0}), std::logic_error);
}

}  // namespace
}  // namespace ergocast::lab
