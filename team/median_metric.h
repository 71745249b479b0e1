// SPDX-License-Identifier: BSD-3-Clause
// The one φ² of a team, from those that its members report.
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <vector>

#include "team/messages.h"

namespace ergocast {

/// The median of φ² over the members that have answered a tick. For an even number of members it is
/// the greater of the two values in the middle. Nothing if no member has answered a tick.
/// @param members  the last status of each member, not null
inline std::optional<double> median_metric(const std::vector<const AgentStatus*>& members) {
  std::vector<double> metrics;
  for (const AgentStatus* member : members) {
    if (member->answered_tick >= 0) metrics.push_back(member->ergodic_metric);
  }
  if (metrics.empty()) return std::nullopt;
  const auto middle = metrics.begin() + static_cast<std::ptrdiff_t>(metrics.size() / 2);
  std::nth_element(metrics.begin(), middle, metrics.end());
  return *middle;
}

}  // namespace ergocast
