// SPDX-License-Identifier: BSD-3-Clause
// Bugs of agents, coordinator and world, of the pauses that they obey, and of the codec.
#include <algorithm>
#include <cstdlib>
#include <span>
#include <vector>

#include "coordinator/coordinator.h"
#include "core/measure/objects.h"
#include "core/mission/hold.h"
#include "lcmtypes/codec.h"
#include "sim/world.h"
#include "tests/checks_can_fail/bugs.h"

namespace ergocast {

// clang-format off
WRAPPED(void, receive_at_agent, "_ZN8ergocast5Agent7receiveERKSt7variantIJNS_5HelloENS_11MissionPartENS_12ContributionENS_11AgentStatusENS_10TeamStatusENS_4StopENS_10WorldStateENS_7CommandENS_9RecordAckENS_6DigestENS_5AmendENS_6BeaconENS_6RecallENS_6EffortEEENS_3BusEiNSt6chrono10time_pointINS_11PacingClockENSK_8durationIlSt5ratioILl1ELl1000000000EEEEEE", Agent*, const Message&, Bus, AgentId, Instant)
WRAPPED(void, advance, "_ZN8ergocast5Agent7advanceENSt6chrono10time_pointINS_11PacingClockENS1_8durationIlSt5ratioILl1ELl1000000000EEEEEERSt6vectorINS_8OutgoingESaISA_EE", Agent*, Instant, Outbox&)
WRAPPED(Instant, next_wakeup, "_ZNK8ergocast5Agent11next_wakeupEv", const Agent*)
WRAPPED(void, coordinate, "_ZN8ergocast11Coordinator7advanceENSt6chrono10time_pointINS_11PacingClockENS1_8durationIlSt5ratioILl1ELl1000000000EEEEEERSt6vectorINS_8OutgoingESaISA_EE", Coordinator*, Instant, Outbox&)
WRAPPED(void, turn_world, "_ZN8ergocast5World7advanceENSt6chrono10time_pointINS_11PacingClockENS1_8durationIlSt5ratioILl1ELl1000000000EEEEEERSt6vectorINS_8OutgoingESaISA_EE", World*, Instant, Outbox&)
WRAPPED(Instant, next_turn_of_world, "_ZNK8ergocast5World11next_wakeupEv", const World*)
WRAPPED(void, receive_at_coordinator, "_ZN8ergocast11Coordinator7receiveERKSt7variantIJNS_5HelloENS_11MissionPartENS_12ContributionENS_11AgentStatusENS_10TeamStatusENS_4StopENS_10WorldStateENS_7CommandENS_9RecordAckENS_6DigestENS_5AmendENS_6BeaconENS_6RecallENS_6EffortEEENS_3BusEiNSt6chrono10time_pointINS_11PacingClockENSK_8durationIlSt5ratioILl1ELl1000000000EEEEEE", Coordinator*, const Message&, Bus, AgentId, Instant)
WRAPPED(void, receive_at_world, "_ZN8ergocast5World7receiveERKSt7variantIJNS_5HelloENS_11MissionPartENS_12ContributionENS_11AgentStatusENS_10TeamStatusENS_4StopENS_10WorldStateENS_7CommandENS_9RecordAckENS_6DigestENS_5AmendENS_6BeaconENS_6RecallENS_6EffortEEENS_3BusEiNSt6chrono10time_pointINS_11PacingClockENSK_8durationIlSt5ratioILl1ELl1000000000EEEEEE", World*, const Message&, Bus, AgentId, Instant)
WRAPPED(bool, is_held, "_ZN8ergocast7is_heldESt4spanIKNS_4HoldELm18446744073709551615EEl", std::span<const Hold>, Tick)
WRAPPED(Tick, counted_ticks, "_ZN8ergocast13counted_ticksESt4spanIKNS_4HoldELm18446744073709551615EEl", std::span<const Hold>, Tick)
WRAPPED(ObjectSet, detected, "_ZN8ergocast7Objects8detectedEilRKN5Eigen6MatrixIdLi3ELi1ELi0ELi3ELi1EEE", Objects*, AgentId, Tick, const Eigen::Vector3d&)
WRAPPED(void, note_finds, "_ZN8ergocast5Finds4noteEjNS_4FindE", Finds*, ObjectSet, Find)
WRAPPED(Tick, tick_after, "_ZN8ergocast10tick_afterESt4spanIKNS_4HoldELm18446744073709551615EEl", std::span<const Hold>, Tick)
WRAPPED(Decoded, decode, "_ZN8ergocast6decodeESt4spanIKSt4byteLm18446744073709551615EEmRKNS_20MessageAuthenticatorESt17basic_string_viewIcSt11char_traitsIcEEPNS_15KnownSignaturesE", std::span<const std::byte>, RunId, const MessageAuthenticator&, std::string_view, KnownSignatures*)
// clang-format on

// ---- pauses ----

namespace {

/// Whether the current agent misinterprets pauses.
bool one_agent_acts = false;
class Acting {
 public:
  explicit Acting(const Agent& agent) { one_agent_acts = agent.id() == 2; }
  ~Acting() { one_agent_acts = false; }
};

/// The delay after which it continues, relative to the others.
constexpr Tick kLate = 3;

/// The pauses as the current agent interprets them.
std::vector<Hold> misread(std::span<const Hold> holds) {
  std::vector<Hold> taken(holds.begin(), holds.end());
  if (!one_agent_acts) return taken;
  if (bug("one agent ignores pauses")) taken.clear();
  if (bug("one agent misses the second pause") && taken.size() > 1) taken.erase(taken.begin() + 1);
  for (Hold& hold : taken) {
    if (bug("one agent goes on later") && !hold.open()) hold.until += kLate;
  }
  return taken;
}

}  // namespace

bool bug_is_held(std::span<const Hold> holds, Tick tick) {
  return real_is_held(misread(holds), tick);
}

Tick bug_counted_ticks(std::span<const Hold> holds, Tick tick) {
  return real_counted_ticks(misread(holds), tick);
}

Tick bug_tick_after(std::span<const Hold> holds, Tick count) {
  return bug("the end does not move") ? count : real_tick_after(holds, count);
}

// ---- finds ----

ObjectSet bug_detected(Objects* self, AgentId id, Tick tick, const Eigen::Vector3d& x_m) {
  if (bug("sensors detect objects where they were")) tick /= 2;
  return bug("sensors detect from everywhere") ? 1 : real_detected(self, id, tick, x_m);
}

void bug_note_finds(Finds* self, ObjectSet detected, Find at) {
  if (bug("a find is recorded a tick late")) ++at.tick;
  if (bug("no find is recorded")) detected = 0;
  real_note_finds(self, detected, at);
}

// ---- agents ----

void bug_receive_at_agent(Agent* self, const Message& message, Bus bus, AgentId transmitter,
                          Instant now) {
  listener = self;
  is_relayed = transmitter != header_of(message).sender;
  const Acting acting(*self);
  if (bug("digests are ignored") && std::holds_alternative<Digest>(message)) return;
  if (const auto* state = std::get_if<WorldState>(&message);
      state != nullptr && bug("a late state is taken for the newest")) {
    WorldState taken = *state;
    if (taken.header.tick < self->tick()) taken.header.tick = self->tick() + 1;
    return real_receive_at_agent(self, taken, bus, transmitter, now);
  }
  if (const auto* part = std::get_if<MissionPart>(&message);
      part != nullptr && bug("recalls are ignored")) {
    MissionPart taken = *part;
    taken.roster = without_recalls(part->roster);
    return real_receive_at_agent(self, taken, bus, transmitter, now);
  }
  real_receive_at_agent(self, message, bus, transmitter, now);
}

namespace {

/// Repeats a teammate's block in its own name.
void relay(const Agent& self, Outbox& out) {
  const CoverageTable& table = *self.coverage();
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    if (table.author(row) == self.author() || table.min_steps(row) == 0) continue;
    Contribution block = table.block(table.author(row), 0);
    block.header.run = self.run();
    out.push_back({Bus::kSwarm, block, self.author().agent});
    return;
  }
}

bool speaks_digest(const Outgoing& outgoing) {
  return std::holds_alternative<Digest>(outgoing.message);
}

}  // namespace

