// SPDX-License-Identifier: BSD-3-Clause
// The distributed team is the paper's team: agents with only each other's messages take the same
// steps, bit for bit, as agents with perfect communication.
#include <gtest/gtest.h>

#include <sstream>

#include "lab/swarm.h"
#include "logger/recorder.h"
#include "tests/support/paper_team.h"
#include "team/plan.h"

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
  const auto file = std::filesystem::path(ERGOCAST_SCENARIO_DIR) / (name + ".textproto");
  const auto scenario = std::get<Scenario>(Scenario::load(file, overrides));
  std::ostringstream trajectory, metrics;
  lab::Options options;
  options.plan = encode_plan(scenario.mission());
  options.agents = static_cast<int>(scenario.mission().starts_m.size());
  lab::Swarm(std::move(options), trajectory, metrics).run();

  const auto recorded = positions(trajectory.str());
  ASSERT_EQ(recorded.size(), 600U);
  PaperTeam team(scenario.mission());
  for (std::size_t tick = 0; tick < recorded.size(); ++tick) {
    for (std::size_t i = 0; i < team.size(); ++i) {
      ASSERT_EQ(recorded[tick][i], team.x_m(i)) << name << ", tick " << tick << ", agent " << i;
    }
    team.step();
  }
}

TEST(SameAsSwarm, ClassicalLaw) { expect_same("paper_fig1b"); }
TEST(SameAsSwarm, PapersLaw) { expect_same("paper_fig2a"); }
TEST(SameAsSwarm, RecommendedLaw) { expect_same("quadrimodal_corners"); }
// Their world's state comes in two parts.
TEST(SameAsSwarm, RecommendedLawOfTwentyAgents) {
  Overrides overrides;
  overrides.agents = 20;
  expect_same("quadrimodal_corners", overrides);
}

}  // namespace
}  // namespace ergocast::test
