// SPDX-License-Identifier: BSD-3-Clause
// Goes through the drawn events by virtual time and by the mission's progress.
#include "lab/fault_schedule.h"

#include <algorithm>

namespace ergocast::lab {
namespace {

/// Time passes in whole nanoseconds: a moment may have come although progress_s() is a rounding
/// error short.
bool comes(double at_s, Instant now) { return Instant(seconds(at_s)) <= now; }

/// The time for which faults last.
double faulty_time_s(const Faults& faults, const Mission& mission) {
  const double share_s = faults.lasting_share * planned_s(mission);
  // A share of 1 lasts to the end, also of a mission that began late.
  return faults.lasting_share >= 1 ? share_s + mission.timing.admission_timeout_s : share_s;
}

}  // namespace

FaultSchedule::FaultSchedule(const Faults& faults, const Mission& mission)
    : faulty_s_(faulty_time_s(faults, mission)),
      events_(
          fault_events(faults, mission.seed, static_cast<int>(mission.starts_m.size()), faulty_s_)),
      hinders_(lab::hinders(faults, mission.timing.lockstep_timeout_s)) {}

Instant FaultSchedule::next() const {
  if (healed_) return Instant::max();
  const bool any = next_ < events_.size();
  Instant next(seconds(any ? std::min(events_[next_].at_s, faulty_s_) : faulty_s_));
  for (const End& end : ends_) next = std::min(next, end.at);
  return next;
}

const FaultEvent* FaultSchedule::take_begin(Instant now, double progress_s) {
  if (next_ >= events_.size()) return nullptr;
  const double at_s = events_[next_].at_s;
  if (!comes(at_s, now) && at_s > progress_s + 1e-9) return nullptr;
  return &events_[next_++];
}

bool FaultSchedule::healing_due(Instant now, double progress_s) const {
  return comes(faulty_s_, now) || progress_s >= faulty_s_;
}

void FaultSchedule::heal() {
  healed_ = true;
  ends_.clear();
}

}  // namespace ergocast::lab
