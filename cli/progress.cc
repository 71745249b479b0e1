// SPDX-License-Identifier: BSD-3-Clause
// Turns a mission's progress into short texts and passes them to the progress line, the most
// important first.
#include "cli/progress.h"

#include <algorithm>
#include <vector>

namespace ergocast::cli {
namespace {

/// The texts to show, the most important first.
std::vector<std::string> facts(const MissionProgress& at, double ticks_per_s) {
  std::vector<std::string> said{text_of("t = %.0f of ", static_cast<double>(at.tick) * at.dt_s) +
                                text_of("%.0f s", static_cast<double>(at.tick_count) * at.dt_s)};
  const bool under_way =
      at.tick < at.tick_count && ticks_per_s > 0 && !at.world_silent && !at.paused;
  if (at.paused) said.push_back("paused");
  if (at.world_silent) said.push_back("waiting for the world");
  if (at.coordinator_silent) said.push_back("no coordinator");
  if (under_way) {
    said.push_back(clock_text(static_cast<double>(at.tick_count - at.tick) / ticks_per_s) +
                   " left");
  }
  if (at.ergodic_metric > 0) {
    said.push_back(text_of("phi^2 = %.3g", at.ergodic_metric) +
                   (at.free_domain ? " (free domain)" : ""));
  }
  if (at.silent_agent != kUnassigned && !at.coordinator_silent) {
    said.push_back("agent " + std::to_string(at.silent_agent) + " silent");
  }
  if (at.missed_deadlines > 0) {
    said.push_back(std::to_string(at.missed_deadlines) + " commands late");
  }
  if (!at.coordinator_silent) {
    said.push_back(std::to_string(at.agents_alive) + " of " + std::to_string(at.agents_expected) +
                   " agents");
  }
  if (under_way) said.push_back(text_of("%.0f ticks/s", ticks_per_s));
  return said;
}

}  // namespace

void ProgressDisplay::show(const MissionProgress& progress) {
  const auto now = ProgressLine::Clock::now();
  const double ticks_per_s = ticks_.measure(static_cast<double>(progress.tick), now);
  if (!line_.due(now)) return;
  const auto all = static_cast<double>(std::max<Tick>(1, progress.tick_count));
  line_.show(static_cast<double>(progress.tick) / all, facts(progress, ticks_per_s));
}

}  // namespace ergocast::cli
