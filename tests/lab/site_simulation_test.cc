// SPDX-License-Identifier: BSD-3-Clause
// A team of sites in one process, and its record.
#include "lab/site_simulation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include "lab/simulation.h"
#include "plan/plan.h"
#include "scenario/scenario.h"

namespace ergocast::lab {
namespace {

/// @param team  the sites; empty: none
std::vector<std::byte> plan_of(const std::string& team, const std::string& agents,
                               double duration_s) {
  const std::string text =
      "domain { size_x_m: 1000 size_y_m: 1000 } "
      "target { gaussians { mean_x_m: 700 mean_y_m: 300 sigma_m: 150 } } "
      "basis { modes_x: 8 modes_y: 8 } law { u_max_mps: 20 } " +
      team + " time { dt_s: 0.5 duration_s: " + std::to_string(duration_s) + " } agents { " +
      agents + " }";
  return encode_plan(Scenario::parse(text, "sites").value().mission());
}

/// The numbers of a table, without its header.
std::vector<double> numbers_of(const std::string& table) {
  std::istringstream lines(table);
  std::string line;
  std::getline(lines, line);
  std::vector<double> numbers;
  while (std::getline(lines, line)) {
    std::ranges::replace(line, ',', ' ');
    std::istringstream words(line);
    for (double number = 0; words >> number;) numbers.push_back(number);
  }
  return numbers;
}

struct Record {
  std::ostringstream trajectory, metrics;
};

TEST(SiteSimulation, WithFreshRowsHasTheTrajectoryOfATeamThatSendsAll) {
  Record of_sites, of_all;
  SiteSimulation sites(
      plan_of("team { sites: 5 site_row_period_ticks: 1 }", "random_count: 12", 20),
      of_sites.trajectory, of_sites.metrics);
  while (sites.step()) {
  }
  Simulation all({.plan = plan_of("", "random_count: 12", 20)}, of_all.trajectory, of_all.metrics);
  all.run();
  const auto a = numbers_of(of_sites.trajectory.str()), b = numbers_of(of_all.trajectory.str());
  ASSERT_EQ(a.size(), 40U * 12 * 7);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) ASSERT_NEAR(a[i], b[i], 1e-6) << "number " << i;
  EXPECT_EQ(sites.recorder().run(), all.recorder().run());
  EXPECT_STREQ(sites.recorder().result(), "done");
  EXPECT_EQ(sites.recorder().reason(), all.recorder().reason());
  EXPECT_NEAR(sites.recorder().facts().ergodic_metric_last,
              all.recorder().facts().ergodic_metric_last, 1e-9);
}

TEST(SiteSimulation, RecordsTheKindsOfAgents) {
  Record record;
  SiteSimulation sites(plan_of("team { sites: 2 }",
                               "kind { name: \"a\" count: 3 quality: 5 } "
                               "kind { name: \"b\" count: 3 } random_count: 6",
                               5),
                       record.trajectory, record.metrics);
  while (sites.step()) {
  }
  const auto& roster = sites.recorder().follower().roster();
  ASSERT_EQ(roster.size(), 6U);
  EXPECT_EQ(roster[2].kind, 0);
  EXPECT_EQ(roster[3].kind, 1);
}

TEST(SiteSimulation, HasMoreAgentsThanATeamThatSendsMessages) {
  Record record;
  SiteSimulation sites(plan_of("team { sites: 30 }", "random_count: 1500", 2), record.trajectory,
                       record.metrics);
  while (sites.step()) {
  }
  EXPECT_STREQ(sites.recorder().result(), "done");
  EXPECT_EQ(numbers_of(record.trajectory.str()).size(), 4U * 1500 * 7);
}

TEST(SiteSimulation, EndsBeforeItsTime) {
  Record record;
  SiteSimulation sites(plan_of("team { sites: 2 }", "random_count: 4", 20), record.trajectory,
                       record.metrics);
  for (int i = 0; i < 5; ++i) EXPECT_TRUE(sites.step());
  sites.end("a test");
  EXPECT_FALSE(sites.step());
  EXPECT_STREQ(sites.recorder().result(), "stopped");
  EXPECT_EQ(sites.recorder().reason(), "a test");
  EXPECT_EQ(sites.recorder().facts().ticks, 5);
}

TEST(SiteSimulation, IsTheOnlyTeamThatFollowsSuchAPlan) {
  Record record;
  Simulation simulation({.plan = plan_of("team { sites: 2 }", "random_count: 4", 20)},
                        record.trajectory, record.metrics);
  simulation.run(seconds(60));
  EXPECT_TRUE(simulation.agent(0).failed());
  EXPECT_EQ(simulation.agent(0).reason(),
            "a team of sites runs in ergocast simulate and study only, because no process sends "
            "rows of sites yet: leave out team.sites");
  EXPECT_EQ(simulation.recorder().facts().ticks, 0);
}

}  // namespace
}  // namespace ergocast::lab
