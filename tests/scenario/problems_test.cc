// SPDX-License-Identifier: BSD-3-Clause
// The problems of an invalid scenario: every error at once, with its place, the limit it breaks and
// the remedy.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <random>

#include "tests/scenario/scenarios.h"
#include "tests/support/temp_folder.h"

namespace ergocast {
namespace {

using namespace test;

TEST(Problems, AreAllNamedAtOnceWithTheirLines) {
  const std::string text = joined(problems_of(R"(name: "bad name"
domain { size_x_m: 2000 size_y_m: 2000 origin: 3 }
target {
  gaussians { mean_x_m: 500 mean_y_m: abc sigma_m: 100 }
  gaussians { mean_x_m: nan mean_y_m: 500 sigma_m: 100 }
}
basis { modes_x: 65 }
law {
  u_max_mps: 1
  noise: 1
  contraction_gain_per_s: 0.001
}
time {
  dt_s: -0.1
  pace LOCKSTEP
  broadcast_period_ticks: 1
  broadcast_period_ticks: 2
}
agents {
  starts { x_m: 5000 y_m: 0 }
  quorum: 3
}
)"));
  EXPECT_EQ(
      text,
      "f:1:1: name: cannot name a folder (write 1 to 64 letters, digits, '_', '-' or '.', and "
      "begin "
      "with a letter, a digit or '_')\n"
      "f:2:46: unknown field \"origin\" in Domain (did you mean origin_x_m?)\n"
      "f:4:39: target.gaussians[0].mean_y_m: abc is not a number (write a number such as 0.5)\n"
      "f:5:15: target.gaussians[1].mean_x_m: nan is not a number (write a number in the domain, 0 "
      "to 2000)\n"
      "f:7:9: basis.modes_x: 65 is above the limit 64 (write a number 1 to 64)\n"
      "f:9:3: law.u_max_mps: 1 is too weak for contraction_gain_per_s 0.001 at the farthest "
      "corner, "
      "which needs 1.415 (write at least 1.415, or a smaller contraction_gain_per_s)\n"
      "f:10:8: unknown field \"noise\" in Law (did you mean noise_intensity?)\n"
      "f:13:1: time.duration_s: is missing (add duration_s, above 0, at most 10000000)\n"
      "f:14:3: time.dt_s: -0.1 is below the limit 1e-06 (write a number 1e-06 to 3600)\n"
      "f:15:8: time.pace: Expected \":\", found \"LOCKSTEP\". (correct the text here)\n"
      "f:17:25: time.broadcast_period_ticks: is written more than once (keep one of them)\n"
      "f:20:12: agents.starts[0].x_m: 5000 is outside the domain (write 0 to 2000)\n"
      "f:21:3: agents.quorum: 3 is above the limit, the team's size 1 (write 1 to 1)\n");
}

/// One mistake put into kSmall, and its only problem.
struct Mistake {
  const char* from;
  const char* to;
  const char* printed;
};

class OneMistake : public ::testing::TestWithParam<Mistake> {};

TEST_P(OneMistake, IsOneProblem) {
  const std::vector<Problem> problems = problems_of(small_with(GetParam().from, GetParam().to));
  ASSERT_EQ(problems.size(), 1u) << joined(problems);
  EXPECT_TRUE(has(to_string(problems[0]), GetParam().printed));
  EXPECT_FALSE(problems[0].remedy.empty());
}

constexpr Mistake kFormat[] = {
    {"size_x_m: 100", "size_x_m: 1,5", "f:2:20: domain.size_x_m: 1,5 has a comma"},
    {"size_x_m: 100", "size_x_m: ten", "domain.size_x_m: ten is not a number"},
    {"size_x_m: 100", "size_x_m 100", "f:2:19: domain.size_x_m: Expected \":\""},
    {"size_x_m: 100", "size_x_m:", "f:2:20: domain.size_x_m: size_y_m is not a number"},
    {"size_x_m: 100", "size_x_m: 100 size_x_m: 100",
     "f:2:32: domain.size_x_m: is written more than once"},
    {"size_x_m: 100", "size_x_m: 100 @", "f:2:24: Expected identifier, got: @"},
    {"size_x_m: 100", "size_x_m: 100 size_q_m: 1",
     "f:2:32: unknown field \"size_q_m\" in Domain (did you mean size_"},
    {"law {", "law { modes_x: 5", "write it inside basis { }"},
    {"law {", "law { regularization: BOTH",
     "f:4:23: law.regularization: unknown value \"BOTH\" (write one of RELATIVE or ABSOLUTE)"},
    {"law {", "law { contraction_center: 7", "law.contraction_center: has no value 7"},
    {"law {", "basis { normalized: yes } law {",
     "f:4:21: basis.normalized: yes is neither true nor false"},
    {"law {", "basis { modes_x: 4.5 } law {", "f:4:18: basis.modes_x: 4.5 is not a whole number"},
    {"law {", "seed: -1 law {", "f:4:7: seed: -1 is not 0 or above"},
    {"law {", "seed: 18446744073709551616 law {",
     "f:4:7: seed: 18446744073709551616 is out of range"},
    {"law {", "name: five law {", "f:4:7: name: five is not a quoted text"},
    {"law {", "law { u_max_mps: 4 } law {", "f:4:26: law: is written more than once"},
    {"law {", "domain: 5 law {", "f:4:7: domain: is written more than once"},
    {"} }\n", "}\n", "f:6:8: this block is not closed"},
    {"} }\n", "} } }\n", "f:6:39: Expected identifier, got: }"},
};
INSTANTIATE_TEST_SUITE_P(Format, OneMistake, ::testing::ValuesIn(kFormat));

constexpr Mistake kFields[] = {
    {"size_x_m: 100", "", "f:2:1: domain.size_x_m: is missing"},
    {"u_max_mps: 5", "", "f:4:1: law.u_max_mps: is missing"},
    {"law { u_max_mps: 5 }", "", "f: law.u_max_mps: is missing"},
    {"time { duration_s: 60 }", "", "f: time.duration_s: is missing"},
    {"{ x_m: 10", "{", "agents.starts[0].x_m: is missing"},
    {"uniform_weight: 1", "", "f:3:1: target: there is nothing to cover"},
    {"starts { x_m: 10 y_m: 20 }", "", "f:6:1: agents: the team is empty"},
    {"size_x_m: 100", "size_x_m: 0.0009", "0.0009 is below the limit 0.001"},
    {"size_x_m: 100", "size_x_m: 1.1e7", "11000000 is above the limit 10000000"},
    {"size_x_m: 100", "size_x_m: inf", "inf is above"},
    {"size_x_m: 100", "size_x_m: -inf", "-inf is below"},
    {"size_x_m: 100", "size_x_m: 100 origin_x_m: 10000001",
     "10000001 is more than 10000000 m from 0"},
    {"uniform_weight: 1", "uniform_weight: -1", "-1 is below the limit 0"},
    {"u_max_mps: 5", "u_max_mps: 0", "law.u_max_mps: 0 is not above 0"},
    {"u_max_mps: 5", "u_max_mps: nan", "law.u_max_mps: nan is not a number"},
    {"law {", "law { epsilon: -1", "law.epsilon: -1 is below the limit 0"},
    {"law {", "law { noise_intensity: -1", "law.noise_intensity: -1 is below the limit 0"},
    {"law {", "law { noise_intensity: inf", "law.noise_intensity: inf is above the limit 1000000"},
    {"law {", "law { noise_ceiling: nan", "law.noise_ceiling: nan is not a number"},
    {"law {", "law { contraction_gain_per_s: -1", "-1 is below the limit 0"},
    {"law {", "basis { modes_x: 65 } law {", "65 is above the limit 64"},
    {"law {", "basis { modes_y: 0 } law {", "0 is below the limit 1"},
    {"law {", "basis { modes_x: 1 modes_y: 1 } law {", "basis: a single mode"},
    {"law {", "basis { sobolev_exponent: 0 } law {", "0 is not above 0"},
    {"law {", "basis { sobolev_exponent: 11 } law {", "11 is above the limit 10"},
    {"duration_s: 60", "duration_s: 60 dt_s: 0", "time.dt_s: 0 is below the limit"},
    {"duration_s: 60", "duration_s: 0.04",
     "time.duration_s: 0.04 is less than one step of dt_s 0.1"},
    {"duration_s: 60", "duration_s: 1001 dt_s: 1e-5",
     "100100000 steps are above the limit 100000000"},
    {"duration_s: 60", "duration_s: 60 broadcast_period_ticks: 1001",
     "1001 is above the limit 1000"},
    {"duration_s: 60", "duration_s: 60 high_mode_period_factor: 0",
     "time.high_mode_period_factor: 0 is below the limit 1"},
    {"duration_s: 60", "duration_s: 60 high_mode_period_factor: -4", "-4 is below the limit 1"},
    {"duration_s: 60", "duration_s: 60 high_mode_period_factor: 1001",
     "1001 is above the limit 1000"},
    {"duration_s: 60", "duration_s: 60 broadcast_period_ticks: 30 high_mode_period_factor: 34",
     "time.high_mode_period_factor: 34 makes 1020 ticks with broadcast_period_ticks 30, above the "
     "limit 1000 (write at most 33"},
    {"duration_s: 60", "duration_s: 60 realtime_factor: 0", "0 is below the limit 0.01"},
    {"duration_s: 60", "duration_s: 60 } goal_ergodic_metric: 0 world { ", "0 is not above 0"},
    {"duration_s: 60", "duration_s: 60 } world { radio_range_m: -1", "-1 is below the limit 0"},
    {"duration_s: 60", "duration_s: 60 } world { speed_limit_mps: 0", "0 is not above 0"},
    {"duration_s: 60", "duration_s: 60 dt_s: 0.001 pace: REALTIME realtime_factor: 20",
     "20 makes a step last 5e-05 s of wall time, below the limit 0.0001 s (write at most 10"},
    {"duration_s: 60", "duration_s: 60 catch_up_limit_ticks: 1001", "1001 is above the limit 1000"},
    {"duration_s: 60", "duration_s: 60 lockstep_timeout_s: 0", "0 is not above 0"},
    {"duration_s: 60", "duration_s: 60 command_hold_s: -1", "-1 is below the limit 0"},
    {"duration_s: 60", "duration_s: 60 admission_timeout_s: 86401",
     "86401 is above the limit 86400"},
    {"duration_s: 60", "duration_s: 60 catch_up_limit_ticks: -1", "-1 is below the limit 0"},
    {"agents {", "agents { random_count: -1", "agents.random_count: -1 is below the limit 0"},
    {"agents {", "agents { random_count: 1024", "agents: a team of 1025 is above the limit 1024"},
    {"agents {", "agents { random_count: 2147483647", "2147483647 is above the limit 16384"},
    {"agents {", "agents { quorum: 0", "agents.quorum: 0 is below the limit 1"},
    {"agents {", "agents { quorum: 2", "agents.quorum: 2 is above the limit, the team's size 1"},
    {"agents {", "world { disturbance_intensity: -1 } agents {", "-1 is below the limit 0"},
    {"agents {", "world { disturbance_intensity: 1000 } agents {",
     "disturbance_intensity · sqrt(dt_s) 316.3 m"},
    {"agents {", "name: \"../x\" agents {", "name: cannot name a folder"},
    {"agents {", "name: \"\" agents {", "name: cannot name a folder"},
    {"agents {", "description: \"\\xff\" agents {", "description: is not UTF-8"},
};
INSTANTIATE_TEST_SUITE_P(Fields, OneMistake, ::testing::ValuesIn(kFields));

constexpr Mistake kRelations[] = {
    {"{ x_m: 10", "{ x_m: 100.1", "agents.starts[0].x_m: 100.1 is outside the domain"},
    {"{ x_m: 10", "{ x_m: -0.001", "is outside the domain"},
    {"u_max_mps: 5", "u_max_mps: 501",
     "u_max_mps · dt_s 50.1 m, above the limit, the domain's shorter side 50 m"},
    {"law {", "law { noise_intensity: 159", "noise_intensity · sqrt(dt_s) 50.29 m"},
    {"law {", "law { noise_intensity: 3 noise_ceiling: 2",
     "law.noise_ceiling: 2 is below noise_intensity, 3"},
    {"law {", "law { noise_ceiling: 159", "noise_ceiling · sqrt(dt_s) 50.29 m"},
    {"law {", "law { perturbation: CONSTANT noise_ceiling: 2",
     "law.noise_ceiling: has no effect with perturbation: CONSTANT"},
    {"law {", "law { contraction_gain_per_s: 0.1", "needs 5.591"},
    {"law {", "law { contraction_gain_per_s: 0.05 contraction_center: COORDINATE_ORIGIN",
     "needs 5.591"},
    {"60", "60 dt_s: 100 } basis { modes_x: 2", "u_max_mps · dt_s 500 m"},
    {"law {", "law { contraction_center: POINT contraction_x_m: 3",
     "law.contraction_y_m: is missing"},
    {"law {", "law { contraction_y_m: 3",
     "law.contraction_y_m: has no effect without contraction_center: POINT"},
};
INSTANTIATE_TEST_SUITE_P(Relations, OneMistake, ::testing::ValuesIn(kRelations));

constexpr const char* kUniform = "uniform_weight: 1";
constexpr Mistake kTargets[] = {
    {kUniform, "gaussians { mean_x_m: 5 mean_y_m: 5 }",
     "f:3:10: target.gaussians[0]: has no width"},
    {kUniform,
     "gaussians { mean_x_m: 5 mean_y_m: 5 sigma_m: 5 covariance { xx_m2: 25 yy_m2: 25 } }",
     "target.gaussians[0]: has both sigma_m and covariance"},
    {kUniform, "gaussians { mean_y_m: 5 sigma_m: 5 }", "target.gaussians[0].mean_x_m: is missing"},
    {kUniform, "gaussians { mean_x_m: 5 mean_y_m: 5 sigma_m: 0 }", "0 is not above 0"},
    {kUniform, "gaussians { mean_x_m: 5 mean_y_m: 5 sigma_m: 0.009 }",
     "0.009 is below the limit 0.01"},
    {kUniform, "gaussians { mean_x_m: 5 mean_y_m: 5 sigma_m: 1000001 }",
     "is above the limit 1000000"},
    {kUniform, "gaussians { mean_x_m: 5 mean_y_m: 5 sigma_m: 5 weight: 0 }",
     "weight: 0 is not above 0"},
    {kUniform, "gaussians { mean_x_m: 5 mean_y_m: 5 covariance { xx_m2: 25 yy_m2: 25 xy_m2: 25 } }",
     "target.gaussians[0].covariance.xy_m2: 25 leaves too little for the covariance to be positive "
     "definite"},
    {kUniform,
     "gaussians { mean_x_m: 5 mean_y_m: 5 covariance { xx_m2: 25 yy_m2: 25 xy_m2: -26 } }",
     "positive definite: the limit is 0.99 sqrt(xx_m2 yy_m2) (write -24.75 to 24.75)"},
    {kUniform, "gaussians { mean_x_m: 5 mean_y_m: 5 covariance { xx_m2: -25 yy_m2: 25 } }",
     "xx_m2: -25 is not above 0"},
    {kUniform, "gaussians { mean_x_m: 5 mean_y_m: 5 covariance { yy_m2: 25 } }",
     "xx_m2: is missing"},
    {kUniform, "gaussians { mean_x_m: 5 mean_y_m: 5 covariance { xx_m2: 25 yy_m2: 9e-5 } }",
     "is below the limit 0.0001"},
    {kUniform, "gaussians { mean_x_m: 500 mean_y_m: 5 sigma_m: 5 }",
     "target: only 0 of its weight is inside the domain"},
    {kUniform, "uniform_weight: 1 gaussians { mean_x_m: 500 mean_y_m: 5 sigma_m: 5 weight: 1e8 }",
     "of its weight is inside the domain, below the limit 1e-06"},
};
INSTANTIATE_TEST_SUITE_P(Targets, OneMistake, ::testing::ValuesIn(kTargets));

TEST(Limits, ThemselvesAreAllowed) {
  for (const auto& [from, to] : std::vector<std::pair<const char*, const char*>>{
           {"x_m: 10 y_m: 20", "x_m: 100 y_m: 50"},
           {"u_max_mps: 5", "u_max_mps: 500"},
           {"u_max_mps: 5", "u_max_mps: 5.591 contraction_gain_per_s: 0.1"},
           {"law {", "basis { modes_x: 64 modes_y: 64 } law {"},
           {"law {", "basis { modes_x: 1 modes_y: 2 } law {"},
           {"agents {", "agents { random_count: 1023"},
           {"duration_s: 60", "duration_s: 1000 dt_s: 1e-5"},
           {"law {", "name: \"_a-B.9\" law {"}}) {
    EXPECT_EQ(joined(problems_of(small_with(from, to))), "") << to;
  }
}

TEST(Limits, TooManyGaussians) {
  std::string many;
  for (int i = 0; i < 65; ++i) many += "gaussians { mean_x_m: 5 mean_y_m: 5 sigma_m: 5 } ";
  EXPECT_TRUE(has(joined(problems_of(small_with("uniform_weight: 1", many))),
                  "65 Gaussians are above the limit 64"));
}

TEST(Limits, TooLongADescription) {
  EXPECT_TRUE(has(joined(problems_of(small_with(
                      "law {", "description: \"" + std::string(2001, 'x') + "\" law {"))),
                  "2001 bytes are above the limit 2000"));
}

// An unreadable field is unknown, not missing: it must not cause a second problem.
TEST(ErrorRecovery, UnreadableFieldsAreNotMissingAsWell) {
  for (const char* text : {"domain { size_x_m: a size_y_m: b }", "domain: 5", "domain 5"}) {
    const std::string printed =
        joined(problems_of(small_with("domain { size_x_m: 100 size_y_m: 50 }", text)));
    EXPECT_FALSE(has(printed, "missing")) << printed;
  }
  EXPECT_FALSE(
      has(joined(problems_of(small_with("x_m: 10 y_m: 20", "x_m: a y_m: 20"))), "missing"));
  EXPECT_FALSE(
      has(joined(problems_of(small_with("uniform_weight: 1", "uniform_weight: a"))), "nothing"));
  EXPECT_FALSE(
      has(joined(problems_of(small_with("starts {", "random_count: a starts: {"))), "empty"));
}

TEST(ErrorRecovery, UnterminatedTextEndsWithItsLine) {
  const std::string printed =
      joined(problems_of(small_with("law {", "name: \"abc\nspeed: 3 law {")));
  EXPECT_TRUE(has(printed, "f:4:7: name: "));
  EXPECT_TRUE(has(printed, "f:5:6: unknown field \"speed\""));
}

TEST(Text, HostileTextIsRefusedQuickly) {
  std::string nested, fields, values;
  for (int i = 0; i < 200000; ++i) {
    nested += "a{";
    fields += "a:1 ";
    values += "seed:x ";
  }
  EXPECT_TRUE(has(joined(problems_of(nested)), "blocks lie deeper than the limit, 16"));
  EXPECT_TRUE(has(joined(problems_of(fields)), "has more mistakes than these"));
  EXPECT_TRUE(has(joined(problems_of("law { regularization: " + std::string(900000, 'B') + " }")),
                  "law.regularization"));
  EXPECT_TRUE(has(joined(problems_of("seed: 1 # \xE9\n")), "f:1:11: this is not UTF-8"));
  EXPECT_TRUE(has(joined(problems_of("seed: 1 # \xED\xA0\x80\n")), "not UTF-8"));  // a surrogate
  EXPECT_TRUE(has(joined(problems_of("seed: 1 # \xC0\x80\n")), "not UTF-8"));      // overlong
  EXPECT_TRUE(has(joined(problems_of(std::string(kMaxScenarioBytes + 1, ' '))),
                  "longer than the limit, 1048576"));
  EXPECT_FALSE(problems_of(values).empty());
  EXPECT_FALSE(problems_of("").empty());
  EXPECT_FALSE(problems_of(std::string(100, '\0')).empty());
}

// Any file is a scenario that is unchanged by printing, or has a problem.
TEST(Text, AnyDamageIsNamedOrHarmless) {
  std::mt19937 random(1);
  const std::string whole = good(Scenario::load(shipped("quadrimodal_corners"))).print();
  const std::string alphabet = "{}:<>[]#\"'\\,-.;0159naif_ \n\t\xC3";
  for (int i = 0; i < 2000; ++i) {
    std::string text = whole;
    for (int changes = 1 + i % 3; changes > 0; --changes) {
      const std::size_t at = random() % text.size();
      const char c = alphabet[random() % alphabet.size()];
      i % 2 == 0 ? text.replace(at, 1, 1, c) : text.insert(at, 1, c);
    }
    const Loaded loaded = Scenario::parse(text, "f");
    if (loaded) {
      EXPECT_EQ(plan_of(good(Scenario::parse(loaded->print(), "f"))), plan_of(*loaded)) << text;
    } else {
      EXPECT_FALSE(loaded.error().empty()) << text;
    }
  }
}

TEST(Text, EveryBeginningOfAFileIsRefused) {
  const std::string whole = good(Scenario::load(shipped("paper_fig1a"))).print();
  const std::size_t last_required = whole.find("agents {");
  for (std::size_t length = 0; length < last_required; ++length) {
    EXPECT_FALSE(problems_of(whole.substr(0, length)).empty()) << length;
  }
}

class File : public ::testing::Test {
 protected:
  std::string problem_of(const std::filesystem::path& file) {
    const Loaded loaded = Scenario::load(file);
    return loaded ? "" : joined(loaded.error());
  }

  const TempFolder own_;
  const std::filesystem::path& folder_ = own_.path();
};

TEST_F(File, ThatIsMissingOrAFolderIsNamed) {
  const std::filesystem::path missing = folder_ / "none.textproto";
  EXPECT_TRUE(has(problem_of(missing), missing.string() + ": " + "there is no such file"));
  EXPECT_TRUE(has(problem_of(folder_), folder_.string() + ": " + "is a folder"));
  EXPECT_TRUE(has(problem_of(missing / "x"), "there is no such file"));
  EXPECT_TRUE(has(problem_of(""), "there is no such file"));
}

TEST_F(File, ThatHasNoEndIsRefused) {
  EXPECT_TRUE(has(problem_of("/dev/zero"), "is not a regular file"));
  const std::filesystem::path long_file = folder_ / "long.textproto";
  std::ofstream(long_file) << "#";
  std::filesystem::resize_file(long_file, kMaxScenarioBytes + 1);
  EXPECT_TRUE(has(problem_of(long_file), "longer than the limit"));
}

TEST_F(File, ThatCannotBeReadIsNamed) {
  // Every user can open it, root included, but reading fails.
  EXPECT_TRUE(has(problem_of("/proc/self/mem"), "cannot be read"));
}

TEST_F(File, GivesItsNameToProblemsAndScenario) {
  const std::filesystem::path file = folder_ / "mine.textproto";
  std::ofstream(file) << kSmall;
  EXPECT_EQ(problem_of(file), "");
  EXPECT_EQ(good(Scenario::load(file)).name(), "mine");
  std::ofstream(file) << "seed: x\n" << kSmall;
  EXPECT_TRUE(has(problem_of(file), file.string() + ":1:7: seed: x is not a whole number"));
}

}  // namespace
}  // namespace ergocast