/// While its mission is paused.
void ignore_pause(const Agent& self, Outbox& out) {
  if (bug("a sample counts while all stand")) {
    const Mission& mission = *self.follower().mission();
    const_cast<CoverageTable*>(self.coverage())
        ->add_sample(self.author(), BasisAt(mission.starts_m[0], mission.domain, mission.basis),
                     nullptr);
  }
  for (Outgoing& one : out) {
    auto* command = std::get_if<Command>(&one.message);
    if (command != nullptr && bug("an agent creeps on")) command->velocity_mps.x() = 1e-3;
  }
}

/// With its last message.
void drive_on(const Agent& self, Outbox& out) {
  if (out.empty() || self.tick() < kUnderWay) return;
  Command command;
  command.header = header_of(out.back().message);
  command.header.tick = self.tick();
  command.velocity_mps = {1, 0, 0};
  out.push_back({Bus::kCommand, command});
}

void bug_advance(Agent* self, Instant now, Outbox& out) {
  if (bug("an agent crashes") && self->tick() == kUnderWay) std::abort();
  if (bug("an agent gives up") && self->tick() == kUnderWay) self->leave("no more");
  {
    const Acting acting(*self);
    real_advance(self, now, out);
  }
  const bool is_one_of_them = self->author().agent == 2;
  if (self->held()) ignore_pause(*self, out);
  if (self->finished() && bug("an agent drives on after the end")) drive_on(*self, out);
  if (bug("a newcomer is mute") && is_one_of_them) {
    std::erase_if(out,
                  [](const Outgoing& one) { return std::holds_alternative<Hello>(one.message); });
  }
  if (self->coverage() == nullptr || self->tick() < kUnderWay) return;
  if (bug("a digest exaggerates")) {
    for (Outgoing& one : out) {
      if (speaks_digest(one)) ++std::get<Digest>(one.message).entries[0].steps;
    }
  }
  if (bug("an agent repeats unasked")) relay(*self, out);
  // Answers the messages since its last one, although no block was missing.
  if (bug("an agent repeats what all have") && std::any_of(out.begin(), out.end(), speaks_digest)) {
    relay(*self, out);
  }
}

