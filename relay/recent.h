// SPDX-License-Identifier: BSD-3-Clause
// Remembers what a relay has carried, so that nothing is carried twice or in a circle.
#pragma once

#include <chrono>
#include <cstddef>
#include <deque>
#include <map>
#include <set>
#include <utility>

#include "core/base/ids.h"
#include "relay/gate.h"

namespace ergocast::relay {

/// What was carried within the last second. A copy within that second came by another way: a
/// second relay at the site, or a VPN beside it. A later copy is a repeat that somebody needs.
class Recent {
 public:
  static constexpr std::chrono::nanoseconds kTime = std::chrono::seconds(1);
  /// Limit (Network): datagrams that a relay remembers for a second. Beyond it: the oldest is
  /// forgotten, so that it may be carried twice.
  static constexpr std::size_t kMostRemembered = 65536;

  /// Whether it was not noted within the last second. If so, it is noted.
  bool note(const Identity& one, Instant now) {
    while (!notes_.empty() && notes_.front().first + kTime <= now) forget();
    if (!known_.insert(one).second) return false;
    if (notes_.size() == kMostRemembered) forget();
    notes_.emplace_back(now, one);
    return true;
  }

 private:
  void forget() {
    known_.erase(notes_.front().second);
    notes_.pop_front();
  }

  std::set<Identity> known_;
  std::deque<std::pair<Instant, Identity>> notes_;  // oldest first
};

/// What this relay has put into the local group itself, and will receive from there. A process that
/// stood still may receive it much later. What the socket's buffer lost never comes.
class Echoes {
 public:
  /// Then an echo was lost, and what comes is a repeat that somebody needs.
  static constexpr std::chrono::nanoseconds kTime = std::chrono::seconds(60);

  void sent(const Identity& one, Instant now) {
    if (order_.size() == Recent::kMostRemembered) forget();
    Pending& pending = pending_[one];
    ++pending.count;
    pending.last = now;
    order_.emplace_back(now, one);
  }
  /// Whether it is such an echo, which is then forgotten.
  bool take(const Identity& one, Instant now) {
    while (!order_.empty() && order_.front().first + kTime <= now) forget();
    const auto at = pending_.find(one);
    if (at == pending_.end()) return false;
    if (--at->second.count == 0) pending_.erase(at);
    return true;
  }

 private:
  struct Pending {
    int count = 0;
    Instant last{};
  };
  void forget() {
    const auto& [when, one] = order_.front();
    const auto at = pending_.find(one);
    if (at != pending_.end() && at->second.last == when) pending_.erase(at);
    order_.pop_front();
  }

  std::map<Identity, Pending> pending_;
  std::deque<std::pair<Instant, Identity>> order_;  // oldest first
};

}  // namespace ergocast::relay
