// SPDX-License-Identifier: BSD-3-Clause
// From a scenario to its plan and back to a scenario's text: both have the same limits.
#include <gtest/gtest.h>

#include <set>

#include "logger/mission_text.h"
#include "plan/mission_fields.h"
#include "plan/plan.h"
#include "scenario/scenario.pb.h"
#include "team/messages.h"
#include "tests/plan/rich_mission.h"
#include "tests/scenario/scenarios.h"

namespace ergocast {
namespace {

using namespace test;
using Bytes = std::vector<std::byte>;

/// `text` without its block of that name.
std::string without_block(std::string text, const std::string& name) {
  const std::size_t begin = text.find(name + " {\n"), end = text.find("\n}\n", begin);
  return begin == std::string::npos ? text : text.erase(begin, end + 3 - begin);
}

/// A mission as scenarios describe it: without μ, which the target determines, and wait_for_logger.
Mission as_scenarios_know_it(Mission mission) {
  mission.target_coefficients.setZero();
  mission.target_coefficients[0] = 1;
  mission.wait_for_logger = true;
  return mission;
}

TEST(Plan, OfEveryShippedScenarioReadsBack) {
  for (const char* name : kShipped) {
    SCOPED_TRACE(name);
    const Scenario scenario = good(Scenario::load(shipped(name)));
    EXPECT_TRUE(within_limits(scenario.mission()));
    const auto read = decode_plan(plan_of(scenario));
    ASSERT_TRUE(read) << read.error();
    EXPECT_EQ(encode_plan(*read), plan_of(scenario));
    EXPECT_EQ(plan_of(good(Scenario::parse(scenario.print(), "again"))), plan_of(scenario));
  }
}

TEST(Plan, DependsOnWhatAScenarioMeansNotOnItsSpelling) {
  const Bytes plan = plan_of(good(kSmall));
  EXPECT_EQ(plan_of(good(small_with("law {", "description: \"other\" # words\n law {"))), plan);
  EXPECT_EQ(plan_of(good(small_with("law {", "seed: 1 basis { modes_x: 16 } law {"))), plan);
  EXPECT_EQ(plan_of(good(small_with("size_x_m: 100 size_y_m: 50", "size_y_m: 50. size_x_m: 1e2"))),
            plan);
  EXPECT_NE(plan_of(good(kSmall, {.seed = 2})), plan);
}

TEST(MissionText, IsThatOfItsScenarioWithoutDescriptionAndTarget) {
  for (const char* name : kShipped) {
    const Scenario scenario = good(Scenario::load(shipped(name)));
    std::string text = without_block(scenario.print(), "target");
    const std::size_t description = text.find("description: ");
    text.replace(description, text.find('\n', description) - description, "description: \"\"");
    EXPECT_EQ(mission_text(scenario.mission()), text);
  }
}

TEST(MissionText, ReadsBackToEveryFieldOfAMission) {
  for (const Mission& mission :
       {rich_mission(), rich_mission_in_space(), with_inertia(rich_mission()),
        with_wings(rich_mission()), with_walls(rich_mission()), with_places(rich_mission()),
        with_false_alarms(rich_mission()), with_sites(rich_mission())}) {
    const std::string text = mission_text(mission) + "target { uniform_weight: 1 }";
    // There is no target in walls.
    EXPECT_EQ(encode_plan(as_scenarios_know_it(good(text).mission())),
              encode_plan(as_scenarios_know_it(mission)))
        << text;
    EXPECT_EQ(without_block(good(text).print(), "target"), mission_text(mission));
  }
}

// A default that is written out is no field of its own: scenario and record have one text.
TEST(MissionText, HasNoDefaultThatAScenarioWritesOut) {
  const std::string kind = "kind { name: \"a\" count: 1 ";
  for (const std::string written :
       {"sensor { detections_per_s: 0.5 }", "sensor { radius_m: 0 }", "sensor { }",
        "sensor { radius_m: 3 detections_per_s: 0.5 }", "vehicle { kind: POINT }",
        "separation { distance_m: 2 lease_s: 0 } world { speed_limit_mps: 5 }", "team { }",
        "team { site_row_period_ticks: 2 }", "team { sites: 1 site_row_period_ticks: 2 }"}) {
    const Scenario scenario = good(small_with("law {", written + " law {"));
    EXPECT_EQ(without_block(scenario.print(), "target"), mission_text(scenario.mission()))
        << written;
  }
  for (const std::string written :
       {"band { from: 0 } }", "vehicle { kind: POINT } }", "band { from: 2 } }"}) {
    const Scenario scenario = good(small_with("agents {", "agents { " + kind + written));
    EXPECT_EQ(without_block(scenario.print(), "target"), mission_text(scenario.mission()))
        << written;
  }
  for (const char* written : {"memory_half_life_s: 0", "high_mode_period_factor: 1"}) {
    const bool of_law = written[0] == 'm';
    const Scenario scenario = good(of_law ? small_with("law {", "law { " + std::string(written))
                                          : small_with("time {", "time { " + std::string(written)));
    EXPECT_EQ(without_block(scenario.print(), "target"), mission_text(scenario.mission()))
        << written;
  }
}

// With SEARCH the half-life 0 is a value of its own: objects that drift have another default.
TEST(MissionText, HasTheHalfLifeOfASearch) {
  for (const char* written : {"0", "40"}) {
    const Scenario scenario =
        good(small_with("law {",
                        "world { objects { count: 1 motion { speed_mps: 1 } } } law { kind: SEARCH "
                        "memory_half_life_s: " +
                            std::string(written) + ' '));
    EXPECT_EQ(without_block(scenario.print(), "target"), mission_text(scenario.mission()));
    EXPECT_NE(mission_text(scenario.mission()).find("memory_half_life_s: " + std::string(written)),
              std::string::npos);
  }
}

/// The names in the list of a mission's fields.
class Names : public FieldVisitor {
 public:
  explicit Names(const Mission& mission) { list_fields(*this, mission); }

