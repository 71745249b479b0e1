// SPDX-License-Identifier: BSD-3-Clause
// Displays the progress of a mission.
#pragma once

#include <functional>
#include <string>
#include <utility>

#include "cli/progress_line.h"
#include "core/base/ids.h"
#include "runtime/process/program_options.h"

namespace ergocast::cli {

struct MissionProgress {
  Tick tick = 0, tick_count = 0;  ///< of ticks that count
  Tick world_tick = 0;            ///< continues in a pause
  double dt_s = 0;
  double ergodic_metric = 0;
  int agents_alive = 0, agents_expected = 0;
  std::int64_t missed_deadlines = 0;
  AgentId silent_agent = kUnassigned;
  bool world_silent = false, coordinator_silent = false, paused = false;
  bool free_domain = false;  ///< the metric is in modes of the free domain, not in cosines
};

class ProgressDisplay {
 public:
  /// Shows the progress, if the last display was long enough ago.
  void show(const MissionProgress& progress);
  void print(const std::string& line) {
    line_.print(stamped_ ? wall_clock_text() + ' ' + line : line);
    if (also_) also_(line);
  }
  /// From now on each printed line begins with the wall time.
  void stamp() { stamped_ = true; }
  /// A second receiver of the lines.
  void also_to(std::function<void(const std::string&)> listener) { also_ = std::move(listener); }
  void end() { line_.end(); }

 private:
  void warn_of_overload(const MissionProgress& progress);

  ProgressLine line_;
  Rate ticks_;
  bool overload_reported_ = false, stamped_ = false;
  std::function<void(const std::string&)> also_;
};

}  // namespace ergocast::cli
