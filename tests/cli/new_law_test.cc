// SPDX-License-Identifier: BSD-3-Clause
// Numbers of the law that an operator writes: which are taken, for which agents, and what is said
// of the others.
#include "cli/record/new_law.h"

#include <gtest/gtest.h>

#include <cmath>

#include "plan/mission_limits.h"
#include "tests/support/team.h"

namespace ergocast::cli {
namespace {

using namespace test;

LawWish wish(const char* text) { return law_wish_from(text).value(); }

/// Two kinds: the second is slower than the law.
Mission mission_of_kinds() {
  Mission mission = small_mission(4);
  mission.law.u_max_mps = 10;
  mission.law.perturbation = Perturbation::kAdaptive;
  mission.law.noise_intensity = 0.5;
  mission.law.noise_ceiling = 2;
  for (const auto& [name, u_max_mps] : {std::pair("scout", 10.0), std::pair("mule.2", 4.0)}) {
    AgentKind kind;
    kind.name = name;
    kind.count = 2;
    kind.u_max_mps = u_max_mps;
    kind.noise_intensity = 0.5;
    kind.noise_ceiling = 2;
    mission.kinds.push_back(kind);
  }
  return mission;
}

/// The numbers after these wishes.
std::vector<LawNumbers> after(const std::vector<LawWish>& wishes) {
  const Mission mission = mission_of_kinds();
  const auto law = law_with(mission, plans_law(mission), wishes);
  EXPECT_TRUE(law) << law.error();
  EXPECT_TRUE(!law || is_law(*law, mission));
  return law ? law->kinds : std::vector<LawNumbers>();
}

std::string problem_of(const Mission& mission, const std::vector<LawWish>& wishes) {
  const auto law = law_with(mission, plans_law(mission), wishes);
  return law ? "" : law.error();
}

TEST(LawWish, IsAFieldOfAllKindsOrOfOne) {
  EXPECT_EQ(wish("u_max_mps=8").kind, "");
  EXPECT_EQ(wish("law.u_max_mps=8").kind, "");
  EXPECT_EQ(wish("mule.2.noise_ceiling=8").kind, "mule.2");
  EXPECT_EQ(wish("mule.2.noise_ceiling=8").field, "noise_ceiling");
  EXPECT_EQ(wish("u_max_mps=8e-1").value, 0.8);
  for (const char* text : {"", "u_max_mps", "u_max_mps=", "=8", ".u_max_mps=8", "u_max_mps=8 ",
                           "u_max_mps=nan", "u_max_mps=inf", "u_max_mps=+8"})
    EXPECT_FALSE(law_wish_from(text)) << text;
}

TEST(NewLaw, ASpeedOfAllKindsLeavesTheSlowerOnesAsTheyAre) {
  EXPECT_EQ(after({wish("u_max_mps=8")}), (std::vector<LawNumbers>{{8, 0.5, 2}, {4, 0.5, 2}}));
  EXPECT_EQ(after({wish("u_max_mps=3")}), (std::vector<LawNumbers>{{3, 0.5, 2}, {3, 0.5, 2}}));
  EXPECT_EQ(after({wish("scout.u_max_mps=2"), wish("noise_intensity=0.25")}),
            (std::vector<LawNumbers>{{2, 0.25, 2}, {4, 0.25, 2}}));
  EXPECT_EQ(after({wish("mule.2.noise_ceiling=5")}),
            (std::vector<LawNumbers>{{10, 0.5, 2}, {4, 0.5, 5}}));
}

TEST(NewLaw, RefusesWithTheRemedy) {
  const Mission mission = mission_of_kinds();
  Mission constant = mission, pulled = mission;
  constant.law.perturbation = Perturbation::kConstant;
  pulled.law.contraction_gain_per_s = 2 / pulled.domain.farthest_distance_m({0, 0, 0});
  struct Case {
    const Mission& mission;
    const char *text, *problem;
  };
  for (const auto& [of, text, problem] :
       {Case{mission, "u_max_mps=11", "at most that of the plan, 10 m/s"},
        Case{mission, "mule.2.u_max_mps=5", "at most that of the plan, 4 m/s"},
        Case{mission, "u_max_mps=0", "above 0"}, Case{mission, "speed=3", "name one of these"},
        Case{mission, "boat.u_max_mps=3", "no kind \"boat\""},
        Case{mission, "noise_intensity=3", "is below noise_intensity, 3: set both"},
        Case{mission, "noise_intensity=-1", "noise of kind scout is from 0 to "},
        Case{mission, "noise_ceiling=1e5", "noise of kind scout is from 0 to "},
        Case{constant, "noise_ceiling=3", "perturbation CONSTANT"},
        Case{pulled, "u_max_mps=1", "too weak for the contraction, which needs 2 m/s"}}) {
    const std::string found = problem_of(of, {wish(text)});
    EXPECT_NE(found.find(problem), std::string::npos) << text << ": " << found;
  }
}

TEST(NewLaw, AFixedWingKeepsItsLeastSpeed) {
  Mission mission = small_mission(2);
  mission.law.u_max_mps = 10;
  mission.speed_limit_mps = 20;
  mission.vehicle = {.kind = VehicleKind::kFixedWing, .max_turn_radps = 1, .min_speed_mps = 5};
  EXPECT_NE(problem_of(mission, {wish("u_max_mps=5")}).find("never slower than 5 m/s"),
            std::string::npos);
  EXPECT_EQ(problem_of(mission, {wish("u_max_mps=6")}), "");
}

}  // namespace
}  // namespace ergocast::cli
