// Which channel carries what.
#pragma once

#include <string>
#include <string_view>

#include "core/messages.h"

namespace ergocast {

/// The name `message` travels under, transmitted by its own sender; valid for the program's life.
/// Names: ERGOCAST_HELLO, _MISSION, _TEAM_STATUS, _STOP, _WORLD_STATE, _RECORD_ACK, and one per
/// agent for _CONTRIBUTION_<id>, _AGENT_STATUS_<id>, _COMMAND_<id>.
const std::string& channel_of(const Message& message);

/// Whether `message` may arrive under `channel`: its type's name and, but for contributions, which
/// others may relay, its sender's id.
bool belongs_on(const Message& message, std::string_view channel);

}  // namespace ergocast
