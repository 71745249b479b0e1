// SPDX-License-Identifier: BSD-3-Clause
// Creates all channel names once, by message type and agent, so that publishing builds no string.
#include "lcmtypes/channels.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "text/read_number.h"

namespace ergocast {
namespace {

constexpr std::array<std::string_view, std::variant_size_v<Message>> kNames = {
    "ERGOCAST_HELLO",       "ERGOCAST_MISSION", "ERGOCAST_CONTRIBUTION", "ERGOCAST_AGENT_STATUS",
    "ERGOCAST_TEAM_STATUS", "ERGOCAST_STOP",    "ERGOCAST_WORLD_STATE",  "ERGOCAST_COMMAND",
    "ERGOCAST_RECORD_ACK",  "ERGOCAST_DIGEST",  "ERGOCAST_PAUSE",        "ERGOCAST_BEACON",
    "ERGOCAST_RECALL"};

template <class T>
constexpr bool kPerAgent =
    std::is_same_v<T, Contribution> || std::is_same_v<T, AgentStatus> ||
    std::is_same_v<T, Command> || std::is_same_v<T, Digest> || std::is_same_v<T, Beacon>;

bool per_agent(const Message& message) {
  return std::visit([](const auto& m) { return kPerAgent<std::decay_t<decltype(m)>>; }, message);
}

/// All names, created once.
struct Table {
  std::array<std::string, kNames.size()> plain;
  std::array<std::array<std::string, kMaxAgents + 1>, kNames.size()> numbered;  // [0] is id −1

  static std::size_t index(AgentId id) { return static_cast<std::size_t>(id) + 1; }

  Table() {
    for (std::size_t kind = 0; kind < kNames.size(); ++kind) {
      plain[kind] = kNames[kind];
      for (int id = -1; id < kMaxAgents; ++id) {
        numbered[kind][index(id)] = plain[kind] + "_" + (id < 0 ? "NEW" : std::to_string(id));
      }
    }
  }
};

const Table& table() {
  static const Table names;
  return names;
}

const std::string& name(std::size_t kind, AgentId id) {
  const bool numbered = id >= kUnassigned && id < kMaxAgents;
  return numbered ? table().numbered[kind][Table::index(id)] : table().plain[kind];
}

}  // namespace

const std::string& channel_of(const Message& message, AgentId relayer) {
  if (!per_agent(message)) return table().plain[message.index()];
  return name(message.index(), relayer == kUnassigned ? header_of(message).sender : relayer);
}

std::span<const ChannelName> channel_names() {
  static const auto stems = [] {
    std::array<std::string, kNames.size()> all;
    for (std::size_t kind = 0; kind < kNames.size(); ++kind)
      all[kind] = std::string(kNames[kind]) + "_";
    return all;
  }();
  static const auto names = []<std::size_t... Kind>(std::index_sequence<Kind...>) {
    return std::array{(kPerAgent<std::variant_alternative_t<Kind, Message>>
                           ? ChannelName{stems[Kind], true}
                           : ChannelName{kNames[Kind], false})...};
  }
  (std::make_index_sequence<kNames.size()>());
  return names;
}

bool is_channel_of(MessageTypes types, std::string_view channel) {
  for (std::size_t kind = 0; kind < kNames.size(); ++kind) {
    if ((types >> kind & 1) == 0) continue;
    const ChannelName& name = channel_names()[kind];
    if (name.per_agent ? channel.starts_with(name.text) : channel == name.text) return true;
  }
  return false;
}

// Both have the same length, so that the kernel's filter compares names at the same places.
constexpr std::string_view kLive = "ERGOCAST_", kReplayed = "REPLAYED_";
static_assert(kLive.size() == kReplayed.size());

std::string replayed(std::string_view channel) {
  return std::string(kReplayed) +
         std::string(channel.substr(std::min(kLive.size(), channel.size())));
}

std::optional<std::string> without_replay(std::string_view channel) {
  if (!channel.starts_with(kReplayed)) return std::nullopt;
  return std::string(kLive) + std::string(channel.substr(kReplayed.size()));
}

std::optional<AgentId> transmitter_of(const Message& message, std::string_view channel) {
  const AgentId sender = header_of(message).sender;
  if (channel == channel_of(message)) return sender;
  constexpr std::string_view kContribution = "ERGOCAST_CONTRIBUTION_";
  if (!std::holds_alternative<Contribution>(message) || !channel.starts_with(kContribution)) {
    return std::nullopt;
  }
  const auto relayer = read_number<AgentId>(channel.substr(kContribution.size()));
  return relayer >= 0 && relayer < kMaxAgents ? relayer : std::nullopt;
}

}  // namespace ergocast
