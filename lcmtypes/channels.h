// SPDX-License-Identifier: BSD-3-Clause
// Which channel carries what.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "team/messages.h"
#include "team/subscriptions.h"

namespace ergocast {

/// The name `message` travels under, transmitted by its sender or by whoever relays it; valid for
/// the program's life. Names: ERGOCAST_HELLO, _MISSION, _TEAM_STATUS, _STOP, _WORLD_STATE,
/// _RECORD_ACK, and one per agent for _CONTRIBUTION_<id>, _DIGEST_<id>, _AGENT_STATUS_<id>,
/// _COMMAND_<id>.
const std::string& channel_of(const Message& message, AgentId relayer = kUnassigned);

/// A name, or with `per_agent` how one for each agent begins: its number follows, or "NEW".
struct ChannelName {
  std::string_view text;
  bool per_agent = false;
};
/// One for each kind of message. Whatever arrives under another name is nobody's.
std::span<const ChannelName> channel_names();

/// A regular expression that fits the whole names of the channels of these messages, and no other.
std::string channels_of(MessageTypes types);

/// Who transmitted what arrived under `channel`: the sender, or for contributions the agent whose
/// channel it is. Nothing if `message` has no business there.
std::optional<AgentId> transmitter_of(const Message& message, std::string_view channel);

}  // namespace ergocast
