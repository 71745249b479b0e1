// SPDX-License-Identifier: BSD-3-Clause
// A process's own clock, with the rate and offset that the laboratory sets.
#pragma once

#include <cmath>

#include "core/base/ids.h"

namespace ergocast::lab {

/// local = offset + rate · virtual.
class SkewedClock {
 public:
  SkewedClock() = default;
  SkewedClock(double rate, PacingClock::duration offset) : rate_(rate), offset_(offset) {}

  Instant local(Instant virtual_time) const {
    if (rate_ == 1) return virtual_time + offset_;
    const auto ns = static_cast<double>(virtual_time.time_since_epoch().count());
    return Instant(offset_ + PacingClock::duration(std::llround(rate_ * ns)));
  }

  /// The first virtual time at which local() is at least `wanted`.
  Instant when(Instant wanted) const {
    if (wanted == Instant::max()) return wanted;
    if (rate_ == 1) return wanted - offset_;
    const auto ns = static_cast<double>((wanted.time_since_epoch() - offset_).count());
    Instant at(PacingClock::duration(std::llround(ns / rate_)));
    while (local(at) < wanted) at += PacingClock::duration(1);
    return at;
  }

 private:
  double rate_ = 1;
  PacingClock::duration offset_{};
};

}  // namespace ergocast::lab
