// SPDX-License-Identifier: BSD-3-Clause
// Scenarios that steer by the modes of their free domain: what they compile to, and what they
// refuse.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/scenario/scenarios.h"

namespace ergocast {
namespace {

using namespace test;

/// Two rooms with a door; more mass in the right one.
const std::string kRooms = R"(
domain { size_x_m: 100 size_y_m: 50 }
target { gaussians { weight: 3 mean_x_m: 80 mean_y_m: 20 sigma_m: 5 } gaussians { weight: 1 mean_x_m: 20 mean_y_m: 20 sigma_m: 5 } }
basis { modes_x: 5 modes_y: 4 free_domain: true }
law { u_max_mps: 5 }
time { duration_s: 60 }
agents { starts { x_m: 10 y_m: 20 } random_count: 2 }
world {
  speed_limit_mps: 20 wall_clearance_m: 1
  walls { vertices { x_m: 49.8 y_m: 10 } vertices { x_m: 50.2 y_m: 10 } vertices { x_m: 50.2 y_m: 60 } vertices { x_m: 49.8 y_m: 60 } }
}
)";

std::string rooms_with(const std::string& from, const std::string& to) {
  std::string text = kRooms;
  return text.replace(text.find(from), from.size(), to);
}

TEST(FreeDomain, HasItsTableAndBothTargets) {
  const Mission mission = good(kRooms).mission();
  const Mission cosines = good(rooms_with("free_domain: true", "")).mission();
  ASSERT_NE(mission.basis.table, nullptr);
  EXPECT_EQ(mission.basis.table_hash, mission.basis.table->hash);
  EXPECT_EQ(mission.basis.table->mode_count, 20);
  EXPECT_EQ(mission.cosine_target, cosines.target_coefficients);
  EXPECT_EQ(in_cosines(mission).target_coefficients, cosines.target_coefficients);
  EXPECT_EQ(cosines.cosine_target.size(), 0);
  EXPECT_EQ(cosines.basis.table, nullptr);
}

// The lowest mode distinguishes the rooms, and a quarter of the mass is in the left one.
TEST(FreeDomain, TargetIsTheMassOverEachMode) {
  const Mission mission = good(kRooms).mission();
  const auto mode = [&](double x_m) {
    return basis_values({x_m, 20, 0}, mission.domain, mission.basis)[1];
  };
  EXPECT_LT(mode(20) * mode(80), 0);
  EXPECT_EQ(mission.target_coefficients[0], 1);
  EXPECT_NEAR(mission.target_coefficients[1], 0.25 * mode(20) + 0.75 * mode(80), 0.02);
}

TEST(FreeDomain, AnotherSeedHasTheSameTableAndTarget) {
  const Scenario one = good(kRooms), other = one.with_seed(77);
  EXPECT_EQ(other.mission().basis.table.get(), one.mission().basis.table.get());
  EXPECT_EQ(other.mission().target_coefficients, one.mission().target_coefficients);
  EXPECT_EQ(plan_of(other), plan_of(good(Scenario::parse(other.print(), "again"))));
}

TEST(FreeDomain, PlanIsReadWithItsTable) {
  const auto plan = plan_of(good(kRooms));
  const auto plain = decode_plan(plan);
  EXPECT_EQ(plain.value().basis.table, nullptr);
  const auto read = decode_plan_with_table(plan);
  ASSERT_TRUE(read) << read.error();
  EXPECT_NE(read->basis.table, nullptr);
}

// The table is one that another build has computed.
TEST(FreeDomain, PlanWithAnUnknownTableIsRefused) {
  Mission mission = good(kRooms).mission();
  ++mission.basis.table_hash;
  const auto read = decode_plan_with_table(encode_plan(mission));
  ASSERT_FALSE(read);
  EXPECT_TRUE(has(read.error(), "--modes"));
}

TEST(FreeDomain, RefusesWhatIsMadeForCosines) {
  const auto refused = [](const std::string& text) { return joined(problems_of(text)); };
  EXPECT_TRUE(has(refused(rooms_with("size_y_m: 50 }", "size_y_m: 50 size_z_m: 40 }")),
                  "basis.free_domain: needs a plane, and the domain is a box"));
  EXPECT_TRUE(has(refused(rooms_with("modes_x: 5 modes_y: 4", "modes_x: 21 modes_y: 20")),
                  "basis.free_domain: 420 modes are above the limit of a free domain, 400"));
  const std::string kind = "random_count: 2 kind { name: \"a\" count: 3 ";
  EXPECT_TRUE(has(refused(rooms_with("random_count: 2", kind + "footprint_sigma_m: 3 }")),
                  "agents.kind[0].footprint_sigma_m: is a blur of cosines"));
  EXPECT_TRUE(has(refused(rooms_with("random_count: 2", kind + "band { to: 3 } }")),
                  "agents.kind[0].band: is of cosines"));
}

TEST(FreeDomain, GoesWithQualitiesAndADistance) {
  EXPECT_EQ(good(rooms_with("random_count: 2",
                            "random_count: 2 kind { name: \"a\" count: 3 quality: 0.5 }"))
                .mission()
                .kinds.size(),
            1u);
  EXPECT_GT(good(kRooms + "separation { distance_m: 2 }").mission().separation.distance_m, 0);
}

}  // namespace
}  // namespace ergocast
