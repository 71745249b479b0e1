// SPDX-License-Identifier: BSD-3-Clause
// The channel of each message.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "team/messages.h"
#include "team/subscriptions.h"

namespace ergocast {

/// The channel of `message`, sent by its author or relayed by another agent; valid until the
/// program ends. Names: ERGOCAST_HELLO, _MISSION, _TEAM_STATUS, _STOP, _WORLD_STATE, _RECORD_ACK,
/// _AMEND, _RECALL, and one per agent for _CONTRIBUTION_<id>, _DIGEST_<id>, _AGENT_STATUS_<id>,
/// _COMMAND_<id>, _BEACON_<id>.
const std::string& channel_of(const Message& message, AgentId relayer = kUnassigned);

/// A name; with `per_agent` its beginning, which the agent's number or "NEW" follows.
struct ChannelName {
  std::string_view text;
  bool per_agent = false;
};
/// One for each message type. Messages under other names are not ours.
std::span<const ChannelName> channel_names();

/// Whether `channel` may be one of these messages'. Cheap, and done before anything is decoded;
/// transmitter_of() also checks the number.
bool is_channel_of(MessageTypes types, std::string_view channel);

/// `ergocast replay` sends a recorded message on this name in place of its own. Only displays
/// listen to such names, so a replay reaches no participant of a mission.
std::string replayed(std::string_view channel);
/// The message's own name; nothing if `channel` is no replay's.
std::optional<std::string> without_replay(std::string_view channel);

/// The transmitter of a message on `channel`: its sender, or for contributions the agent of that
/// channel. Nothing if `message` does not belong on `channel`.
std::optional<AgentId> transmitter_of(const Message& message, std::string_view channel);

}  // namespace ergocast
