// SPDX-License-Identifier: BSD-3-Clause
// What an agent has heard of its teammates on the swarm bus: how much was lost, how old the news is.
#pragma once

#include <algorithm>
#include <map>
#include <vector>

#include "core/ids.h"
#include "team/messages.h"

namespace ergocast {

class Hearing {
 public:
  /// A message of `from`'s own has arrived.
  void count(const Header& from) {
    Heard* const known = find_or_add({from.sender, from.incarnation});
    if (known == nullptr) return;
    Heard& heard = *known;
    if (heard.count == 0) heard.first = from.sequence;
    heard.last = std::max(heard.last, from.sequence);
    ++heard.count;
  }

  /// The coverage of `author` has grown for us, by whatever way it came.
  void news(const Author& author, Tick tick) {
    if (Heard* const heard = find_or_add(author)) heard->news_tick = tick;
  }

  /// Messages missing in the sequences that were heard.
  std::int64_t lost() const {
    std::int64_t lost = 0;
    for (const auto& [author, heard] : heard_) lost += heard.lost();
    return lost;
  }

  /// Ticks since the last news of the teammate that we know least of.
  Tick oldest_news(const std::vector<RosterEntry>& roster, const Author& self, Tick tick) const {
    Tick oldest = 0;
    for (const RosterEntry& entry : roster) {
      if (entry.author == self || !entry.active_at(tick)) continue;
      const auto heard = heard_.find(entry.author);
      const Tick news = heard == heard_.end() ? -1 : heard->second.news_tick;
      oldest = std::max(oldest, tick - std::max(news, entry.active_from - 1));
    }
    return oldest;
  }

 private:
  struct Heard {
    std::int64_t first = 0, last = 0, count = 0;
    Tick news_tick = -1;
    std::int64_t lost() const {
      return count == 0 ? 0 : std::max<std::int64_t>(0, last - first + 1 - count);
    }
  };
  Heard* find_or_add(const Author& author) {
    if (heard_.size() >= kMaxRosterEntries && !heard_.contains(author)) return nullptr;
    return &heard_[author];
  }

  std::map<Author, Heard> heard_;
};

}  // namespace ergocast
