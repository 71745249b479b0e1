// SPDX-License-Identifier: BSD-3-Clause
// Compares the last signs of life of members, and of all incarnations under their numbers, with
// now.
#include "coordinator/silence_watch.h"

#include <algorithm>
#include <map>

#include "core/mission/amendments.h"

namespace ergocast {
namespace {

/// The messages of all incarnations under one number.
struct Number {
  Instant heard{};
  bool speaks = false;  // one of them is not silent, and has sent its status to us
};

std::map<AgentId, Number> numbers_of(const Members& members, const SignsOfLife& signs) {
  std::map<AgentId, Number> numbers;
  for (const auto& [author, member] : members.all()) {
    Number& number = numbers[author.agent];
    number.heard = std::max(number.heard, signs.last(author));
    number.speaks |= member.status && !signs.silent(author);
  }
  return numbers;
}

/// Whether the previous switch has taken effect: an entry has room for one.
bool may_switch(const RosterEntry& entry, const TickWatch& ticks) {
  return ticks.tick() >= entry.since_tick && ticks.world_revision() >= entry.since_revision;
}

}  // namespace

void note_silences(Members& members, const SignsOfLife& signs, Announcement& announcement) {
  for (const RosterEntry& entry : members.roster()) {
    if (entry.active_until >= 0) continue;
    Member& member = members.at(entry.author);
    const bool silent = !signs.alive(entry);
    if (silent && !member.silence_reported) {
      announcement.note_silence();
      member.silence_revision = announcement.revision();
    }
    member.silence_reported = silent;
  }
}

void CoverageReview::review(const Mission& mission, const TickWatch& ticks, Members& members,
                            const SignsOfLife& signs, Announcement& announcement) {
  if (mission.forget_silent_after_s <= 0) return;
  // Without any live member the coordinator may be cut off itself, so it concludes nothing from
  // silence.
  if (members.alive_count(signs) == 0) deaf_until_ = signs.now;
  const auto patience = std::max(seconds(mission.forget_silent_after_s), silence_of(0));
  const auto numbers = numbers_of(members, signs);
  for (RosterEntry& entry : members.roster()) {
    const Number& number = numbers.at(entry.author.agent);
    const bool silent = signs.now - std::max(number.heard, deaf_until_) >= patience;
    const bool other = entry.forgotten ? number.speaks : silent;
    if (!other || !may_switch(entry, ticks)) continue;
    announcement.change();
    entry.forgotten = !entry.forgotten;
    entry.since_tick = ticks.tick() + 1 + notice_ticks(mission.timing);
    entry.since_revision = announcement.revision();
  }
}

}  // namespace ergocast
