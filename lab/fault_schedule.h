// SPDX-License-Identifier: BSD-3-Clause
// When faults of processes and links begin and end. The simulation carries them out.
#pragma once

#include <cstddef>
#include <vector>

#include "core/base/ids.h"
#include "core/mission/mission.h"
#include "lab/faults.h"

namespace ergocast::lab {

/// Virtual time that a whole mission takes.
inline double planned_s(const Mission& mission) {
  const Timing& timing = mission.timing;
  return static_cast<double>(timing.tick_count) * timing.dt_s / timing.realtime_factor;
}

class FaultSchedule {
 public:
  FaultSchedule(const Faults& faults, const Mission& mission);

  /// The next moment at which a fault begins or ends. The last event is healing, which ends all
  /// faults; Instant::max() after it.
  Instant next() const;
  bool healed() const { return healed_; }
  /// Whether faults hinder processes now.
  bool hinders() const { return (hinders_ && !healed_) || !ends_.empty(); }

  /// Takes the next fault that begins by now; null: none does. Valid until the next call.
  /// @param progress_s  Simulation::progress_s()
  const FaultEvent* take_begin(Instant now, double progress_s);
  /// `event` ends at `at`.
  void end_at(Instant at, const FaultEvent& event) { ends_.push_back({at, event}); }
  /// Calls `end` with each event that ends by now.
  template <class F>
  void end_due(Instant now, const F& end) {
    std::erase_if(ends_, [&](const End& one) {
      if (one.at > now) return false;
      end(one.event);
      return true;
    });
  }
  /// Whether all is to be healed now.
  bool healing_due(Instant now, double progress_s) const;
  void heal();

 private:
  struct End {
    Instant at;
    FaultEvent event;
  };

  double faulty_s_;  // progress_s() at which all is healed
  std::vector<FaultEvent> events_;
  std::size_t next_ = 0;
  std::vector<End> ends_;
  bool healed_ = false;
  bool hinders_;  // even if only messages have faults
};

}  // namespace ergocast::lab