Instant bug_next_wakeup(const Agent* self) {
  const bool now = bug("an agent never sleeps") && self->tick() > kUnderWay && !self->finished();
  return now ? Instant{} : real_next_wakeup(self);
}

// ---- coordinator and world ----

namespace {

void give_away_closed_numbers(std::vector<RosterEntry>& roster) {
  for (std::size_t i = 0, count = roster.size(); i < count; ++i) {
    if (!roster[i].leaves || std::ssize(roster) == kMaxRosterEntriesPerMessage) continue;
    roster.push_back({{roster[i].author.agent, 1}, roster[i].active_from});
  }
}

}  // namespace

void bug_coordinate(Coordinator* self, Instant now, Outbox& out) {
  const bool due = self->state() == MissionState::kRunning && self->tick() > kUnderWay;
  if (due && bug("the coordinator panics")) self->end(true, "no reason", now);
  if (due && bug("the coordinator ends too early")) self->end(false, "enough", now);
  real_coordinate(self, now, out);
  if (!bug("a closed number is given away")) return;
  for (Outgoing& one : out) {
    auto* part = std::get_if<MissionPart>(&one.message);
    if (part != nullptr) give_away_closed_numbers(part->roster);
  }
}

void bug_receive_at_coordinator(Coordinator* self, const Message& message, Bus bus,
                                AgentId transmitter, Instant now) {
  const auto* status = std::get_if<AgentStatus>(&message);
  if (bug("the coordinator ignores an agent") && status != nullptr && status->header.sender == 2)
    return;
  real_receive_at_coordinator(self, message, bus, transmitter, now);
}

void bug_receive_at_world(World* self, const Message& message, Bus bus, AgentId transmitter,
                          Instant now) {
  if (bug("the world ignores the logger") && std::holds_alternative<RecordAck>(message)) return;
  if (const auto* state = std::get_if<WorldState>(&message);
      state != nullptr && bug("a restarted world takes bodies to stand")) {
    WorldState taken = *state;
    for (Vehicle& vehicle : taken.vehicles) vehicle.velocity_mps.setZero();
    return real_receive_at_world(self, taken, bus, transmitter, now);
  }
  real_receive_at_world(self, message, bus, transmitter, now);
}

namespace {

bool hangs(const World& world) {
  const auto& mission = world.follower().mission();
  return bug("the world hangs") && mission && world.tick() == mission->timing.tick_count - 1;
}

}  // namespace

void bug_turn_world(World* self, Instant now, Outbox& out) {
  if (!hangs(*self)) real_turn_world(self, now, out);
  if (bug("the world creeps on")) {
    for (Outgoing& one : out) {
      auto* state = std::get_if<WorldState>(&one.message);
      if (state != nullptr && is_held(self->follower().holds(), state->header.tick))
        state->vehicles[0].velocity_mps.x() = 1e-3;
    }
  }
  if (bug("vehicles go home after the end")) {
    for (Outgoing& one : out) {
      auto* state = std::get_if<WorldState>(&one.message);
      if (state != nullptr && state->last)
        for (Vehicle& vehicle : state->vehicles_in_part())
          vehicle.position_m = self->follower().mission()->domain.center_m();
    }
  }
  if (bug("the world keeps a tick to itself") && self->tick() == kUnderWay) {
    std::erase_if(
        out, [](const Outgoing& one) { return std::holds_alternative<WorldState>(one.message); });
  }
}

Instant bug_next_turn_of_world(const World* self) {
  return hangs(*self) ? Instant::max() : real_next_turn_of_world(self);
}

// ---- codec ----

Decoded bug_decode(std::span<const std::byte> bytes, RunId run,
                   const MessageAuthenticator& authenticator, std::string_view channel,
                   KnownSignatures* known) {
  Decoded result = real_decode(bytes, run, authenticator, channel, known);
  if (bug("whole messages are refused") && result) return failure(Refusal::kTag);
  if (bug("damage passes") && !result) return Digest{};
  return result;
}

}  // namespace ergocast