  std::set<std::string> all;

  void number(const Field& field, auto&) { add(field.name); }
  void flag(const Field& field, auto&) { add(field.name); }
  void choice(const Field& field, auto&, Words) { add(field.name); }
  void part(const Field& field, auto& part) {
    const std::string outer = part_;
    part_ += std::string(field.name) + '.';
    list_fields(*this, part);
    part_ = outer;
  }
  void part(const Field&, const std::vector<AgentKind>&) {}

 private:
  void add(const char* name) { all.insert(part_ + name); }
  std::string part_;
};

/// The numbers, switches, words and texts of a scenario, except for the target and the starts.
std::set<std::string> names_in(const google::protobuf::Descriptor& block, const std::string& path) {
  std::set<std::string> names;
  for (int i = 0; i < block.field_count(); ++i) {
    const auto& field = *block.field(i);
    const std::string name = path + field.name();
    if (field.message_type() == nullptr) {
      names.insert(name);
    } else if (name != "target" && !field.is_repeated()) {
      names.merge(names_in(*field.message_type(), name + '.'));
    }
  }
  return names;
}

TEST(Conversion, KnowsEveryFieldOfAScenario) {
  std::set<std::string> known = Names(Mission()).all;
  known.insert({"name", "description", "seed", "law.contraction_center", "law.contraction_x_m",
                "law.contraction_y_m", "law.contraction_z_m", "time.duration_s",
                "agents.random_count", "agents.footprint_sigma_m", "agents.quality",
                "origin.latitude_deg", "origin.longitude_deg"});
  EXPECT_EQ(names_in(*proto::Scenario::descriptor(), ""), known);
}

// Rules between fields are in two places: a plan that the reader accepts can be written as a
// scenario, which gives the same mission.
TEST(HostilePlan, WithAnyBitFlippedIsRefusedOrOfAMissionThatAScenarioCanDescribe) {
  Bytes plan = plan_of(good(R"(
    name: "small"
    domain { size_x_m: 101 size_y_m: 52 origin_x_m: 1 }
    target { gaussians { mean_x_m: 33 mean_y_m: 34 sigma_m: 35 } }
    basis { modes_x: 3 modes_y: 2 sobolev_exponent: 1.75 }
    law { u_max_mps: 5.5 epsilon: 0.25 noise_intensity: 0.75 contraction_gain_per_s: 0.0002 anticipation: 3 }
    time { dt_s: 0.125 duration_s: 60 lockstep_timeout_s: 11 }
    agents { starts { x_m: 17 y_m: 20 } starts { x_m: 18 y_m: 21 } forget_silent_after_s: 12 }
    world { disturbance_intensity: 0.6 radio_range_m: 60 speed_limit_mps: 8 }
    goal_ergodic_metric: 0.03
  )"));
  int taken = 0;
  for (std::size_t bit = 0; bit < 8 * plan.size(); ++bit) {
    const std::byte mask{static_cast<unsigned char>(1u << bit % 8)};
    plan[bit / 8] ^= mask;
    const auto mission = decode_plan(plan);
    if (mission) {
      ++taken;
      EXPECT_EQ(encode_plan(*mission), plan);
      const std::string text = mission_text(*mission) + "target { uniform_weight: 1 }";
      EXPECT_EQ(joined(problems_of(text)), "") << bit;
      EXPECT_EQ(plan_of(good(text)), encode_plan(as_scenarios_know_it(*mission))) << bit << ":\n"
                                                                                  << text;
    }
    plan[bit / 8] ^= mask;
  }
  EXPECT_GT(taken, 500);
}

TEST(Limits, TheLongestMissionsAreThoseOfAScenario) {
  for (const char* time :
       {"dt_s: 0.1 duration_s: 1e7", "dt_s: 3600 duration_s: 1e7", "dt_s: 0.3 duration_s: 1e7",
        "dt_s: 1e-6 duration_s: 100", "dt_s: 3600 duration_s: 1801"}) {
    std::string text =
        small_with("u_max_mps: 5", "u_max_mps: 0.01 perturbation: CONSTANT noise_intensity: 0");
    text.replace(text.find("duration_s: 60"), 14, time);
    const Mission mission = good(text).mission();
    const auto read = decode_plan(encode_plan(mission));
    ASSERT_TRUE(read) << time;
    EXPECT_EQ(
        good(mission_text(mission) + "target { uniform_weight: 1 }").mission().timing.tick_count,
        mission.timing.tick_count)
        << time;
  }
}

}  // namespace
}  // namespace ergocast
