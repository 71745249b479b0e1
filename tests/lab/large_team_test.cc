// SPDX-License-Identifier: BSD-3-Clause
// A team too large for one digest: under loss and restarts, every agent learns every row within the
// bound that lab/invariants.h states. Each trial checks that bound.
#include <gtest/gtest.h>

#include "agent/anti_entropy.h"
#include "tests/support/simulated_team.h"

namespace ergocast::test {
namespace {

constexpr const char* kScenario = R"(
domain { size_x_m: 100 size_y_m: 100 }
target { uniform_weight: 1 }
basis { modes_x: 4 modes_y: 4 }
law { u_max_mps: 5 }
time { dt_s: 0.5 duration_s: 90 broadcast_period_ticks: 4 pace: REALTIME admission_timeout_s: 600 }
agents { random_count: 48 quorum: 40 }
)";

TEST(LargeTeam, LearnsEveryRowWithinTheBoundUnderLossAndRestarts) {
  const auto scenario = Scenario::parse(kScenario, "large").value();
  ASSERT_GT(scenario.mission().starts_m.size(), std::size_t{kMaxDigestEntriesPerMessage});
  lab::Faults faults;
  faults.loss = 0.3;
  faults.agent_crashes_per_s = 0.3;
  faults.downtime_max_s = 10;
  faults.lasting_share = 0.4;
  const TriedTeam tried(faults, 1, scenario);
  EXPECT_EQ(tried.problem(), "");
  EXPECT_GT(tried.result.figures.agent_crashes, 3);
  EXPECT_GT(tried.result.figures.relayed, 0);
}

}  // namespace
}  // namespace ergocast::test
