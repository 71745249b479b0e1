// SPDX-License-Identifier: BSD-3-Clause
// Turns a mission's progress into short texts and passes them to the progress line, the most
// important first.
#include "cli/watch/progress.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "cli/team/overload.h"

namespace ergocast::cli {
namespace {

bool overloaded(const MissionProgress& at) {
  return overload_warning(at.missed_deadlines, at.world_tick, at.agents_expected).has_value();
}

/// The texts to show, the most important first.
std::vector<std::string> facts(const MissionProgress& at, double ticks_per_s) {
  std::vector<std::string> parts{text_of("t = %.0f of ", static_cast<double>(at.tick) * at.dt_s) +
                                 text_of("%.0f s", static_cast<double>(at.tick_count) * at.dt_s)};
  const bool under_way =
      at.tick < at.tick_count && ticks_per_s > 0 && !at.world_silent && !at.paused;
  if (at.paused) parts.push_back("paused");
  if (at.world_silent) parts.push_back("waiting for the world");
  if (at.coordinator_silent) parts.push_back("no coordinator");
  if (overloaded(at)) {
    const double share = late_share(at.missed_deadlines, at.world_tick, at.agents_expected);
    parts.push_back("WARNING: " + std::to_string(std::lround(100 * share)) + " % of commands late");
  }
  if (under_way) {
    parts.push_back(clock_text(static_cast<double>(at.tick_count - at.tick) / ticks_per_s) +
                    " left");
  }
  if (at.ergodic_metric > 0) {
    parts.push_back(text_of("phi^2 = %.3g", at.ergodic_metric) +
                    (at.free_domain ? " (free domain)" : ""));
  }
  if (at.silent_agent != kUnassigned && !at.coordinator_silent) {
    parts.push_back("agent " + std::to_string(at.silent_agent) + " silent");
  }
  if (at.missed_deadlines > 0 && !overloaded(at)) {
    parts.push_back(std::to_string(at.missed_deadlines) + " commands late");
  }
  if (!at.coordinator_silent) {
    parts.push_back(std::to_string(at.agents_alive) + " of " + std::to_string(at.agents_expected) +
                    " agents");
  }
  if (under_way) parts.push_back(text_of("%.0f ticks/s", ticks_per_s));
  return parts;
}

}  // namespace

void ProgressDisplay::show(const MissionProgress& progress) {
  const auto now = ProgressLine::Clock::now();
  const auto count = static_cast<double>(progress.tick);
  const bool stands = progress.paused || progress.tick == 0;
  const double ticks_per_s = stands ? ticks_.interrupt(count, now) : ticks_.measure(count, now);
  warn_of_overload(progress);
  if (!line_.due(now)) return;
  const auto all = static_cast<double>(std::max<Tick>(1, progress.tick_count));
  line_.show(static_cast<double>(progress.tick) / all, facts(progress, ticks_per_s));
}

/// Reports it once; the progress line repeats it.
void ProgressDisplay::warn_of_overload(const MissionProgress& at) {
  if (overload_reported_) return;
  const auto warning = overload_warning(at.missed_deadlines, at.world_tick, at.agents_expected);
  if (!warning) return;
  overload_reported_ = true;
  print("warning: " + *warning);
}

}  // namespace ergocast::cli
