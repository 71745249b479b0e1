// SPDX-License-Identifier: BSD-3-Clause
// The compiled plan: one spelling for each scenario, and nothing that comes off the network is
// taken for one unless it could have been compiled here.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>

#include "team/messages.h"
#include "tests/scenario/scenarios.h"

namespace ergocast {
namespace {

using namespace test;
using Bytes = std::vector<std::byte>;

void expect_equal(const Mission& a, const Mission& b) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.seed, b.seed);
  EXPECT_EQ(a.domain.origin_m, b.domain.origin_m);
  EXPECT_EQ(a.domain.size_m, b.domain.size_m);
  EXPECT_EQ(a.basis.sobolev_exponent, b.basis.sobolev_exponent);
  EXPECT_EQ(a.target_coefficients, b.target_coefficients);
  EXPECT_EQ(a.law.epsilon, b.law.epsilon);
  EXPECT_EQ(a.law.contraction_center_m, b.law.contraction_center_m);
  EXPECT_EQ(a.timing.tick_count, b.timing.tick_count);
  EXPECT_EQ(a.starts_m, b.starts_m);
  EXPECT_EQ(a.quorum, b.quorum);
}

/// What the cores rely on without checking.
void expect_flyable(const Mission& mission) {
  EXPECT_TRUE(mission.domain.origin_m.allFinite());
  EXPECT_GT(mission.domain.size_m.minCoeff(), 0);
  ASSERT_GE(mission.basis.modes_x, 1);
  ASSERT_GE(mission.basis.modes_y, 1);
  ASSERT_LE(mission.basis.modes_x, kMaxModesPerAxis);
  ASSERT_LE(mission.basis.modes_y, kMaxModesPerAxis);
  ASSERT_EQ(mission.target_coefficients.rows(), mission.basis.modes_x);
  ASSERT_EQ(mission.target_coefficients.cols(), mission.basis.modes_y);
  EXPECT_EQ(mission.target_coefficients(0, 0), 1);
  EXPECT_LE(mission.target_coefficients.cwiseAbs().maxCoeff(), 1 + 1e-9);
  EXPECT_GT(mission.law.u_max_mps, 0);
  EXPECT_GE(mission.law.noise_intensity, 0);
  EXPECT_TRUE(std::isfinite(mission.law.epsilon + mission.law.noise_intensity));
  EXPECT_GE(mission.timing.tick_count, 1);
  EXPECT_LE(mission.timing.tick_count, 100000000);
  EXPECT_GE(mission.timing.broadcast_period_ticks, 1);
  ASSERT_GE(mission.starts_m.size(), 1u);
  ASSERT_LE(mission.starts_m.size(), std::size_t{kMaxAgents});
  for (const Eigen::Vector2d& x_m : mission.starts_m) EXPECT_TRUE(mission.domain.contains(x_m));
  EXPECT_GE(mission.quorum, 1);
  EXPECT_LE(mission.quorum, static_cast<int>(mission.starts_m.size()));
}

/// The place of `value` in `plan`; its bytes appear once.
std::size_t find_double(const Bytes& plan, double value) {
  std::byte pattern[sizeof value];
  std::memcpy(pattern, &value, sizeof value);
  const auto at = std::search(plan.begin(), plan.end(), std::begin(pattern), std::end(pattern));
  EXPECT_NE(at, plan.end()) << value;
  return static_cast<std::size_t>(at - plan.begin());
}

Bytes with_double(Bytes plan, double from, double to) {
  std::memcpy(plan.data() + find_double(plan, from), &to, sizeof to);
  return plan;
}

/// The mission in a plan, if there is one.
std::optional<Mission> decoded(std::span<const std::byte> plan) {
  auto read = decode_plan(plan);
  auto* mission = std::get_if<Mission>(&read);
  return mission == nullptr ? std::nullopt : std::optional(std::move(*mission));
}

/// What is wrong with one.
std::string problem_of(std::span<const std::byte> plan) {
  const auto read = decode_plan(plan);
  const auto* problem = std::get_if<std::string>(&read);
  return problem == nullptr ? "nothing" : *problem;
}

/// The plan of a scenario whose numbers are all different.
Bytes small_plan() {
  return good(R"(
    name: "small"
    domain { size_x_m: 101 size_y_m: 52 }
    target { gaussians { mean_x_m: 33 mean_y_m: 34 sigma_m: 35 } }
    basis { modes_x: 3 modes_y: 2 sobolev_exponent: 1.75 }
    law { u_max_mps: 5.5 epsilon: 0.25 noise_intensity: 0.75 contraction_gain_per_s: 0.0002 }
    time { dt_s: 0.125 duration_s: 60 }
    agents { starts { x_m: 17 y_m: 20 } starts { x_m: 18 y_m: 21 } }
  )")
      .plan();
}

