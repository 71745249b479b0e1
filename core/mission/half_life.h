// SPDX-License-Identifier: BSD-3-Clause
// Forgetting by halving: law.memory_half_life_s of a mission.
//
// At every counted tick H, 2H, 3H …, before that tick's sample, all sums of a row and the time that
// they cover are halved. Halving a binary number is exact, and so it commutes with every rounding:
// a row that is halved when it is used equals one that its author has halved. Decay by a factor at
// each step would not have this property. c_k = Σ S / Σ T does not jump at such a tick, because
// both sums are halved.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/base/ids.h"
#include "core/mission/mission.h"

namespace ergocast {

class HalfLife {
 public:
  HalfLife() = default;  ///< nothing is ever forgotten
  /// H is the nearest number of steps, at least one.
  HalfLife(double half_life_s, double dt_s)
      : ticks_(half_life_s > 0 ? std::max<Tick>(1, std::llround(half_life_s / dt_s)) : 0) {}
  explicit HalfLife(const Mission& mission)
      : HalfLife(mission.law.memory_half_life_s, mission.timing.dt_s) {}

  /// Whether anything is ever forgotten.
  bool any() const { return ticks_ > 0; }
  /// H; 0 if nothing is forgotten.
  Tick ticks() const { return ticks_; }

  /// How often sums have been halved by the sample of the counted tick `tick`.
  std::int64_t halvings(Tick tick) const {
    return ticks_ > 0 ? std::max<Tick>(0, tick) / ticks_ : 0;
  }
  /// The first tick whose sample follows so many halvings.
  Tick tick_of(std::int64_t halvings) const { return halvings * ticks_; }

  /// By what sums that have been halved `had` times are multiplied, so that they have been halved
  /// `wanted` times. It is a power of two from 2^-512 to 2^64: no message can make a number
  /// infinite, and what has faded further has no effect beside a new step.
  static double factor(std::int64_t had, std::int64_t wanted) {
    if (had == wanted) return 1;
    return std::ldexp(1.0, static_cast<int>(std::clamp<std::int64_t>(had - wanted, -512, 64)));
  }

  /// Σ of what the ticks of [from, until) weigh once all has been halved so many times. A tick that
  /// weighs less than 2^-64 of the newest one does not count.
  double remembered_ticks(Tick from, Tick until, std::int64_t halved) const {
    if (!any()) return static_cast<double>(std::max<Tick>(0, until - from));
    double sum = 0;
    const std::int64_t last = halvings(until - 1);
    for (std::int64_t i = last; i >= std::max<std::int64_t>(0, last - 64) && from < until; --i) {
      const Tick first = i > 0 ? std::max(from, tick_of(i)) : from;
      sum += static_cast<double>(until - first) * factor(i, halved);
      until = first;
    }
    return sum;
  }

  /// The longest time that a row can cover: less than 2 H steps, and room for the steps of an agent
  /// that learns late of a pause. @pre any()
  double longest_memory_s(double dt_s) const {
    return 2 * static_cast<double>(ticks_) * dt_s + std::max(60.0, 64 * dt_s);
  }

 private:
  Tick ticks_ = 0;
};

}  // namespace ergocast
