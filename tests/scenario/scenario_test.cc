// SPDX-License-Identifier: BSD-3-Clause
// The result of a valid scenario: defaults, overrides, random starts, print(), the shipped files.
#include "scenario/scenario.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/measure/drift.h"
#include "tests/scenario/scenarios.h"

namespace ergocast {
namespace {

using namespace test;

TEST(Defaults, FillWhateverIsLeftOut) {
  const Scenario scenario = good(kSmall);
  const Mission& mission = scenario.mission();

  EXPECT_EQ(scenario.name(), "small");
  EXPECT_EQ(mission.name, "small");
  EXPECT_EQ(scenario.description(), "");
  EXPECT_EQ(mission.seed, 1u);
  EXPECT_EQ(mission.domain.origin_m, Eigen::Vector3d(0, 0, 0));
  EXPECT_EQ(mission.domain.size_m, Eigen::Vector3d(100, 50, 0));
  EXPECT_EQ(mission.basis.modes_x, 16);
  EXPECT_EQ(mission.basis.modes_y, 16);
  EXPECT_EQ(mission.basis.sobolev_form, SobolevForm::kSquaredNorm);
  EXPECT_EQ(mission.basis.sobolev_exponent, 1.5);
  EXPECT_FALSE(mission.basis.normalized);
  EXPECT_EQ(mission.law.u_max_mps, 5);
  EXPECT_EQ(mission.law.regularization, Regularization::kRelative);
  EXPECT_EQ(mission.law.epsilon, 0.05);
  EXPECT_EQ(mission.law.perturbation, Perturbation::kAdaptive);
  EXPECT_EQ(mission.law.anticipation, 2);
  EXPECT_TRUE(mission.law.paired_pushes);
  EXPECT_TRUE(mission.law.ends_with_plan);
  EXPECT_TRUE(mission.dead_reckoning);
  EXPECT_DOUBLE_EQ(mission.law.noise_ceiling, std::sqrt(5 * 0.5));
  EXPECT_DOUBLE_EQ(mission.law.noise_intensity, 0.05 * std::sqrt(5 * 0.5));
  EXPECT_DOUBLE_EQ(mission.law.contraction_gain_per_s, 0.05 / std::hypot(50, 25));
  EXPECT_EQ(mission.law.contraction_center_m, Eigen::Vector3d(50, 25, 0));
  EXPECT_EQ(mission.timing.dt_s, 0.1);
  EXPECT_EQ(mission.timing.tick_count, 600);
  EXPECT_EQ(mission.timing.broadcast_period_ticks, 10);
  EXPECT_EQ(mission.timing.pace, Pace::kLockstep);
  EXPECT_EQ(mission.timing.realtime_factor, 1);
  EXPECT_EQ(mission.timing.lockstep_timeout_s, 10);
  EXPECT_EQ(mission.timing.on_timeout, OnTimeout::kEndMission);
  EXPECT_EQ(mission.timing.command_hold_s, 0.5);
  EXPECT_EQ(mission.timing.admission_timeout_s, 30);
  EXPECT_EQ(mission.timing.catch_up_limit_ticks, 5);
  EXPECT_EQ(mission.starts_m, std::vector<Eigen::Vector3d>{Eigen::Vector3d(10, 20, 0)});
  EXPECT_EQ(mission.quorum, 1);
  EXPECT_EQ(mission.disturbance_intensity, 0);
  EXPECT_EQ(mission.forget_silent_after_s, 0);
  EXPECT_EQ(mission.radio_range_m, 0);
  EXPECT_EQ(mission.speed_limit_mps, 0) << "none";
  EXPECT_EQ(mission.goal_ergodic_metric, 0);
}

TEST(Defaults, OfNoiseRiseWithTheFloorThatIsGiven) {
  const ControlLaw law = good(small_with("law {", "law { noise_intensity: 7")).mission().law;
  EXPECT_EQ(law.noise_intensity, 7);
  EXPECT_EQ(law.noise_ceiling, 7);
}

/// A law without a forecast is exactly that of version 0.1.0, the paper's or the classical one.
TEST(Defaults, OfALawThatDoesNotLookAheadStayWhatTheyWere) {
  for (const auto& [law, epsilon] :
       {std::pair{"anticipation: 0", 0.2}, std::pair{"perturbation: CONSTANT", 0.2},
        std::pair{"regularization: ABSOLUTE", 0.0}}) {
    SCOPED_TRACE(law);
    const ControlLaw got =
        good(small_with("law { u_max_mps: 5 }", std::string("law { u_max_mps: 5 ") + law + " }"))
            .mission()
            .law;
    EXPECT_EQ(got.anticipation, 0);
    EXPECT_EQ(got.epsilon, epsilon);
    EXPECT_FALSE(got.paired_pushes);
    EXPECT_FALSE(got.ends_with_plan);
  }
}

TEST(Defaults, ConstantNoiseHasNoCeiling) {
  const Scenario scenario = good(small_with("law {", "law { perturbation: CONSTANT"));
  EXPECT_EQ(scenario.mission().law.perturbation, Perturbation::kConstant);
  EXPECT_EQ(scenario.print().find("noise_ceiling"), std::string::npos);
  EXPECT_DOUBLE_EQ(scenario.mission().law.max_noise(), 0.05 * std::sqrt(5 * 0.5));
}

TEST(Defaults, AbsoluteRegularizationIsClassicalUnlessEpsilonIsGiven) {
  EXPECT_EQ(good(small_with("law {", "law { regularization: ABSOLUTE")).mission().law.epsilon, 0);
}

TEST(Defaults, OnlyTheRecommendedLawLooksAhead) {
  for (const char* other : {"law { regularization: ABSOLUTE", "law { perturbation: CONSTANT"}) {
    EXPECT_EQ(good(small_with("law {", other)).mission().law.anticipation, 0) << other;
  }
  const ControlLaw law = good(small_with("law {", "law { anticipation: 0")).mission().law;
  EXPECT_EQ(law.epsilon, 0.2) << "a relative one, where no agent looks ahead";
}

TEST(Defaults, AgentsWithoutDeadReckoningBroadcastEachTick) {
  for (const char* fields : {"law { anticipation: 0", "agents { dead_reckoning: false",
                             "law { perturbation: CONSTANT", "law { regularization: ABSOLUTE"}) {
    const std::string block(fields, std::string_view(fields).find('{') + 1);
    EXPECT_EQ(good(small_with(block, fields)).mission().timing.broadcast_period_ticks, 1) << fields;
  }
  EXPECT_EQ(good(small_with("law {", "law { perturbation: CONSTANT anticipation: 1"))
                .mission()
                .timing.broadcast_period_ticks,
            10);
}

/// The half-life of a scenario with drifting objects, in a domain of 100 m by 50 m.
double half_life_s(const std::string& law, const std::string& motion) {
  return good(small_with("law {", "world { objects { count: 1 " + motion +
                                      " } } sensor { radius_m: 5 } law { " + law))
      .mission()
      .law.memory_half_life_s;
}

TEST(Defaults, ASearchForgetsWhereObjectsCanHaveDrifted) {
  const std::string motion = "motion { speed_mps: 0.1 persistence_s: 20 }";
  const double drifted_s = half_life_s("kind: SEARCH ", motion);
  EXPECT_NEAR(std::sqrt(mean_square_m2({0.1, 20}, drifted_s)), 10, 0.05) << "two radii";
  EXPECT_EQ(drifted_s, std::ceil(drifted_s));
  EXPECT_EQ(half_life_s("kind: SEARCH ", ""), 0) << "nothing drifts";
  EXPECT_EQ(half_life_s("kind: SEARCH memory_half_life_s: 0 ", motion), 0) << "as it is written";
  EXPECT_EQ(half_life_s("kind: SEARCH memory_half_life_s: 77 ", motion), 77);
  for (const char* kind : {"COVER", "MOW"})
    EXPECT_EQ(half_life_s("kind: " + std::string(kind) + ' ', motion), 0) << kind;
  const Scenario fast = good(small_with(
      "law {", "world { objects { count: 1 motion { speed_mps: 5 } } } law { kind: SEARCH "));
  const Mission& mission = fast.mission();
  EXPECT_EQ(mission.law.memory_half_life_s,
            std::ceil(mission.domain.size_m.maxCoeff() / mission.law.u_max_mps))
      << "it takes an agent so long to come back";
}

TEST(Defaults, NameComesFromTheFileAndAlwaysNamesAFolder) {
  const auto name_in = [](const std::string& file) {
    return good(Scenario::parse(kSmall, file)).name();
  };
  EXPECT_EQ(name_in("/a/b/c-1.textproto"), "c-1");
  EXPECT_EQ(name_in("my file.textproto"), "my_file");
  EXPECT_EQ(name_in("é.textproto"), "__");
  EXPECT_EQ(name_in(".."), "_.");
  EXPECT_EQ(name_in(""), "scenario");
  EXPECT_EQ(name_in(std::string(100, 'x')), std::string(64, 'x'));
}

TEST(Reading, TakesEverySpellingOfEveryField) {
  const Mission mission = good(R"(
    domain { origin_x_m: -10 origin_y_m: 5 size_x_m: 100 size_y_m: 50 }
    target {
      gaussians { weight: 2 mean_x_m: 20 mean_y_m: 30 covariance { xx_m2: 25 yy_m2: 16 xy_m2: -4 } }
      uniform_weight: 0.5
    }
    basis { modes_x: 3 modes_y: 4 normalized: true sobolev_form: NORM sobolev_exponent: 2 }
    law { u_max_mps: 5 contraction_center: POINT contraction_x_m: 1 contraction_y_m: 6 }
    time { duration_s: 1 pace: REALTIME on_timeout: EVICT }
    agents {
      starts: [ { x_m: -10 y_m: 5 }, { x_m: 90, y_m: 55 } ] random_count: 1 quorum: 2
      forget_silent_after_s: 60
    }
    world { disturbance_intensity: 0.25 radio_range_m: 40 speed_limit_mps: 60 }
    goal_ergodic_metric: 0.01
  )")
                              .mission();
  EXPECT_EQ(mission.domain.origin_m, Eigen::Vector3d(-10, 5, 0));
  EXPECT_EQ(mission.basis.modes_x, 3);
  EXPECT_EQ(mission.basis.modes_y, 4);
  EXPECT_TRUE(mission.basis.normalized);
  EXPECT_EQ(mission.basis.sobolev_form, SobolevForm::kNorm);
  EXPECT_EQ(mission.law.contraction_center_m, Eigen::Vector3d(1, 6, 0));
  EXPECT_EQ(mission.timing.pace, Pace::kRealtime);
  EXPECT_EQ(mission.timing.on_timeout, OnTimeout::kEvict);
  EXPECT_EQ(mission.starts_m.size(), 3u);
  EXPECT_EQ(mission.quorum, 2);
  EXPECT_EQ(mission.disturbance_intensity, 0.25);
  EXPECT_EQ(mission.forget_silent_after_s, 60);
  EXPECT_EQ(mission.radio_range_m, 40);
  EXPECT_EQ(mission.speed_limit_mps, 60);
  EXPECT_EQ(mission.goal_ergodic_metric, 0.01);
}

TEST(Reading, TargetAndItsCoefficientsBelongTogether) {
  const Scenario scenario = good(small_with(
      "uniform_weight: 1",
      "gaussians { mean_x_m: 20 mean_y_m: 30 covariance { xx_m2: 25 yy_m2: 16 xy_m2: -4 } }"));
  const TargetDensity target{
      {plane_gaussian(1, {20, 30}, (Eigen::Matrix2d() << 25, -4, -4, 16).finished())}, 0};
  const Mission& mission = scenario.mission();
  EXPECT_EQ(mission.target_coefficients,
            target_coefficients(target, mission.domain, mission.basis).values);
}

TEST(Reading, ByteOrderMarkAndWindowsLineEndsDoNoHarm) {
  std::string text = "\xEF\xBB\xBF";
  for (const char c : kSmall) text += c == '\n' ? "\r\n" : std::string(1, c);
  EXPECT_EQ(plan_of(good(text)), plan_of(good(kSmall)));
}

TEST(RandomStarts, AreInsideRepeatAndBelongToTheAgentsNumber) {
  const std::string text = small_with("agents {", "seed: 9 agents { random_count: 1023");
  const std::vector<Eigen::Vector3d> starts = good(text).mission().starts_m;
  ASSERT_EQ(starts.size(), 1024u);
  EXPECT_EQ(starts[0], Eigen::Vector3d(10, 20, 0));
  const Box domain = good(text).mission().domain;
  for (const Eigen::Vector3d& x_m : starts) EXPECT_TRUE(domain.contains(x_m));

  EXPECT_EQ(good(text).mission().starts_m, starts);
  EXPECT_EQ(good(text, {.agents = 5}).mission().starts_m,
            std::vector<Eigen::Vector3d>(starts.begin(), starts.begin() + 5));
  EXPECT_NE(good(text, {.seed = 10}).mission().starts_m[1], starts[1]);
}

TEST(Overrides, AreReadInPlaceOfTheFile) {
  const Mission mission = good(kSmall, {.seed = std::numeric_limits<std::uint64_t>::max(),
                                        .duration_s = 7,
                                        .pace = Pace::kRealtime,
                                        .realtime_factor = 20,
                                        .agents = {}})
                              .mission();
  EXPECT_EQ(mission.seed, std::numeric_limits<std::uint64_t>::max());
  EXPECT_EQ(mission.timing.tick_count, 70);
  EXPECT_EQ(mission.timing.pace, Pace::kRealtime);
  EXPECT_EQ(mission.timing.realtime_factor, 20);
}

TEST(Overrides, StandInForRequiredFields) {
  EXPECT_EQ(good(small_with("time { duration_s: 60 }", ""), {.duration_s = 1})
                .mission()
                .timing.tick_count,
            10);
  EXPECT_EQ(good(small_with("agents { starts { x_m: 10 y_m: 20 } }", ""), {.agents = 3})
                .mission()
                .starts_m.size(),
            3u);
}

TEST(Overrides, AgentsCutTheTeamAndItsQuorum) {
  const std::string text = small_with(
      "agents {", "agents { starts { x_m: 1 y_m: 2 } starts { x_m: 3 y_m: 4 } quorum: 3");
  const Mission smaller = good(text, {.agents = 2}).mission();
  ASSERT_EQ(smaller.starts_m.size(), 2u);
  EXPECT_EQ(smaller.starts_m[1], Eigen::Vector3d(3, 4, 0));
  EXPECT_EQ(smaller.quorum, 2);

  const Mission larger = good(text, {.agents = 6}).mission();
  EXPECT_EQ(larger.starts_m.size(), 6u);
  EXPECT_EQ(larger.quorum, 3);
  EXPECT_EQ(good(kSmall, {.agents = 6}).mission().quorum, 6);
}

TEST(Sites, AllowALargerTeam) {
  const std::string text = small_with("agents {", "team { sites: 2 } agents {");
  EXPECT_EQ(good(text, {.agents = 2048}).mission().starts_m.size(), 2048u);
  EXPECT_TRUE(
      has(joined(problems_of(text, {.agents = 2049})), "team.sites: 1025 agents of a site"));
  EXPECT_TRUE(has(joined(problems_of(text, {.agents = 16385})),
                  "--agents: 16385 is outside the limits 1 to 16384"));
  EXPECT_TRUE(has(joined(problems_of(text, {.agents = 1})),
                  "team.sites: 2 is above the limit, the team's size 1"));
}

TEST(Overrides, TakeTheBlameForWhatTheyBreak) {
  const std::vector<Problem> problems =
      problems_of(kSmall, {.duration_s = -1, .realtime_factor = std::nan(""), .agents = 1025});
  const std::string text = joined(problems);
  EXPECT_EQ(problems.size(), 3u) << text;
  EXPECT_TRUE(has(text, "--duration: -1 is not above 0"));
  EXPECT_TRUE(has(text, "--realtime: nan is not a number"));
  EXPECT_TRUE(has(text, "--agents: 1025 is outside the limits 1 to 1024"));
  EXPECT_TRUE(has(joined(problems_of(kSmall, {.duration_s = 0.01})), "--duration: 0.01 is less"));
  EXPECT_TRUE(has(joined(problems_of(kSmall, {.agents = 0})), "--agents: 0 is"));
}

class Shipped : public ::testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Scenarios, Shipped, ::testing::ValuesIn(kShipped),
                         [](const auto& shipped_name) { return std::string(shipped_name.param); });

TEST_P(Shipped, LoadsUnderItsOwnNameAndRunsInLockstep) {
  const Scenario scenario = good(Scenario::load(shipped(GetParam())));
  EXPECT_EQ(scenario.name(), GetParam());
  EXPECT_FALSE(scenario.description().empty());
  EXPECT_EQ(scenario.mission().timing.pace, Pace::kLockstep);
  EXPECT_EQ(scenario.mission().quorum, static_cast<int>(scenario.mission().starts_m.size()));
}

TEST_P(Shipped, PrintsWhatReadsBackToTheSame) {
  const Scenario scenario = good(Scenario::load(shipped(GetParam())));
  const Scenario again = good(Scenario::parse(scenario.print(), "printed"));
  EXPECT_EQ(plan_of(again), plan_of(scenario));
  EXPECT_EQ(again.description(), scenario.description());
  EXPECT_EQ(again.print(), scenario.print());
}

TEST(Print, ShowsEveryFieldInTheFewestDigits) {
  const std::string text =
      good(small_with("agents {", "description: \"λ, \\\"quoted\\\"\\n2nd\" agents {")).print();
  for (const char* line : {"name: \"small\"",
                           "description: \"λ, \\\"quoted\\\"\\n2nd\"",
                           "seed: 1",
                           "origin_x_m: 0",
                           "size_x_m: 100\n",
                           "modes_x: 16",
                           "normalized: false",
                           "sobolev_form: SQUARED_NORM",
                           "regularization: RELATIVE",
                           "epsilon: 0.05\n",
                           "anticipation: 2\n",
                           "dead_reckoning: true",
                           "perturbation: ADAPTIVE",
                           "noise_ceiling: ",
                           "contraction_gain_per_s: ",
                           "contraction_center: DOMAIN_CENTER",
                           "dt_s: 0.1\n",
                           "contribution_encoding: DOUBLE",
                           "pace: LOCKSTEP",
                           "on_timeout: END_MISSION",
                           "catch_up_limit_ticks: 5",
                           "starts { x_m: 10 y_m: 20 }\n",
                           "random_count: 0",
                           "quorum: 1",
                           "disturbance_intensity: 0"}) {
    EXPECT_TRUE(has(text, line));
  }
}

TEST(Print, KeepsEveryBitOfANumber) {
  for (const char* number : {"0.1234567890123456", "1.7976931348623e-05", "0.30000000000000004",
                             "1e-05", "33.333333333333336"}) {
    const std::string text = small_with("{ x_m: 10", std::string("{ x_m: ") + number);
    const Scenario scenario = good(text);
    EXPECT_EQ(good(scenario.print()).mission().starts_m[0].x(), std::strtod(number, nullptr));
    EXPECT_TRUE(has(scenario.print(), std::string("x_m: ") + number + " "));
  }
}

// The values that reproduce the paper's figures.
void expect_paper(const Scenario& scenario, bool stochastic) {
  const Mission& mission = scenario.mission();
  EXPECT_EQ(mission.domain.origin_m, Eigen::Vector3d(0, 0, 0));
  EXPECT_EQ(mission.domain.size_m, Eigen::Vector3d(2000, 2000, 0));
  TargetDensity target;
  for (const Eigen::Vector2d& mean_m :
       {Eigen::Vector2d(500, 500), {500, 1500}, {1500, 500}, {1500, 1500}}) {
    target.gaussians.push_back(plane_gaussian(1, mean_m, 1e4 * Eigen::Matrix2d::Identity()));
  }
  EXPECT_EQ(mission.target_coefficients,
            target_coefficients(target, mission.domain, mission.basis).values);
  EXPECT_EQ(mission.basis.modes_x, 15);
  EXPECT_EQ(mission.basis.modes_y, 15);
  EXPECT_EQ(mission.basis.sobolev_form, SobolevForm::kSquaredNorm);
  EXPECT_EQ(mission.basis.sobolev_exponent, 1);
  EXPECT_FALSE(mission.basis.normalized);
  EXPECT_EQ(mission.law.u_max_mps, 10);
  EXPECT_EQ(mission.law.regularization, Regularization::kAbsolute);
  EXPECT_EQ(mission.law.epsilon, stochastic ? 1e-3 : 0);
  EXPECT_EQ(mission.law.perturbation, Perturbation::kConstant);
  EXPECT_EQ(mission.law.noise_intensity, stochastic ? 1e-5 : 0);
  EXPECT_EQ(mission.law.contraction_gain_per_s, stochastic ? 1e-3 : 0);
  if (stochastic) {
    EXPECT_EQ(mission.law.contraction_center_m, Eigen::Vector3d(0, 0, 0));
  }
  EXPECT_EQ(mission.timing.dt_s, 0.1);
  EXPECT_EQ(mission.timing.tick_count, 1500);
  EXPECT_EQ(mission.disturbance_intensity, 0);
}

const std::vector<Eigen::Vector3d> kCorners{{0, 0, 0}, {2000, 0, 0}, {0, 2000, 0}, {2000, 2000, 0}};
const std::vector<Eigen::Vector3d> kMidline{{100, 1000, 0}, {300, 1000, 0}, {1300, 1000, 0}};

TEST(ShippedValues, PaperFigures) {
  for (const auto& [name, stochastic, starts] :
       {std::tuple{"paper_fig1a", false, kCorners}, std::tuple{"paper_fig1b", false, kMidline},
        std::tuple{"paper_fig2a", true, kCorners}, std::tuple{"paper_fig2b", true, kMidline}}) {
    SCOPED_TRACE(name);
    const Scenario scenario = good(Scenario::load(shipped(name)));
    expect_paper(scenario, stochastic);
    EXPECT_EQ(scenario.mission().starts_m, starts);
  }
}

TEST(ShippedValues, QuadrimodalCornersIsTheRecommendedLawFromTheWorstStarts) {
  const Mission mission = good(Scenario::load(shipped("quadrimodal_corners"))).mission();
  EXPECT_EQ(mission.starts_m, kCorners);
  EXPECT_EQ(mission.law.regularization, Regularization::kRelative);
  EXPECT_EQ(mission.law.epsilon, 0.05);
  EXPECT_EQ(mission.law.anticipation, 2);
  EXPECT_EQ(mission.law.perturbation, Perturbation::kAdaptive);
  EXPECT_EQ(mission.law.noise_intensity, 1);
  EXPECT_EQ(mission.law.noise_ceiling, 20);
  EXPECT_EQ(mission.law.contraction_gain_per_s, 1e-4);
  EXPECT_EQ(mission.law.contraction_center_m, Eigen::Vector3d(1000, 1000, 0));
}

TEST(ShippedValues, UniformSquareIsThePublishedCase) {
  const Mission mission = good(Scenario::load(shipped("uniform_square"))).mission();
  EXPECT_EQ(mission.domain.size_m, Eigen::Vector3d(1, 1, 0));
  EXPECT_EQ(mission.basis.mode_count(), 2500);
  EXPECT_TRUE(mission.basis.normalized);
  EXPECT_EQ(mission.basis.sobolev_form, SobolevForm::kSquaredNorm);
  EXPECT_EQ(mission.basis.sobolev_exponent, 1.5);
  EXPECT_EQ(mission.law.u_max_mps, 1);
  EXPECT_EQ(mission.law.epsilon, 0);
  EXPECT_EQ(mission.law.noise_intensity, 0);
  EXPECT_EQ(mission.law.contraction_gain_per_s, 0);
  EXPECT_EQ(mission.timing.dt_s, 0.01);
  EXPECT_EQ(mission.timing.tick_count, 20000);
  EXPECT_EQ(mission.starts_m.size(), 4u);
  EXPECT_EQ(mission.target_coefficients.cwiseAbs().sum(), 1);  // μ_00 alone
}

TEST(Scenario, TheLawHasTheSpeedOfTheFastestKindIfEachHasItsOwn) {
  const auto with = [](const std::string& law, const std::string& second) {
    std::string text = small_with("law { u_max_mps: 5 }", law);
    const std::string start = "starts { x_m: 10 y_m: 20 }";
    text.replace(
        text.find(start), start.size(),
        "kind { name: \"a\" count: 1 u_max_mps: 5 } kind { name: \"b\" count: 1 " + second + " }");
    return text;
  };
  const Scenario derived = good(with("", "u_max_mps: 2"));
  EXPECT_EQ(derived.mission().law.u_max_mps, 5);
  EXPECT_EQ(plan_of(derived), plan_of(good(with("law { u_max_mps: 5 }", "u_max_mps: 2"))));
  EXPECT_EQ(plan_of(good(derived.print())), plan_of(derived));
  EXPECT_TRUE(has(joined(problems_of(with("", ""))), "law.u_max_mps: is missing"));
  EXPECT_EQ(problems_of(with("", "u_max_mps: -1")).size(), 1U);
}

TEST(Scenario, AgentsWithoutKindsHaveASensorAndKindsWithoutTheirOwnTakeIt) {
  const std::string start = "starts { x_m: 10 y_m: 20 }";
  const auto agents = [&](const std::string& more) {
    return small_with(start, start + " " + more);
  };
  const std::string kind = "kind { name: \"all\" count: 3 footprint_sigma_m: 4 quality: 2 }";
  const Scenario scenario = good(agents("random_count: 2 footprint_sigma_m: 4 quality: 2"));
  EXPECT_EQ(plan_of(scenario), plan_of(good(agents("random_count: 2 " + kind))));
  EXPECT_EQ(plan_of(good(scenario.print())), plan_of(scenario));
  const Mission mixed = good(agents("footprint_sigma_m: 4 kind { name: \"a\" count: 1 } kind { "
                                    "name: \"b\" count: 1 footprint_sigma_m: 1 }"))
                            .mission();
  EXPECT_EQ(mixed.kinds[0].footprint_sigma_m, 4);
  EXPECT_EQ(mixed.kinds[1].footprint_sigma_m, 1);
  EXPECT_EQ(mixed.kinds[1].quality, 1);
  const auto refused = [&](const std::string& more, const std::string& what) {
    const auto problems = problems_of(agents(more));
    EXPECT_EQ(problems.size(), 1U) << joined(problems);
    EXPECT_TRUE(has(joined(problems), what));
  };
  refused("footprint_sigma_m: -1", "agents.footprint_sigma_m: -1 is below the limit 0");
  refused("quality: 0", "agents.quality: 0 is not above 0");
  refused("footprint_sigma_m: 200", "agents.footprint_sigma_m: 200 is larger than the domain");
}

// 0.7 + 0.1 is less than 0.8.
TEST(Scenario, APlaceOnTheUpperEdgeIsInTheDomainWhateverItsOriginIs) {
  const std::string text = R"(
    domain { origin_x_m: 0.7 origin_y_m: 0.7 size_x_m: 0.1 size_y_m: 0.1 }
    target { uniform_weight: 1 }
    law { u_max_mps: 0.01 }
    time { duration_s: 60 }
    agents {
      starts { x_m: 0.8 y_m: 0.7 }
      kind { name: "one" count: 1 station { x_m: 0.7 y_m: 0.8 } }
    })";
  const Mission mission = good(text).mission();
  EXPECT_EQ(mission.starts_m.front(), Eigen::Vector3d(0.7 + 0.1, 0.7, 0));
  EXPECT_EQ(mission.kinds.front().stations_m.front(), Eigen::Vector3d(0.7, 0.7 + 0.1, 0));
  std::string beyond = text;
  beyond.replace(beyond.find("x_m: 0.8 "), 9, "x_m: 0.800000001 ");
  EXPECT_EQ(problems_of(beyond).size(), 1U);
}

}  // namespace
}  // namespace ergocast
