// SPDX-License-Identifier: BSD-3-Clause
// The distributed team is the paper's team: agents with only each other's messages take the same
// steps, bit for bit, as agents with perfect communication.
#include <gtest/gtest.h>

#include <sstream>

#include "tests/support/simulated_team.h"

namespace ergocast::test {
namespace {

/// Positions by tick and agent from a trajectory table.
std::vector<std::vector<Eigen::Vector3d>> positions(const std::string& table) {
  std::vector<std::vector<Eigen::Vector3d>> found;
  std::istringstream lines(table);
  std::string line;
  std::getline(lines, line);
  while (std::getline(lines, line)) {
    std::istringstream fields(line);
    char comma = 0;
    std::size_t tick = 0, agent = 0;
    double t_s = 0, x_m = 0, y_m = 0;
    fields >> tick >> comma >> t_s >> comma >> agent >> comma >> x_m >> comma >> y_m;
    if (found.size() <= tick) found.resize(tick + 1);
    EXPECT_EQ(found[tick].size(), agent);
    found[tick].emplace_back(x_m, y_m, 0);
  }
  return found;
}

void expect_same(const std::string& name, Overrides overrides = {}) {
  overrides.duration_s = 60;
  const Mission mission = shipped_mission(name, overrides);
  SimulatedTeam simulated(mission);
  simulated.run();

  const auto recorded = positions(simulated.trajectory.str());
  ASSERT_EQ(recorded.size(), 600U);
  PaperTeam team(mission);
  for (std::size_t tick = 0; tick < recorded.size(); ++tick) {
    for (std::size_t i = 0; i < team.size(); ++i) {
      ASSERT_EQ(recorded[tick][i], team.x_m(i)) << name << ", tick " << tick << ", agent " << i;
    }
    team.step();
  }
}

TEST(SameAsSimulation, ClassicalLaw) { expect_same("paper_fig1b"); }
TEST(SameAsSimulation, PapersLaw) { expect_same("paper_fig2a"); }
TEST(SameAsSimulation, RecommendedLaw) { expect_same("quadrimodal_corners"); }
// Their world's state comes in two parts.
TEST(SameAsSimulation, RecommendedLawOfTwentyAgents) {
  Overrides overrides;
  overrides.agents = 20;
  expect_same("quadrimodal_corners", overrides);
}

}  // namespace
}  // namespace ergocast::test
