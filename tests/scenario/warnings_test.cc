// SPDX-License-Identifier: BSD-3-Clause
// The warnings about a scenario, in its own numbers: a speed limit below the law's commands, and
// steps too coarse for agents with a forecast.
#include <gtest/gtest.h>

#include "core/mission/kinds.h"
#include "scenario/rules/footprint_reach.h"
#include "tests/scenario/scenarios.h"

namespace ergocast {
namespace {

using namespace test;

/// kSmall, 100 m × 50 m, with that law and speed limit.
std::string limited(const std::string& law, const std::string& speed_limit_mps) {
  return small_with(
      "law { u_max_mps: 5 }",
      "law { u_max_mps: 5 " + law + " }\nworld { speed_limit_mps: " + speed_limit_mps + " }");
}

std::string warnings_of(const std::string& text) { return joined(good(text).warnings()); }

TEST(Warnings, AreNoneWithoutALimit) {
  EXPECT_EQ(warnings_of(std::string(kSmall)), "");
  for (const std::string name : kShipped) {
    if (name == "two_rooms") continue;  // a wall hides its target from itself
    EXPECT_EQ(joined(good(Scenario::load(shipped(name))).warnings()), "") << name;
  }
}

TEST(Warnings, OfALimitBelowTheConstantLawsCommands) {
  // k r = 0.06 · √(50² + 25²) = 3.354, 6 σ/√dt = 6 · 0.5/√0.25 = 6: in all 14.36 m/s.
  const std::string law =
      "perturbation: CONSTANT noise_intensity: 0.5 contraction_gain_per_s: 0.06";
  const auto with_step = [&](const std::string& limit) {
    std::string text = limited(law, limit);
    return text.replace(text.find("duration_s"), 0, "dt_s: 0.25 ");
  };
  EXPECT_EQ(
      warnings_of(with_step("14.3")),
      "small.textproto:5:9: world.speed_limit_mps: 14.3 cuts the method's noise short: the law "
      "commands up to 14.36 m/s = u_max_mps 5 + contraction at the farthest corner 3.355 + 6 "
      "deviations of its noise 6 (noise_intensity / sqrt(dt_s)) (write at least 14.36, less noise "
      "or "
      "a greater dt_s, or accept it: the cuts are counted)\n");
  EXPECT_EQ(warnings_of(with_step("14.36")), "");
}

TEST(Warnings, OfALimitBelowTheInputItselfNameThatInstead) {
  const std::string warning = warnings_of(limited("", "3"));
  EXPECT_TRUE(has(warning, "a law.u_max_mps of at most 3")) << warning;
  EXPECT_FALSE(has(warning, "write at least")) << warning;
}

TEST(Warnings, OfTheAdaptiveLawCountTheHeldPushAndNotTheCeilingInAStep) {
  // The push is held for (2.5/5)² = 0.25 s, 3 steps of 0.1 s: √((6.25 − 0.25)/0.3) = 4.472 m/s.
  // So 6 √(0.25/0.1 + 4.472²) = 28.46. The ceiling in one step would be 6 · 2.5/√0.1 = 47.4.
  const std::string law = "noise_intensity: 0.5 noise_ceiling: 2.5 contraction_gain_per_s: 0";
  const std::string warning = warnings_of(limited(law, "33"));
  EXPECT_TRUE(has(warning, "commands up to 33.47 m/s"));
  EXPECT_TRUE(has(warning, "a push of 4.473 m/s held for 3 steps"));
  EXPECT_EQ(warnings_of(limited(law, "33.5")), "");
}

TEST(Warnings, OfCoarseStepsForAgentsThatLookAhead) {
  // 5 m/s · 0.5 s = 2.5 m, 5 % of the shorter side of 50 m.
  const auto stepping = [](const std::string& dt_s, const std::string& law) {
    std::string text = small_with("law { u_max_mps: 5 }", "law { u_max_mps: 5 " + law + " }");
    return text.replace(text.find("duration_s"), 0, "dt_s: " + dt_s + " ");
  };
  EXPECT_EQ(warnings_of(stepping("0.5", "")), "");
  EXPECT_EQ(warnings_of(stepping("0.51", "anticipation: 0")), "");
  EXPECT_EQ(warnings_of(stepping("0.51", "perturbation: CONSTANT")), "")
      << "it does not look ahead";
  EXPECT_EQ(
      warnings_of(stepping("0.51", "")),
      "small.textproto:5:8: time.dt_s: 0.51 is coarse for agents that look ahead: one step at "
      "u_max_mps is longer than 5 % of the shorter side, and in the long run a uniform target may "
      "be "
      "covered worse than without looking ahead (write at most 0.5, or law.anticipation: 0)\n");
}

TEST(Warnings, OfAMemoryThatIsShorterThanTheWayThroughTheDomain) {
  // 100 m at 5 m/s.
  const auto forgetting = [](const std::string& half_life_s) {
    return warnings_of(small_with("law {", "law { memory_half_life_s: " + half_life_s + " "));
  };
  EXPECT_EQ(forgetting("0"), "");
  EXPECT_EQ(forgetting("20"), "");
  EXPECT_EQ(forgetting("19"),
            "small.textproto:4:7: law.memory_half_life_s: 19 is shorter than the 20 s that an "
            "agent takes to cross the domain: the team then forgets coverage before it is used, "
            "and covers worse (write at least 20, better several times as much, or leave it "
            "out)\n");
}

TEST(Warnings, OfWeightsThatHardlyFallForAgentsThatLookAhead) {
  const auto weighted = [](const std::string& basis, const std::string& law) {
    return warnings_of(small_with("law {", "basis { " + basis + " } law { " + law));
  };
  EXPECT_EQ(weighted("sobolev_form: NORM sobolev_exponent: 0.75", ""), "");
  EXPECT_EQ(weighted("sobolev_exponent: 0.375", ""), "");
  EXPECT_EQ(weighted("sobolev_form: NORM sobolev_exponent: 0.6", "anticipation: 0.5 "), "");
  const std::string norm = weighted("sobolev_form: NORM sobolev_exponent: 0.6", "");
  EXPECT_TRUE(has(norm, "basis.sobolev_exponent: 0.6 lets short waves count nearly as much"))
      << norm;
  EXPECT_TRUE(has(norm, "(write at least 0.75, or law.anticipation: 0.5)")) << norm;
  const std::string squared = weighted("sobolev_exponent: 0.3", "");
  EXPECT_TRUE(has(squared, "(write at least 0.375, or law.anticipation: 0.5)")) << squared;
}

TEST(Warnings, OfRareHighModesWithoutModesOrTime) {
  const auto rare = [](const std::string& modes, const std::string& time) {
    std::string text = small_with("law {", "basis { modes_x: " + modes + " } law {");
    return warnings_of(text.replace(text.find("duration_s"), 0, time + " "));
  };
  EXPECT_EQ(rare("16", "broadcast_period_ticks: 10 high_mode_period_factor: 4"), "");
  EXPECT_EQ(rare("5 modes_y: 13", "high_mode_period_factor: 59"), "") << "65 modes, 590 ticks";
  EXPECT_EQ(rare("8 modes_y: 8", "high_mode_period_factor: 1"), "");
  EXPECT_TRUE(
      has(rare("8 modes_y: 8", "high_mode_period_factor: 4"),
          "time.high_mode_period_factor: 4 has no effect: the basis has 64 modes, and the 64 "
          "lowest are sent every period (leave it out, or write more modes)"));
  EXPECT_TRUE(has(rare("16", "high_mode_period_factor: 60"),
                  "time.high_mode_period_factor: 60 makes 600 ticks between two broadcasts of a "
                  "high mode, and the mission has 600: agents send those once or twice"));
  EXPECT_EQ(rare("16", "broadcast_period_ticks: 600 high_mode_period_factor: 1"), "");
}

std::string with_footprint(const std::string& sigma_m, const std::string& target_m) {
  return "domain { size_x_m: 1000 size_y_m: 1000 } target { gaussians { mean_x_m: 450 mean_y_m: "
         "550 sigma_m: " +
         target_m +
         " } } law { u_max_mps: 5 } time { duration_s: 60 } agents { kind { name: \"a\" "
         "count: 2 footprint_sigma_m: " +
         sigma_m + " } }";
}

TEST(Warnings, OfATargetThatIsFinerThanTheFootprints) {
  // A Gaussian is reached exactly by every footprint that is narrower.
  EXPECT_EQ(warnings_of(with_footprint("60", "80")), "");
  EXPECT_EQ(warnings_of(with_footprint("80", "80")), "");
  const std::string warning = warnings_of(with_footprint("160", "80"));
  EXPECT_NE(warning.find("agents.kind: the target is finer than the sensors see"), warning.npos)
      << warning;
  EXPECT_NE(warning.find("write smaller footprints"), warning.npos) << warning;
}

TEST(Warnings, OfFootprintsStateAPhiThatNoCoverageComesMuchBelow) {
  const Mission mission = good(with_footprint("160", "80")).mission();
  const FootprintReach reach = footprint_reach(mission, 0);
  EXPECT_GT(reach.low, 0.01 * reach.even);
  EXPECT_LT(reach.high, 1.05 * reach.low) << "the bounds are close to each other";
  const Sensors sensors(mission);
  const Coefficients weights = sobolev_weights(mission.basis, mission.domain);
  for (double x_m = 300; x_m <= 600; x_m += 25) {
    for (double y_m = 400; y_m <= 700; y_m += 25) {
      const Coefficients seen =
          basis_values({x_m, y_m, 0}, mission.domain, mission.basis).cwiseProduct(sensors.of(0).g);
      EXPECT_GE(ergodic_metric(seen, mission.target_coefficients, weights), 0.99 * reach.low);
    }
  }
  // Where everything is in one place, nothing narrower can be seen.
  const Coefficients there =
      basis_values({450, 550, 0}, mission.domain, mission.basis).cwiseProduct(sensors.of(0).g);
  EXPECT_LT(ergodic_metric(there, mission.target_coefficients, weights), 1.1 * reach.high);
}

TEST(Warnings, AreOfNoWeightForAPlan) {
  const Scenario scenario = good(limited("", "1"));
  ASSERT_EQ(scenario.warnings().size(), 1u);
  const auto read = decode_plan(plan_of(scenario));
  ASSERT_TRUE(read);
  EXPECT_EQ(read->speed_limit_mps, 1);
}

TEST(Warnings, OfVehiclesThatFollowLateAndBeginAtAnEdge) {
  const auto late = [](const std::string& response_s, const std::string& start) {
    std::string text = limited("", "10");
    text.replace(text.find("x_m: 10 y_m: 20"), 15, start);
    return warnings_of(text + "separation { distance_m: 2 response_s: " + response_s + " }");
  };
  EXPECT_FALSE(has(late("0.5", "x_m: 50 y_m: 5.1"), "follow"));
  EXPECT_TRUE(has(late("0.5", "x_m: 50 y_m: 4.9"),
                  "is nearer to an edge than the 5 m that a vehicle with this delay keeps"));
  EXPECT_TRUE(has(late("1.3", "x_m: 50 y_m: 25"), "keep 13 m from every edge"));
}

TEST(Warnings, SayWhichLawFindsMore) {
  const auto searched = [](const std::string& law, const std::string& target, double duration_s) {
    std::string text = small_with("u_max_mps: 5", "u_max_mps: 5 kind: " + law);
    text.replace(text.find("uniform_weight: 1"), 17, target);
    text.replace(text.find("duration_s: 60"), 14, "duration_s: " + std::to_string(duration_s));
    return warnings_of(text);
  };
  // Lanes of 2 · 1.25 m at 5 m/s are 750 m² in 60 s: 0.15 of the 5000 m².
  const std::string peak = "gaussians { mean_x_m: 50 mean_y_m: 25 sigma_m: 8 }";
  EXPECT_EQ(searched("SEARCH", "uniform_weight: 1", 60),
            "small.textproto:4:20: law.kind: SEARCH goes from peak to peak, and this target is "
            "nearly even: with time to pass over it 0.15 times, agents in lanes find more (write "
            "kind: MOW, or measure both: ergocast study with --vary law.kind=SEARCH,MOW --measure "
            "detection_probability)\n");
  EXPECT_EQ(searched("SEARCH", "uniform_weight: 1", 1100), "");
  EXPECT_EQ(searched("SEARCH", peak, 60), "");
  // 2 π e · 8² of 5000 m², but for what the edges cut off.
  EXPECT_TRUE(has(searched("MOW", peak, 60), "spread over 21."));
  EXPECT_EQ(searched("MOW", "uniform_weight: 1", 60), "");
  EXPECT_EQ(searched("COVER", peak, 60) + searched("COVER", "uniform_weight: 1", 60), "");
}

}  // namespace
}  // namespace ergocast
