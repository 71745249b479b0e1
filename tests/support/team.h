// SPDX-License-Identifier: BSD-3-Clause
// Small missions and messages for tests that drive one core by hand.
#pragma once

#include <chrono>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core/mission/mission.h"
#include "plan/amendment_list.h"
#include "plan/plan.h"
#include "team/messages.h"
#include "team/mission_follower.h"
#include "team/subscriptions.h"

namespace ergocast::test {

using namespace std::chrono_literals;

inline constexpr RunId kRun = 0x1234;
inline constexpr Incarnation kCoordinatorLife = 0xc0, kWorldLife = 0x3d, kLoggerLife = 0x10;

inline Instant at(std::chrono::nanoseconds since_start) { return Instant{since_start}; }

/// The incarnation that agent `id` has in these tests.
inline Incarnation incarnation_of(AgentId id) { return 1000 + static_cast<Incarnation>(id); }
inline Author author_of(AgentId id) { return {id, incarnation_of(id)}; }

/// A uniform target on [0, 2000]², every agent starting on the line y = 500.
inline Mission small_mission(int agents) {
  Mission mission;
  mission.name = "small";
  mission.seed = 7;
  mission.domain.size_m = {2000, 2000, 0};
  mission.basis.modes_x = 5;
  mission.basis.modes_y = 4;
  mission.target_coefficients = Coefficients::Zero(20);
  mission.target_coefficients[0] = 1;
  mission.law.u_max_mps = 10;
  mission.timing.tick_count = 100;
  mission.quorum = agents;
  mission.wait_for_logger = false;
  for (int i = 0; i < agents; ++i) mission.starts_m.push_back({100.0 * (i + 1), 500, 0});
  return mission;
}

/// The plan in mission_part(): that of the last announce().
inline std::vector<std::byte> announced_plan;
inline void announce(const Mission& mission) { announced_plan = encode_plan(mission); }

/// An invalid plan, and the error that every process reports for it.
inline const std::vector<std::byte> kNoPlan{std::byte{1}};
inline std::string why_no_plan() { return decode_plan(kNoPlan).error(); }

inline std::vector<RosterEntry> roster_of(int agents) {
  std::vector<RosterEntry> roster;
  for (AgentId id = 0; id < agents; ++id) roster.push_back({author_of(id), 0, -1});
  return roster;
}

/// Higher than all former ones in a test: a repeated message is not fresh.
inline std::int64_t next_sequence() {
  static std::int64_t last = 0;
  return ++last;
}

/// The list of amendments of a mission that only has these pauses, as MISSION carries it.
inline std::vector<std::byte> pauses(std::vector<Hold> holds) {
  return encode_amendments(only_pauses(std::move(holds)));
}

inline MissionPart mission_part(std::int64_t revision, MissionState state,
                                std::vector<RosterEntry> roster, std::string reason = "") {
  MissionPart part;
  part.header = {kRun, kCoordinator, kCoordinatorLife, next_sequence(), 0};
  part.revision = revision;
  part.state = state;
  part.roster = std::move(roster);
  part.plan = announced_plan;
  part.reason = std::move(reason);
  return part;
}

/// The world at `tick` as one part; agent i of `positions_m` is vehicle i.
inline WorldState world_state(Tick tick, const std::vector<Eigen::Vector3d>& positions_m,
                              std::int64_t answered_tick = -1) {
  WorldState state;
  state.header = {kRun, kWorld, kWorldLife, next_sequence(), tick};
  state.vehicle_count = static_cast<std::int32_t>(positions_m.size());
  for (std::size_t i = 0; i < positions_m.size(); ++i) {
    state.vehicles[i].id = static_cast<AgentId>(i);
    state.vehicles[i].answered_tick = answered_tick;
    state.vehicles[i].position_m = positions_m[i];
  }
  return state;
}

inline Command command_of(AgentId id, Tick tick, const Eigen::Vector3d& velocity_mps) {
  Command command;
  command.header = {kRun, id, incarnation_of(id), tick + 2, tick};
  command.velocity_mps = velocity_mps;
  return command;
}

inline AgentStatus status_of(AgentId id, std::int64_t sequence, Tick answered_tick = -1,
                             AgentId waiting_for = kUnassigned) {
  AgentStatus status;
  status.header = {kRun, id, incarnation_of(id), sequence, 0};
  status.phase = AgentPhase::kRunning;
  status.answered_tick = answered_tick;
  status.waiting_for = waiting_for;
  status.host = "elsewhere";
  return status;
}

/// The bus on which a process of that role receives such a message.
inline Bus bus_of(const Message& message, Role role) {
  const bool asks = std::holds_alternative<Hello>(message) && header_of(message).sender == kWorld;
  Bus bus = asks || std::holds_alternative<WorldState>(message) ? Bus::kWorld : Bus::kSwarm;
  if (std::holds_alternative<Command>(message) || std::holds_alternative<RecordAck>(message)) {
    bus = Bus::kCommand;
  }
  // MISSION and STOP are sent on two buses.
  return subscribes(subscriptions_of(role), bus, message) ? bus : Bus::kCommand;
}

/// Gives `message` to `core`, from `transmitter`.
template <class Core>
void give(Core& core, const Message& message, Instant now, AgentId transmitter) {
  core.receive(message, bus_of(message, Core::kRole), transmitter, now);
}
/// Gives `message` to `core`, from its sender.
template <class Core>
void give(Core& core, const Message& message, Instant now) {
  give(core, message, now, header_of(message).sender);
}

/// The messages of type M in `out`, in order.
template <class M>
std::vector<M> only(const Outbox& out) {
  std::vector<M> found;
  for (const Outgoing& outgoing : out) {
    if (const auto* message = std::get_if<M>(&outgoing.message)) found.push_back(*message);
  }
  return found;
}

/// The messages that `core` publishes at `now`.
template <class Core>
Outbox advance(Core& core, Instant now) {
  Outbox out;
  core.advance(now, out);
  return out;
}

}  // namespace ergocast::test
