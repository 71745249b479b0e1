// How far a mission is: a bar on a terminal, a plain line now and then elsewhere.
#pragma once

#include <chrono>
#include <string>

#include "core/ids.h"

namespace ergocast::cli {

struct MissionProgress {
  Tick tick = 0, tick_count = 0;
  double dt_s = 0;
  double ergodic_metric = 0;
  int agents_alive = 0, agents_expected = 0;
  std::int64_t missed_deadlines = 0;
  AgentId silent_agent = kUnassigned;
  bool world_silent = false, coordinator_silent = false;
};

class ProgressDisplay {
 public:
  ProgressDisplay();
  ProgressDisplay(const ProgressDisplay&) = delete;
  ProgressDisplay& operator=(const ProgressDisplay&) = delete;
  ~ProgressDisplay() { end(); }

  /// Shows it, if the last time is long enough ago.
  void show(const MissionProgress& progress);
  /// A line of its own, above the bar.
  void say(const std::string& line);
  /// The bar's last state stays; what follows begins on a new line.
  void end();

 private:
  using Clock = std::chrono::steady_clock;
  void measure_rate(Tick tick, Clock::time_point now);

  bool terminal_;
  bool bar_shown_ = false;
  Clock::time_point next_{}, rate_since_{};
  Tick rate_from_ = 0;
  double ticks_per_s_ = 0;
};

}  // namespace ergocast::cli
