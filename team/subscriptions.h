// SPDX-License-Identifier: BSD-3-Clause
// The subscriptions of each role to messages: the one table that processes and the laboratory use.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <variant>

#include "team/messages.h"

namespace ergocast {

enum class Role {
  kAgent,
  kCoordinator,
  kWorld,
  kDriver,  ///< drives robots in place of the world
  kLogger,
  kLauncher,  ///< `ergocast run`
  kMonitor,   ///< `ergocast status`, `stop`, `pause`, `recall`
  kPage,      ///< `ergocast watch`: a monitor that shows commands, too
};
inline constexpr int kRoleCount = 8;

/// Kinds of messages: bit i stands for alternative i of Message.
using MessageTypes = std::uint32_t;
inline constexpr std::size_t kMessageTypeCount = std::variant_size_v<Message>;

/// The index of M among the alternatives of Message.
template <class M, std::size_t kFrom = 0>
constexpr std::size_t type_index() {
  if constexpr (std::is_same_v<M, std::variant_alternative_t<kFrom, Message>>) {
    return kFrom;
  } else {
    return type_index<M, kFrom + 1>();
  }
}
/// The set of the types Ms.
template <class... Ms>
constexpr MessageTypes types_of() {
  MessageTypes types = 0;
  for (const std::size_t type : {type_index<Ms>()...}) types |= MessageTypes{1} << type;
  return types;
}
template <class... Ms>
inline constexpr MessageTypes kTypes = types_of<Ms...>();
inline constexpr MessageTypes kEveryType = (MessageTypes{1} << kMessageTypeCount) - 1;

/// The messages that one role receives, by bus.
using Subscriptions = std::array<MessageTypes, kBusCount>;
using SubscriptionTable = std::array<Subscriptions, kRoleCount>;

// clang-format off
inline constexpr SubscriptionTable kSubscriptions = [] {
  SubscriptionTable table{};
  const auto subscribes = [&table](Role role, Bus bus, MessageTypes types) {
    table[static_cast<std::size_t>(role)][static_cast<std::size_t>(bus)] = types;
  };
  subscribes(Role::kAgent,       Bus::kSwarm,   kTypes<Hello, MissionPart, Contribution, Digest, AgentStatus, Stop, Beacon, Effort>);
  subscribes(Role::kAgent,       Bus::kWorld,   kTypes<Hello, WorldState>);
  subscribes(Role::kCoordinator, Bus::kSwarm,   kTypes<Hello, MissionPart, AgentStatus, TeamStatus, Stop, Amend, Recall>);
  subscribes(Role::kCoordinator, Bus::kWorld,   kTypes<Hello, WorldState, RecordAck>);
  subscribes(Role::kWorld,       Bus::kCommand, kTypes<MissionPart, WorldState, Command, RecordAck, Stop>);
  subscribes(Role::kDriver,      Bus::kWorld,   kTypes<WorldState>);
  subscribes(Role::kDriver,      Bus::kCommand, kTypes<MissionPart, Command, Stop>);
  for (const Bus bus : {Bus::kSwarm, Bus::kWorld, Bus::kCommand}) subscribes(Role::kLogger, bus, kEveryType);
  subscribes(Role::kLauncher,    Bus::kSwarm,   kTypes<Hello, MissionPart, AgentStatus, TeamStatus, Stop>);
  subscribes(Role::kLauncher,    Bus::kCommand, kTypes<RecordAck>);
  // A replayed event log has the messages of all buses on the first bus, because LCM's player uses
  // only one URL.
  subscribes(Role::kMonitor,     Bus::kSwarm,   kTypes<MissionPart, AgentStatus, TeamStatus, WorldState, RecordAck>);
  subscribes(Role::kMonitor,     Bus::kWorld,   kTypes<WorldState, RecordAck>);
  subscribes(Role::kMonitor,     Bus::kCommand, kTypes<RecordAck>);
  subscribes(Role::kPage,        Bus::kSwarm,   kTypes<MissionPart, AgentStatus, TeamStatus, WorldState, RecordAck, Command>);
  subscribes(Role::kPage,        Bus::kWorld,   kTypes<WorldState, RecordAck>);
  subscribes(Role::kPage,        Bus::kCommand, kTypes<RecordAck, Command>);
  return table;
}();
// clang-format on

constexpr const Subscriptions& subscriptions_of(Role role,
                                                const SubscriptionTable& table = kSubscriptions) {
  return table[static_cast<std::size_t>(role)];
}

inline bool subscribes(const Subscriptions& subscriptions, Bus bus, const Message& message) {
  return (subscriptions[static_cast<std::size_t>(bus)] >> message.index() & 1) != 0;
}

}  // namespace ergocast
