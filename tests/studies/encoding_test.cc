// SPDX-License-Identifier: BSD-3-Clause
// Coverage that travels in 16 bits has no visible cost for a team. docs/network.md has the figures
// of many more seeds, from
//
//   ergocast study scenarios/quadrimodal_corners.textproto
//     --vary time.contribution_encoding=DOUBLE,FIXED16 --vary time.broadcast_period_ticks=1,5,20
//     --vary agents.dead_reckoning=true,false --seeds 1:120 --out runs/encodings
#include <gtest/gtest.h>

#include <cmath>

#include "plan/plan.h"
#include "scenario/scenario.h"
#include "studies/study_run.h"

namespace ergocast {
namespace {

double metric_of(const char* encoding, const char* period_ticks, const char* dead_reckons,
                 std::uint64_t seed) {
  Overrides overrides;
  overrides.seed = seed;
  overrides.duration_s = 30;
  overrides.fields = {{"time.contribution_encoding", encoding, ""},
                      {"time.broadcast_period_ticks", period_ticks, ""},
                      {"agents.dead_reckoning", dead_reckons, ""}};
  const auto loaded = Scenario::load(
      std::string(ERGOCAST_SCENARIO_DIR) + "/quadrimodal_corners.textproto", overrides);
  const auto plan = encode_plan(loaded.value().mission());
  return studies::run_with_messages(plan).metric;
}

TEST(Encoding, OfSixteenBitsEndsWhereDoublesDo) {
  constexpr int kSeeds = 8;
  for (const char* period_ticks : {"1", "5", "20"}) {
    for (const char* dead_reckons : {"true", "false"}) {
      double log_ratio = 0;
      bool differs = false;
      for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
        const double exact = metric_of("DOUBLE", period_ticks, dead_reckons, seed);
        const double rounded = metric_of("FIXED16", period_ticks, dead_reckons, seed);
        differs = differs || exact != rounded;
        log_ratio += std::log(rounded / exact) / kSeeds;
      }
      EXPECT_LE(std::abs(log_ratio), 0.02) << period_ticks << " ticks, reckons: " << dead_reckons;
      EXPECT_TRUE(differs) << "it is rounded";
    }
  }
}

}  // namespace
}  // namespace ergocast
