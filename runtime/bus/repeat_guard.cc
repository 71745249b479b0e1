// SPDX-License-Identifier: BSD-3-Clause
// Counts repeats in short windows and lists the newest sequence of each repeated incarnation while
// a flood lasts.
#include "runtime/bus/repeat_guard.h"

namespace ergocast {

bool RepeatGuard::count(const Header& from, bool is_new, Instant now) {
  if (!is_new) {
    ++repeats_;
    if (flooding_.size() < kMaxIncarnations) flooding_.insert({from.sender, from.incarnation});
  }
  const bool was_flooded = !flooded_.empty();
  const bool lapsed = now - window_began_ >= kWindow * (was_flooded ? kCalmWindows : 1);
  if (repeats_ < kMostRepeats && !lapsed) return false;
  // While the kernel drops repeats, each repeat that passes stands for many.
  const bool goes_on =
      was_flooded && repeats_ * static_cast<int>(kShareThatPasses) >= kMostRepeats * kCalmWindows;
  const bool flooded = repeats_ >= kMostRepeats || goes_on;
  window_began_ = now;
  repeats_ = 0;
  flooded_.clear();
  if (!flooded) {
    flooding_.clear();
    return was_flooded;
  }
  for (const Author& author : flooding_) {
    flooded_.push_back({author.incarnation, liveness_.newest(author, bus_)});
  }
  return true;
}

}  // namespace ergocast
