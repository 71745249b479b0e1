// SPDX-License-Identifier: BSD-3-Clause
// The stops of the last minute, for sites that were cut off when they came.
//
// `ergocast stop` repeats a stop only until the processes that it knows of have obeyed. Receivers
// refuse a stop of another run, and one that is too old.
#pragma once

#include <chrono>
#include <cstddef>
#include <map>
#include <span>
#include <vector>

#include "core/base/ids.h"
#include "relay/gate.h"
#include "relay/outbound_queue.h"

namespace ergocast::relay {

class KeptStops {
 public:
  /// How long a stop is kept. Receivers accept an older one only if they have learned nothing
  /// since.
  static constexpr std::chrono::nanoseconds kTime = std::chrono::seconds(60);
  /// Limit (Network): stops that a relay keeps for a minute, one for each run, bus and sender.
  /// Beyond it: a site that joins later does not receive the others.
  static constexpr std::size_t kMost = 64;

  /// Keeps it if it is a stop.
  void note(const Admitted& admitted, Bus bus, std::span<const std::byte> datagram, Instant now) {
    if (!admitted.stops || !admitted.place) return;
    std::erase_if(kept_, [&](const auto& one) { return one.second.at + kTime <= now; });
    if (kept_.size() == kMost && !kept_.contains(*admitted.place)) return;
    kept_[*admitted.place] = {admitted, bus, {datagram.begin(), datagram.end()}, now};
  }
  /// Queues those that came before the flow began.
  void give(Sender& sender, Instant begun, Instant now) const {
    for (const auto& [place, one] : kept_) {
      if (one.at < begun && now < one.at + kTime) sender.add(one.admitted, one.bus, one.datagram);
    }
  }

 private:
  struct Kept {
    Admitted admitted;
    Bus bus;
    std::vector<std::byte> datagram;
    Instant at;
  };
  std::map<Place, Kept> kept_;
};

}  // namespace ergocast::relay
