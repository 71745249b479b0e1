// SPDX-License-Identifier: BSD-3-Clause
// Creates all channel names once, by message type and agent, so that publishing builds no string.
#include "lcmtypes/channels.h"

#include <algorithm>
#include <array>
#include <utility>
#include <variant>

#include "lcmtypes/fields.h"
#include "text/read_number.h"

namespace ergocast {
namespace {

/// The channel of a type, such as ERGOCAST_TEAM_STATUS of team_status_t.
template <class M>
std::string name_of() {
  const std::string type = Fields<M>::Generated::getTypeName();
  std::string name = "ERGOCAST_";
  for (const char c : type.substr(0, type.size() - 2))
    name += c == '_' ? c : static_cast<char>(c - 'a' + 'A');
  return name;
}

template <class M>
constexpr bool kPerAgent = requires {
  Fields<M>::kPerAgent;
};

bool per_agent(const Message& message) {
  return std::visit([](const auto& m) { return kPerAgent<std::decay_t<decltype(m)>>; }, message);
}

/// All names, created once.
struct Table {
  using Names = std::array<std::string, kMessageTypeCount>;
  Names plain;
  std::array<std::array<std::string, kMaxAgents + 1>, kMessageTypeCount> numbered;  // [0] is id −1
  Names stems;  // plain, or the beginning of the numbered ones
  std::array<ChannelName, kMessageTypeCount> names;

  static std::size_t index(AgentId id) { return static_cast<std::size_t>(id) + 1; }

  Table() : Table(std::make_index_sequence<kMessageTypeCount>()) {}

 private:
  template <std::size_t... Kind>
  explicit Table(std::index_sequence<Kind...>) {
    (add<std::variant_alternative_t<Kind, Message>>(Kind), ...);
  }
  template <class M>
  void add(std::size_t kind) {
    plain[kind] = name_of<M>();
    for (int id = -1; id < kMaxAgents; ++id)
      numbered[kind][index(id)] = plain[kind] + "_" + (id < 0 ? "NEW" : std::to_string(id));
    stems[kind] = plain[kind];
    const bool is_per_agent = kPerAgent<M>;
    if (is_per_agent) stems[kind] += '_';
    names[kind] = {stems[kind], is_per_agent};
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

std::span<const ChannelName> channel_names() { return table().names; }

bool is_channel_of(MessageTypes types, std::string_view channel) {
  for (std::size_t kind = 0; kind < kMessageTypeCount; ++kind) {
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
  // Only what others may relay has a transmitter that is not its sender.
  if (!std::holds_alternative<Contribution>(message) && !std::holds_alternative<Effort>(message))
    return std::nullopt;
  const std::string& stem = table().stems[message.index()];
  if (!channel.starts_with(stem)) return std::nullopt;
  const auto relayer = read_number<AgentId>(channel.substr(stem.size()));
  return relayer >= 0 && relayer < kMaxAgents ? relayer : std::nullopt;
}

}  // namespace ergocast