TEST(Plan, OfEveryShippedScenarioReadsBack) {
  for (const char* name : kShipped) {
    SCOPED_TRACE(name);
    const Scenario scenario = good(Scenario::load(shipped(name)));
    const auto read = Scenario::from_plan(scenario.plan());
    const auto* again = std::get_if<Scenario>(&read);
    ASSERT_NE(again, nullptr) << std::get<std::string>(read);
    EXPECT_EQ(again->plan(), scenario.plan());
    EXPECT_EQ(again->description(), "");
    EXPECT_EQ(again->target_density().size(), 0);
    expect_equal(again->mission(), scenario.mission());
    expect_equal(decoded(scenario.plan()).value(), scenario.mission());
    EXPECT_EQ(good(Scenario::parse(scenario.print(), "again")).plan(), scenario.plan());
  }
}

TEST(Plan, DependsOnWhatAScenarioMeansNotOnItsSpelling) {
  const Bytes plan = good(kSmall).plan();
  EXPECT_EQ(good(small_with("law {", "description: \"other\" # words\n law {")).plan(), plan);
  EXPECT_EQ(good(small_with("law {", "seed: 1 basis { modes_x: 16 } law {")).plan(), plan);
  EXPECT_EQ(good(small_with("size_x_m: 100 size_y_m: 50", "size_y_m: 50. size_x_m: 1e2")).plan(),
            plan);
  EXPECT_NE(good(kSmall, {.seed = 2}).plan(), plan);
}

TEST(Plan, HashIsXxh3Of128Bits) {
  EXPECT_EQ(plan_hash({}), "99aa06d3014798d86001c324468d497f");  // the published value for no bytes
  EXPECT_EQ(plan_hash(good(kSmall).plan()), plan_hash(good(kSmall).plan()));
  EXPECT_NE(plan_hash(good(kSmall).plan()), plan_hash(good(kSmall, {.seed = 2}).plan()));
}

TEST(Plan, OfTheLargestScenarioFitsItsMessages) {
  std::string many;
  for (int i = 0; i < 64; ++i) {
    many += "gaussians { weight: 1.1 mean_x_m: " + std::to_string(i) +
            ".3 mean_y_m: 5.7 covariance { xx_m2: 25.1 yy_m2: 25.3 xy_m2: 0 } } ";
  }
  std::string text = small_with("uniform_weight: 1", many);
  text += "basis { modes_x: 64 modes_y: 64 } name: \"" + std::string(64, 'x') + "\"";
  const Scenario largest = good(text, {.seed = ~std::uint64_t{0}, .agents = 128});
  EXPECT_LE(largest.plan().size(), std::size_t{kMaxPlanParts} * kMaxPlanBytesPerMessage);
  EXPECT_TRUE(decoded(largest.plan()));
}

TEST(HostilePlan, CutShortIsRefused) {
  const Bytes plan = small_plan();
  ASSERT_TRUE(decoded(plan));
  for (std::size_t length = 0; length < plan.size(); ++length) {
    EXPECT_FALSE(decoded(std::span(plan).first(length))) << length;
  }
}

TEST(HostilePlan, WithAnyBitFlippedIsRefusedOrFlyable) {
  Bytes plan = small_plan();
  for (std::size_t bit = 0; bit < 8 * plan.size(); ++bit) {
    const std::byte mask{static_cast<unsigned char>(1u << bit % 8)};
    plan[bit / 8] ^= mask;
    const auto read = Scenario::from_plan(plan);
    if (const auto* scenario = std::get_if<Scenario>(&read)) {
      expect_flyable(scenario->mission());
      EXPECT_EQ(scenario->plan(), plan);
      const std::string text = scenario->print() + "target { uniform_weight: 1 }";
      EXPECT_EQ(joined(problems_of(text)), "") << bit;
    }
    plan[bit / 8] ^= mask;
  }
}

TEST(HostilePlan, OfRandomBytesIsRefusedOrFlyable) {
  std::mt19937 random(1);
  const Bytes plan = small_plan();
  for (int i = 0; i < 20000; ++i) {
    Bytes noisy = plan;
    if (i % 2 == 0) noisy.resize(random() % plan.size());
    for (int changes = 1 + i % 8; changes > 0 && !noisy.empty(); --changes) {
      noisy[random() % noisy.size()] = std::byte{static_cast<unsigned char>(random())};
    }
    if (const auto mission = decoded(noisy)) expect_flyable(*mission);
  }
}

