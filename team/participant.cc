// SPDX-License-Identifier: BSD-3-Clause
// Decides which messages are accepted, and counts the refused ones.
#include "team/participant.h"

#include <algorithm>

namespace ergocast {

std::optional<Arrival> Participant::accept(const Message& message, Bus bus, AgentId transmitter,
                                           Instant now) {
  const Header& from = header_of(message);
  if (!subscribes(subscriptions_of(role_), bus, message)) return std::nullopt;
  // Multicast returns our own messages to us.
  if (self_.incarnation != 0 && from.incarnation == self_.incarnation) return std::nullopt;
  if (self_.run != 0 && from.run != self_.run) {
    count_refused(Refusal::kRun);
    return std::nullopt;
  }
  if (too_late(message, now)) {
    count_refused(Refusal::kLate);
    return std::nullopt;
  }
  ++received_;
  Arrival arrival{from, transmitter, now};
  const auto* part = std::get_if<MissionPart>(&message);
  // Teammates repeat MISSION in the coordinator's name, also after its end.
  const bool is_sign = part == nullptr || coordinator_sign() == CoordinatorSign::kMission;
  // An agent without a number is no member yet, and an attacker could send HELLO under any number
  // of incarnations.
  const bool asks = std::holds_alternative<Hello>(message) && from.sender >= kUnassigned;
  const bool direct = transmitter == from.sender;
  arrival.fresh = direct && !asks && liveness_.record(from, bus, now, is_sign);
  if (part != nullptr) follow(*part, arrival);
  return arrival;
}

/// Whether a command of the operator names an old tick. It is compared with the ticks that we have
/// sent, which a listening operator knows. Before we send any, the signed ticks of MISSION count.
bool Participant::too_late(const Message& message, Instant now) {
  window_.note(std::max(own_tick_, mission_tick_), own_tick_ >= 0, now);
  const bool is_command = std::holds_alternative<Stop>(message) ||
                          std::holds_alternative<Amend>(message) ||
                          std::holds_alternative<Recall>(message);
  return is_command && !window_.admits(header_of(message).tick);
}

void Participant::follow(const MissionPart& part, Arrival& arrival) {
  mission_tick_ = std::max(mission_tick_, part.header.tick);
  if (self_.run == 0) self_.run = part.header.run;
  const std::int64_t foreign_plans = follower_.foreign_plans();
  arrival.mission_changed = follower_.receive(part);
  if (arrival.fresh || arrival.mission_changed) mission_heard_ = arrival.now;
  if (follower_.foreign_plans() != foreign_plans) count_refused(Refusal::kRange);
}

const RosterEntry* Participant::member(const Header& from) const {
  const RosterEntry* entry = follower_.entry_of(from.incarnation);
  return entry != nullptr && entry->author.agent == from.sender ? entry : nullptr;
}

CoordinatorSign Participant::coordinator_sign() const {
  const MessageTypes heard = subscriptions_of(role_)[static_cast<std::size_t>(Bus::kSwarm)];
  return (heard & kTypes<TeamStatus>) != 0 ? CoordinatorSign::kTeamStatus
                                           : CoordinatorSign::kMission;
}

bool Participant::silent(const Author& author, Instant now) const {
  const auto sign = liveness_.last_sign(author);
  const Timing* const timing = knows_mission() ? &mission().timing : nullptr;
  return !sign || now - *sign >= silence_of(author.agent, coordinator_sign(), timing);
}

bool Participant::silent(AgentId process, Instant now, std::optional<Instant> since) const {
  const auto sign = std::max(liveness_.last_sign_of_kind(process), since);  // empty is the least
  const Timing* const timing = knows_mission() ? &mission().timing : nullptr;
  return !sign || now - *sign >= silence_of(process, coordinator_sign(), timing);
}

bool Participant::cut_off(Tick newest, Instant now) const {
  if (follower_.state() != MissionState::kRunning || !knows_mission()) return false;
  Instant last = mission_heard_;
  const AgentId other = role_ == Role::kWorld ? 0 : kWorld;
  for (const AgentId sender : {kCoordinator, other}) {
    last = std::max(last, liveness_.last_sign_of_kind(sender).value_or(last));
  }
  Timing timing = mission().timing;
  timing.tick_count = tick_count();
  return must_be_over(timing, counted(newest), now - last);
}

}  // namespace ergocast
