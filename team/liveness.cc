// SPDX-License-Identifier: BSD-3-Clause
// Defines the heartbeat and the silence limit of each kind of process, and records signs of life.
#include "team/liveness.h"

#include <algorithm>
#include <chrono>

namespace ergocast {
namespace {

using namespace std::chrono_literals;

/// TEAM_STATUS comes twice as often as an agent's status, MISSION once a second.
constexpr PacingClock::duration kTeamStatusHeartbeat = 250ms;
constexpr PacingClock::duration kMissionHeartbeat = 1s;

}  // namespace

PacingClock::duration heartbeat_of(AgentId sender, CoordinatorSign sign, const Timing* timing) {
  if (sender == kCoordinator) {
    return sign == CoordinatorSign::kTeamStatus ? kTeamStatusHeartbeat : kMissionHeartbeat;
  }
  if (sender != kWorld || timing == nullptr || timing->pace == Pace::kLockstep) {
    return kAgentStatusPeriod;
  }
  return std::max<PacingClock::duration>(kAgentStatusPeriod,
                                         seconds(timing->dt_s / timing->realtime_factor));
}

PacingClock::duration silence_of(AgentId sender, CoordinatorSign sign, const Timing* timing) {
  return kMissedHeartbeats * heartbeat_of(sender, sign, timing);
}

bool must_be_over(const Timing& timing, Tick newest, PacingClock::duration silence) {
  const auto ticks_left = static_cast<double>(timing.tick_count - std::max<Tick>(newest, 0));
  // The duration of a lockstep mission is unknown, but each tick has a time limit.
  const double plan_s = timing.pace == Pace::kLockstep
                            ? timing.lockstep_timeout_s
                            : ticks_left * timing.dt_s / timing.realtime_factor;
  return std::chrono::duration<double>(silence).count() > plan_s + kFarewellPatience_s;
}

Liveness::Seen* Liveness::find_or_add(const Author& author) {
  if (Seen* known = incarnations_.find(author)) return known;
  return incarnations_.size() >= kMaxIncarnations ? nullptr : &incarnations_[author];
}

bool Liveness::record(const Header& from, Bus bus, Instant now, bool is_sign) {
  Seen* const seen = find_or_add({from.sender, from.incarnation});
  if (seen == nullptr) return false;
  Received& received = seen->on_bus[static_cast<std::size_t>(bus)];
  const bool fresh = received.count == 0 || from.sequence > received.newest;
  if (received.count++ == 0) received.first = from.sequence;
  if (!fresh) return false;
  received.newest = from.sequence;
  if (is_sign) seen->sign = kinds_[kind_of(from.sender)] = now;
  return true;
}

void Liveness::presume_alive(const Author& author, Instant now) {
  incarnations_[author].sign = now;
}

std::optional<Instant> Liveness::last_sign(const Author& author) const {
  const Seen* const known = incarnations_.find(author);
  return known == nullptr ? std::nullopt : known->sign;
}

const Liveness::Received* Liveness::received_from(const Author& author, Bus bus) const {
  const Seen* const known = incarnations_.find(author);
  if (known == nullptr) return nullptr;
  const Received& received = known->on_bus[static_cast<std::size_t>(bus)];
  return received.count == 0 ? nullptr : &received;
}

std::int64_t Liveness::newest(const Author& author, Bus bus) const {
  const Received* const received = received_from(author, bus);
  return received == nullptr ? -1 : received->newest;
}

std::int64_t Liveness::lost(const Author& author, Bus bus) const {
  const Received* const received = received_from(author, bus);
  if (received == nullptr) return 0;
  // Messages before the first one, or repeats, may compensate for lost ones; the result is at least
  // 0.
  return std::max<std::int64_t>(0, received->newest - received->first + 1 - received->count);
}

}  // namespace ergocast
