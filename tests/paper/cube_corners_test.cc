// SPDX-License-Identifier: BSD-3-Clause
// Eight agents on the corners of a cube: the classical law leaves some where they are, the default
// law covers all peaks. docs/law.md has the figures of 100 seeds.
#include <gtest/gtest.h>

#include "lab/ideal_team.h"
#include "tests/scenario/scenarios.h"

namespace ergocast {
namespace {

using namespace test;

lab::IdealTeam flown(const std::vector<FieldValue>& fields) {
  Overrides overrides;
  overrides.duration_s = 200;
  overrides.fields = fields;
  lab::IdealTeam team(good(Scenario::load(shipped("cube_corners"), overrides)).mission());
  team.run_until(200);
  return team;
}

TEST(CubeCorners, HoldTheClassicalLaw) {
  const lab::IdealTeam team = flown({{"law.regularization", "ABSOLUTE", "--set"},
                                     {"law.perturbation", "CONSTANT", "--set"},
                                     {"law.noise_intensity", "0", "--set"},
                                     {"law.contraction_gain_per_s", "0", "--set"}});
  EXPECT_EQ(team.x_m(0), team.mission().starts_m[0]);
  EXPECT_GT(team.metric(), 0.05);
}

TEST(CubeCorners, ReleaseAgentsThatLookAheadFirst) {
  const lab::IdealTeam ours = flown({}), known = flown({{"law.anticipation", "0", "--set"}});
  EXPECT_LT(ours.metric(), 0.5 * known.metric());
  for (std::size_t i = 0; i < ours.size(); ++i)
    EXPECT_GT((ours.x_m(i) - ours.mission().starts_m[i]).norm(), 10) << "agent " << i;
}

}  // namespace
}  // namespace ergocast
