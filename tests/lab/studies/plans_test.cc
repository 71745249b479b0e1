// SPDX-License-Identifier: BSD-3-Clause
// Announced plans: the adjoint against finite differences, the trust region, what others expect.
#include <gtest/gtest.h>

#include <cmath>

#include "core/noise.h"
#include "lab/studies/plans/plan_team.h"

namespace ergocast::studies {
namespace {

constexpr double kRounding = 1e-9;

Eigen::Vector3d drawn(std::uint32_t who, int step) {
  return on_ground(normal_pair(7, Purpose::kFault, who, static_cast<std::uint64_t>(step)));
}

/// A domain off the origin with more modes along y than along x, and a target without symmetry.
Mission mission_of(int agents) {
  Mission mission;
  mission.seed = 5;
  mission.domain = {{-300, 40, 0}, {2000, 1500, 0}};
  mission.basis.modes_x = 7;
  mission.basis.modes_y = 9;
  mission.target_coefficients = 0.5 * (basis_values({200, 400, 0}, mission.domain, mission.basis) +
                                       basis_values({1300, 900, 0}, mission.domain, mission.basis));
  mission.law.u_max_mps = 20;
  mission.law.regularization = Regularization::kRelative;
  mission.law.epsilon = 0.05;
  mission.law.noise_intensity = 1;
  mission.law.ends_with_plan = true;
  mission.timing.tick_count = 3000;
  for (int i = 0; i < agents; ++i)
    mission.starts_m.push_back(random_start(mission.domain, mission.seed, i));
  return mission;
}

/// Three agents in the middle of a mission, with the first node partly executed.
Outlook outlook_of(const Mission& mission, const PlanSetting& setting, Tick tick) {
  Outlook outlook;
  outlook.durations_s.resize(static_cast<std::size_t>(setting.nodes));
  PlanClock(mission, setting).remaining_s(tick, outlook.durations_s);
  const auto modes = static_cast<std::size_t>(mission.basis.mode_count());
  outlook.known_agents = 3;
  outlook.covered_s = 3 * mission.timing.dt_s * static_cast<double>(tick + 1);
  outlook.known_s.resize(modes);
  add_gain(mission, 1, {100, 300, 0}, {3, 2, 0}, outlook.covered_s, outlook.known_s.data());
  outlook.others_s.resize(modes * outlook.durations_s.size());
  for (std::size_t h = 0; h < outlook.durations_s.size(); ++h) {
    for (const double x_m : {400.0, 1100.0}) {
      add_gain(mission, 1, {x_m, 700, 0}, {5.0 * static_cast<double>(h), 1, 0},
               outlook.durations_s[h], outlook.others_s.data() + h * modes);
    }
  }
  return outlook;
}

Nodes nodes_of(const PlanSetting& setting) {
  Nodes nodes(3, setting.nodes);
  for (int h = 0; h < setting.nodes; ++h) nodes.col(h) = 8 * drawn(1, h);
  return nodes;
}

class Adjoint : public ::testing::TestWithParam<std::pair<int, Tick>> {};

TEST_P(Adjoint, IsTheSlopeByOnesOwnNodes) {
  const Mission mission = mission_of(3);
  const auto [points, tick] = GetParam();
  PlanSetting setting;
  setting.nodes = 12;
  setting.points = points;
  const Outlook outlook = outlook_of(mission, setting, tick);
  PlanCost cost(mission, setting);
  Nodes nodes = nodes_of(setting), slope = nodes, unused = nodes;
  const Eigen::Vector3d x_m(150, 900, 0);
  cost(outlook, x_m, nodes, slope);
  const double greatest = slope.cwiseAbs().maxCoeff();
  ASSERT_GT(greatest, 0);
  for (Eigen::Index i = 0; i < nodes.size(); ++i) {
    const double here = nodes.data()[i], apart = 1e-4;
    nodes.data()[i] = here + apart;
    const double above = cost(outlook, x_m, nodes, unused);
    nodes.data()[i] = here - apart;
    const double below = cost(outlook, x_m, nodes, unused);
    nodes.data()[i] = here;
    EXPECT_NEAR(slope.data()[i], (above - below) / (2 * apart), 1e-6 * greatest) << i;
  }
}

// The last two end within the horizon: 30 s and 20.1 s are left, and 0.1 s of the first node.
INSTANTIATE_TEST_SUITE_P(Plans, Adjoint,
                         ::testing::Values(std::pair(1, 1234), std::pair(3, 1234),
                                           std::pair(1, 2699), std::pair(2, 2799)));

TEST(PlanCost, IsTheMetricToComeForOneNode) {
  const Mission mission = mission_of(1);
  PlanSetting setting;
  setting.nodes = 1;
  setting.points = 50;  // one each tick
  setting.run_weight = 0;
  const Eigen::Vector3d x_m(150, 900, 0), v_mps(12, -7, 0);
  Outlook outlook;
  outlook.durations_s = {5};
  const auto modes = static_cast<std::size_t>(mission.basis.mode_count());
  outlook.known_s.resize(modes);
  outlook.others_s.resize(modes);
  // Three agents at one place for 10 s; two of them stay there.
  const Eigen::Vector3d there_m(800, 500, 0);
  outlook.known_agents = 3;
  outlook.covered_s = 30;
  add_gain(mission, 1, there_m, {0, 0, 0}, 30, outlook.known_s.data());
  add_gain(mission, 1, there_m, {0, 0, 0}, 10, outlook.others_s.data());
  Coefficients coverage = 40 * basis_values(there_m, mission.domain, mission.basis);
  for (int i = 0; i < 50; ++i) {
    const Eigen::Vector3d place_m = x_m + (i + 0.5) * 0.1 * v_mps;
    coverage += 0.1 * basis_values(place_m, mission.domain, mission.basis);
  }
  Nodes nodes = v_mps, slope = nodes;
  EXPECT_NEAR(PlanCost(mission, setting)(outlook, x_m, nodes, slope),
              ergodic_metric(coverage / 45, mission.target_coefficients,
                             sobolev_weights(mission.basis, mission.domain)),
              kRounding);
}

TEST(Planner, StaysWithinTheTrustRegionAndTheGreatestSpeed) {
  const Mission mission = mission_of(3);
  PlanSetting setting;
  setting.step = 0.2;
  Planner planner(mission, setting);
  planner.draw(1, {15, 5, 0});
  planner.announce();
  const Outlook outlook = outlook_of(mission, setting, 1234);
  double farthest_mps = 0;
  for (int i = 0; i < 50; ++i) {
    planner.improve(outlook, {150, 900, 0}, true);
    const double away_mps = (planner.nodes() - planner.announced()).colwise().norm().maxCoeff();
    EXPECT_LE(away_mps, 0.1 * 20 * (1 + kRounding));
    EXPECT_LE(planner.nodes().colwise().norm().maxCoeff(), 20 * (1 + kRounding));
    farthest_mps = std::max(farthest_mps, away_mps);
  }
  EXPECT_NEAR(farthest_mps, 2, kRounding) << "the region never bound";
  planner.improve(outlook, {150, 900, 0}, false);
  EXPECT_GT((planner.nodes() - planner.announced()).colwise().norm().maxCoeff(), 2);
}

TEST(PlanTeam, KeepsEveryPlanWithinTheTrustRegionWhileItFlies) {
  const Mission mission = mission_of(3);
  PlanSetting setting;
  setting.loss = 0.3;
  PlanTeam team(mission, setting);
  const auto from = static_cast<Tick>(0.5 * 2000 / 20 / 0.1);
  double farthest_mps = 0;
  while (team.tick() < mission.timing.tick_count) {
    team.step();
    if (team.tick() <= from) continue;
    for (std::size_t i = 0; i < 3; ++i) {
      const Planner& planner = team.planner(i);
      farthest_mps = std::max(farthest_mps,
                              (planner.nodes() - planner.announced()).colwise().norm().maxCoeff());
      ASSERT_TRUE(mission.domain.contains(team.x_m(i)));
    }
  }
  EXPECT_NEAR(farthest_mps, 2, kRounding);
}

TEST(PlanTeam, FliesItsNodesAndTheirMirrorImageBehindEachEdge) {
  Mission mission = mission_of(2);
  mission.law.noise_intensity = 0;
  PlanSetting setting;
  setting.nodes = 40;
  setting.step = 0;  // the first plan as it was drawn
  PlanTeam team(mission, setting);
  team.step();
  const Nodes nodes[] = {team.planner(0).nodes(), team.planner(1).nodes()};
  Eigen::Vector3d straight_m[] = {mission.starts_m[0], mission.starts_m[1]};
  Coefficients coverage = Coefficients::Zero(mission.basis.mode_count());
  bool left = false;
  for (Tick tick = 0; tick < 1999; ++tick) {
    if (tick > 0) team.step();
    for (std::size_t i = 0; i < 2; ++i) {
      coverage += basis_values(straight_m[i], mission.domain, mission.basis) /
                  static_cast<double>(2 * 1999);
      straight_m[i] += 0.1 * nodes[i].col(tick / 50);
      ASSERT_LT((team.x_m(i) - reflect(straight_m[i], mission.domain)).norm(), 1e-6) << tick;
      left |= !mission.domain.contains(straight_m[i]);
    }
  }
  EXPECT_TRUE(left) << "no edge was met";
  EXPECT_NEAR(team.metric(),
              ergodic_metric(coverage, mission.target_coefficients,
                             sobolev_weights(mission.basis, mission.domain)),
              kRounding);
}

TEST(PlanTeam, OfWhichNothingIsHeardFliesAsOneAgentAlone) {
  PlanSetting deaf;
  deaf.loss = 1;
  PlanTeam alone(mission_of(1), PlanSetting()), team(mission_of(3), PlanSetting());
  PlanTeam unheard(mission_of(3), deaf);
  for (int tick = 0; tick < 600; ++tick) {
    for (PlanTeam* each : {&alone, &team, &unheard}) each->step();
    ASSERT_EQ(unheard.x_m(0), alone.x_m(0)) << tick;
    // Plans announced at tick 1 and received at tick 2 change the plan there, and the place after
    // it.
    ASSERT_EQ(team.x_m(0) == alone.x_m(0), tick < 2) << tick;
  }
}

/// An agent that follows its announcement is exactly where others expect it.
TEST(Announcement, ContinuesAsItsAuthorFlies) {
  const Mission mission = mission_of(1);
  PlanSetting setting;
  setting.nodes = 6;
  const Nodes nodes = nodes_of(setting);
  const auto modes = static_cast<std::size_t>(mission.basis.mode_count());
  Announcement sent(mission, setting, 1234, std::vector<double>(modes), {150, 900, 0}, nodes);
  Eigen::Vector3d x_m(150, 900, 0);
  std::vector<double> sums_s(modes);
  for (Tick tick = 1234; tick < 1363; ++tick) {
    x_m += 0.1 * nodes.col(tick / 50 - 1234 / 50);
    add_gain(mission, 1, x_m, {0, 0, 0}, 0.1, sums_s.data());
  }
  sent.advance(1300);
  sent.advance(1363);
  EXPECT_LT((sent.x_m() - x_m).norm(), kRounding);
  EXPECT_EQ(sent.nodes().col(0), nodes.col(3));
  EXPECT_TRUE(sent.nodes().col(5).isZero());
  for (std::size_t k = 0; k < modes; ++k) EXPECT_NEAR(sent.sums_s()[k], sums_s[k], kRounding);
  const Announcement anew(mission, setting, 1363, sent.sums_s(), sent.x_m(), sent.nodes());
  for (std::size_t k = 0; k < sent.gains_s().size(); ++k)
    EXPECT_NEAR(sent.gains_s()[k], anew.gains_s()[k], kRounding);
}

}  // namespace
}  // namespace ergocast::studies