TEST(HostilePlan, WithANumberOutOfItsLimitsIsRefused) {
  const Bytes plan = small_plan();
  const double nan = std::nan(""), inf = INFINITY;
  EXPECT_TRUE(decoded(with_double(plan, 5.5, 6.5)));
  for (const double number :
       {101., 52., 1.75, 5.5, 0.25, 0.75, 0.0002, 0.125, 60., 17., 21.}) {
    for (const double bad : {nan, inf, -inf, -1e300}) {
      EXPECT_FALSE(decoded(with_double(plan, number, bad))) << number << " " << bad;
    }
  }
  EXPECT_FALSE(decoded(with_double(plan, 17, 102)));      // outside the domain
  EXPECT_FALSE(decoded(with_double(plan, 5.5, 521)));     // longer steps than the domain
  EXPECT_FALSE(decoded(with_double(plan, 0.0002, 0.5)));  // too weak at the corner
  EXPECT_FALSE(decoded(with_double(plan, 60, 0.01)));     // no step at all
}

TEST(HostilePlan, WithCoefficientsThatCannotBeIsRefused) {
  const Bytes plan = small_plan();
  const Coefficients mu = decoded(plan)->target_coefficients;
  EXPECT_TRUE(decoded(with_double(plan, mu(2, 1), 0.5)));
  for (const double bad :
       {1.001, -1.001, std::nan(""), -std::nan(""), double{INFINITY}, double{-INFINITY}}) {
    EXPECT_FALSE(decoded(with_double(plan, mu(2, 1), bad))) << bad;
  }
  // μ_00 follows the tag and length of the six coefficients.
  Bytes off = plan;
  const double less = 0.999;
  std::memcpy(off.data() + find_double(plan, mu(0, 1)) - sizeof less, &less, sizeof less);
  EXPECT_FALSE(decoded(off));
}

TEST(HostilePlan, OfAnotherVersionIsRefusedWithBothVersionsNamed) {
  Bytes plan = small_plan();
  ASSERT_EQ(plan[0], std::byte{0x0A});  // the version string comes first
  const auto length = static_cast<std::size_t>(plan[1]);
  const std::string ours(reinterpret_cast<const char*>(plan.data()) + 2, length);
  std::string theirs = ours;
  theirs.back() = theirs.back() == '7' ? '8' : '7';
  plan[1 + length] = std::byte{static_cast<unsigned char>(theirs.back())};
  const std::string sentence = "the mission's plan is of version " + theirs + ", this program is " +
                               ours + ": install the same version on every host";
  EXPECT_EQ(problem_of(plan), sentence);
  // What follows may be written in a way that we cannot even take apart.
  plan.resize(2 + length + 1);
  EXPECT_EQ(problem_of(plan), sentence);
}

TEST(HostilePlan, WithoutAVersionIsDamagedOrMuchNewer) {
  EXPECT_TRUE(has(problem_of({}), "damaged or of a much newer version"));
  Bytes plan = small_plan();
  plan[3] = std::byte{0x1b};  // no word of a stranger moves the cursor of a terminal
  EXPECT_TRUE(has(problem_of(plan), "damaged or of a much newer version"));
  EXPECT_TRUE(has(problem_of(with_double(small_plan(), 17, 102)), "breaks that version's rules"));
}

// Protobuf would read these: unknown fields, a field given twice, padding.
TEST(HostilePlan, WithASpellingOfItsOwnIsRefused) {
  const Bytes plan = small_plan();
  const auto appended = [&](std::initializer_list<int> bytes) {
    Bytes longer = plan;
    for (const int byte : bytes) longer.push_back(std::byte{static_cast<unsigned char>(byte)});
    return longer;
  };
  EXPECT_FALSE(decoded(appended({0x78, 0x01})));              // field 15
  EXPECT_FALSE(decoded(appended({0x12, 0x00})));              // an empty scenario to be merged
  EXPECT_FALSE(decoded(appended({0x12, 0x02, 0x18, 0x09})));  // another seed
  EXPECT_FALSE(decoded(appended({0x00})));
  Bytes twice = plan;
  twice.insert(twice.end(), plan.begin(), plan.end());
  EXPECT_FALSE(decoded(twice));
  EXPECT_FALSE(decoded(Bytes(std::size_t{kMaxPlanParts} * kMaxPlanBytesPerMessage + 1)));
}

}  // namespace
}  // namespace ergocast
