// SPDX-License-Identifier: BSD-3-Clause
// Fields set by their paths, as --set and --vary do.
#include <gtest/gtest.h>

#include <functional>

#include "tests/scenario/scenarios.h"

namespace ergocast {
namespace {

using namespace test;

Overrides with(const std::string& path, const std::string& value) {
  Overrides overrides;
  overrides.fields.push_back({path, value, "--vary " + path + "=" + value});
  return overrides;
}

/// The problems of a field with this value.
std::string problem_of(const std::string& path, const std::string& value) {
  return joined(problems_of(kSmall, with(path, value)));
}

TEST(Assign, SetsNumbersWordsTruthValuesAndListedFields) {
  EXPECT_EQ(good(kSmall, with("law.epsilon", "1e-5")).mission().law.epsilon, 1e-5);
  EXPECT_EQ(good(kSmall, with("time.broadcast_period_ticks", "10"))
                .mission()
                .timing.broadcast_period_ticks,
            10);
  EXPECT_EQ(good(kSmall, with("law.regularization", "ABSOLUTE")).mission().law.regularization,
            Regularization::kAbsolute);
  EXPECT_TRUE(good(kSmall, with("basis.normalized", "true")).mission().basis.normalized);
  EXPECT_EQ(good(kSmall, with("agents.starts[0].x_m", "33")).mission().starts_m[0],
            Eigen::Vector3d(33, 20, 0));
  EXPECT_EQ(good(kSmall, with("agents.random_count", "3")).mission().starts_m.size(), 4U);
}

TEST(Assign, EqualsTheSameFieldInTheFile) {
  EXPECT_EQ(plan_of(good(kSmall, with("law.u_max_mps", "7"))),
            plan_of(good(small_with("u_max_mps: 5", "u_max_mps: 7"))));
}

TEST(Assign, NamesUnknownFieldsWithWhatWasMeant) {
  EXPECT_EQ(problem_of("law.epsilom", "1"),
            "--vary law.epsilom=1: unknown field \"epsilom\" in Law (did you mean law.epsilon?)\n");
  EXPECT_EQ(
      problem_of("epsilon", "1"),
      "--vary epsilon=1: unknown field \"epsilon\" in Scenario (did you mean law.epsilon?)\n");
  EXPECT_TRUE(has(problem_of("law.zzzzzz", "1"), "the fields there are u_max_mps, "));
  EXPECT_TRUE(has(problem_of("", "1"), "unknown field \"\" in Scenario"));
}

TEST(Assign, RefusesPathsThatNameNoValue) {
  EXPECT_TRUE(
      has(problem_of("law", "1"), "is a block (name one of its fields, such as law.u_max_mps)"));
  EXPECT_TRUE(has(problem_of("agents.starts", "1"), "such as agents.starts[0].x_m"));
  EXPECT_TRUE(has(problem_of("law.epsilon.x", "1"), "epsilon has no fields of its own"));
  EXPECT_TRUE(has(problem_of("agents.starts.x_m", "1"), "say which, such as starts[0]"));
  EXPECT_TRUE(has(problem_of("law[0].epsilon", "1"), "leave out the brackets"));
  for (const char* index : {"[1]", "[-1]", "[]", "[x]", "[0", "[0]]"}) {
    EXPECT_TRUE(has(problem_of("agents.starts" + std::string(index) + ".x_m", "1"),
                    "the scenario lists 1 starts (write [0] to [0])"))
        << index;
  }
  EXPECT_TRUE(
      has(problem_of("target.gaussians[0].sigma_m", "1"), "lists 0 gaussians (list them first)"));
  EXPECT_TRUE(has(problem_of("name", "\"a\""), "is a text"));
}

TEST(Assign, RefusesValuesThatTheFieldDoesNotTakeAndBlamesTheFlag) {
  EXPECT_EQ(problem_of("law.epsilon", "much"),
            "--vary law.epsilon=much: much is not a number (write a number such as 0.5)\n");
  EXPECT_EQ(problem_of("law.epsilon", "-1"),
            "--vary law.epsilon=-1: -1 is below the limit 0 (write a number 0 to 1000000)\n");
  EXPECT_EQ(problem_of("law.regularization", "SOME"),
            "--vary law.regularization=SOME: unknown value \"SOME\" (write one of RELATIVE or "
            "ABSOLUTE)\n");
  EXPECT_TRUE(has(problem_of("time.broadcast_period_ticks", "1.5"), "is not a whole number"));
  EXPECT_TRUE(has(problem_of("law.epsilon", "1 2"), "--vary law.epsilon=1 2: "));
  EXPECT_TRUE(has(problem_of("law.epsilon", ""), "--vary law.epsilon=: "));
}

TEST(Assign, RefusesWhatAnotherFlagSets) {
  const auto printed = [](const std::string& path, const std::string& value,
                          const std::function<void(Overrides&)>& set) {
    Overrides overrides = with(path, value);
    set(overrides);
    return joined(problems_of(kSmall, overrides));
  };
  EXPECT_EQ(printed("seed", "3", [](Overrides& o) { o.seed = 4; }),
            "--vary seed=3: --seed sets it too (leave out one of them)\n");
  EXPECT_TRUE(has(printed("time.duration_s", "3", [](Overrides& o) { o.duration_s = 4; }),
                  "--duration sets it too"));
  EXPECT_TRUE(has(printed("time.pace", "REALTIME", [](Overrides& o) { o.pace = Pace::kLockstep; }),
                  "--lockstep sets it too"));
  EXPECT_TRUE(has(printed("time.realtime_factor", "3",
                          [](Overrides& o) {
                            o.pace = Pace::kRealtime;
                            o.realtime_factor = 1;
                          }),
                  "--realtime sets it too"));
  EXPECT_TRUE(has(printed("agents.random_count", "3", [](Overrides& o) { o.agents = 4; }),
                  "--agents sets it too"));
  EXPECT_TRUE(
      has(printed("law.epsilon", "3", [](Overrides& o) { o.fields.push_back(o.fields.front()); }),
          "--vary law.epsilon=3 sets it too"));
}

TEST(WithSeed, IsTheScenarioReadWithThatSeed) {
  const std::string text = small_with("agents { starts", "agents { random_count: 2 starts");
  Overrides other;
  other.seed = 77;
  EXPECT_NE(plan_of(good(text)), plan_of(good(text, other)));
  EXPECT_EQ(plan_of(good(text).with_seed(77)), plan_of(good(text, other)));
  EXPECT_EQ(plan_of(good(text).with_seed(5).with_seed(77)), plan_of(good(text, other)));
}

}  // namespace
}  // namespace ergocast
