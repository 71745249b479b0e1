// SPDX-License-Identifier: BSD-3-Clause
// Compares the late commands with all that were due since the mission's start.
#include "cli/team/overload.h"

#include <algorithm>
#include <cmath>

namespace ergocast {
namespace {

/// The summary's reason has the same threshold.
constexpr double kNotableShare = 0.01;
/// Each team has a few late commands at its start.
constexpr std::int64_t kFew = 20;

}  // namespace

double late_share(std::int64_t missed_deadlines, Tick ticks, int agents) {
  const double due = static_cast<double>(ticks) * agents;
  return due < 1 ? 0 : std::min(1.0, static_cast<double>(missed_deadlines) / due);
}

std::optional<std::string> overload_warning(std::int64_t missed_deadlines, Tick ticks, int agents) {
  const double share = late_share(missed_deadlines, ticks, agents);
  if (missed_deadlines < kFew || share < kNotableShare) return std::nullopt;
  return std::to_string(std::lround(100 * share)) +
         " % of the commands came too late for their tick, and vehicles went on with older ones: "
         "this machine or the network is too slow. Choose a smaller --realtime factor, a longer "
         "time.dt_s or fewer agents";
}

}  // namespace ergocast
