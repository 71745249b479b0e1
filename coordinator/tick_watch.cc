// SPDX-License-Identifier: BSD-3-Clause
// Compares the answers that the world has received with the tick, and the last signs of life.
#include "coordinator/tick_watch.h"

#include <sstream>

namespace ergocast {
namespace {

/// A message of an agent that is older than this is out of date.
constexpr auto kOverdue = kAgentStatusPeriod * 3 / 2;

}  // namespace

bool TickWatch::receive(const WorldState& world, Instant now) {
  world_heard_ = true;
  if (world.header.tick < tick_) {
    // A restarted world may be behind its predecessor. It knows more of the mission.
    world_revision_ = std::max(world_revision_, world.roster_revision);
    return false;
  }
  if (world.header.tick > tick_) since_ = now;
  tick_ = world.header.tick;
  world_revision_ = world.roster_revision;
  missed_deadlines_ = std::max(missed_deadlines_, world.missed_deadlines);
  for (const Vehicle& vehicle : world.vehicles_in_part()) {
    Tick& answered = answered_.try_emplace(vehicle.id, -1).first->second;
    answered = std::max(answered, vehicle.answered_tick);
  }
  return true;
}

void TickWatch::receive_question(const Hello& question, Instant now) {
  if (question.header.incarnation != asking_world_) since_ = now;
  asking_world_ = question.header.incarnation;
  asks_for_ = question.requested_id;
  asked_ = now;
}

void TickWatch::take_over(Tick end, Instant now) {
  agents_tick_ = std::min(agents_tick_, end);
  tick_ = std::max(std::min(tick_, end), agents_tick_);
  since_ = now;
}

RosterEntry* TickWatch::straggler(Members& members, const SignsOfLife& signs) {
  // A restarted world lacks the answers that the former incarnation may have received.
  const bool asks = signs.now - asked_ <= kOverdue;
  RosterEntry* unheard = asks ? members.active_entry(asks_for_) : nullptr;
  if (unheard != nullptr) return unheard;
  RosterEntry* silent = nullptr;
  RosterEntry* suspect = nullptr;
  for (RosterEntry& entry : members.roster()) {
    if (entry.active_until >= 0 || answered_[entry.author.agent] >= tick_) continue;
    const Instant heard = signs.last(entry.author);
    if (signs.now - heard > kOverdue) {
      if (silent == nullptr || heard < signs.last(silent->author)) silent = &entry;
      continue;
    }
    // A member that waits for a teammate is no straggler. That teammate is one, unless it waits
    // itself.
    const AgentId teammate = members.waits_for(entry);
    RosterEntry* named = teammate == kUnassigned ? nullptr : members.active_entry(teammate);
    if (named != nullptr && members.waits_for(*named) == kUnassigned) {
      suspect = named;
    } else if (suspect == nullptr) {
      suspect = &entry;
    }
  }
  return silent != nullptr ? silent : suspect;
}

std::optional<OverdueTick> TickWatch::overdue(const Timing& timing, Members& members,
                                              const SignsOfLife& signs) {
  if (signs.now - since_ < seconds(timing.lockstep_timeout_s)) return std::nullopt;
  RosterEntry* const late = straggler(members, signs);
  std::ostringstream since_text;
  since_text << " for " << timing.lockstep_timeout_s << " s";
  const std::string since = since_text.str(), tick = std::to_string(tick_);
  if (late != nullptr) {
    const std::string agent = std::to_string(late->author.agent);
    return OverdueTick{late, "agent " + agent + " has not answered tick " + tick + since};
  }
  if (members.alive_count(signs) == 0) {
    return OverdueTick{nullptr, "no agent is left to answer tick " + tick};
  }
  if (world_heard_)
    return OverdueTick{nullptr, "the world has not gone beyond tick " + tick + since};
  return OverdueTick{nullptr, "no world answered" + since + ": is one running on this URL?"};
}

}  // namespace ergocast
