// SPDX-License-Identifier: BSD-3-Clause
// Tells what is said for the first time from what is only said again.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>

#include "core/ids.h"
#include "team/messages.h"

namespace ergocast {

/// Whoever records messages can send them again, and a key does not prevent it. A repeat changes
/// nothing by what it says, but it must not keep the dead alive either, nor make anybody speak.
class Freshness {
 public:
  /// Whether its sender has said nothing later yet, nor this, in this life and on this bus. Of
  /// more than kMostLives lives, the later ones are not believed to be alive.
  bool is_news(const Header& from) {
    const Author life{from.sender, from.incarnation};
    const auto at = newest_.find(life);
    if (at == newest_.end()) {
      return newest_.size() < kMostLives && newest_.emplace(life, from.sequence).second;
    }
    if (from.sequence <= at->second) return false;
    at->second = from.sequence;
    return true;
  }

  /// The last sequence that was news of `life`; −1 if nothing was.
  std::int64_t newest(const Author& life) const {
    const auto at = newest_.find(life);
    return at == newest_.end() ? -1 : at->second;
  }

  /// Twice as many as a roster has room for: coordinators, worlds and loggers live more than once.
  static constexpr std::size_t kMostLives = 2 * kMaxRosterEntries;

 private:
  std::map<Author, std::int64_t> newest_;
};

}  // namespace ergocast
