// SPDX-License-Identifier: BSD-3-Clause
// The one φ² of a team is the median over its members that have answered a tick.
#include "team/median_metric.h"

#include <gtest/gtest.h>

namespace ergocast {
namespace {

/// The median of members that report `metrics`; a negative one has not answered a tick.
std::optional<double> median_of(const std::vector<double>& metrics) {
  std::vector<AgentStatus> statuses(metrics.size());
  std::vector<const AgentStatus*> members;
  for (std::size_t i = 0; i < metrics.size(); ++i) {
    statuses[i].ergodic_metric = metrics[i];
    statuses[i].answered_tick = metrics[i] < 0 ? -1 : 0;
    members.push_back(&statuses[i]);
  }
  return median_metric(members);
}

TEST(MedianMetric, IsThatOfTheMembersThatHaveAnswered) {
  EXPECT_EQ(median_of({}), std::nullopt);
  EXPECT_EQ(median_of({-1, -1}), std::nullopt);
  EXPECT_EQ(median_of({-1, 4}), 4);
  EXPECT_EQ(median_of({9, 1, 3}), 3);
  EXPECT_EQ(median_of({9, 1, -1, 3, 5}), 5) << "the greater of the two in the middle";
}

}  // namespace
}  // namespace ergocast
