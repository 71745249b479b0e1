// SPDX-License-Identifier: BSD-3-Clause
// Plain messages and LCM's generated types, field by field: what every field means on the wire.
// For the codec alone; nothing else sees a generated type.
#pragma once

#include <ergocast/agent_status_t.hpp>
#include <ergocast/command_t.hpp>
#include <ergocast/contribution_t.hpp>
#include <ergocast/digest_t.hpp>
#include <ergocast/hello_t.hpp>
#include <ergocast/mission_t.hpp>
#include <ergocast/record_ack_t.hpp>
#include <ergocast/stop_t.hpp>
#include <ergocast/team_status_t.hpp>
#include <ergocast/world_state_t.hpp>

#include "team/messages.h"

namespace ergocast {

/// The message with its tag still zero, and its signature as it is. Strings are cut at their limits.
contribution_t to_wire(const Contribution& m);
agent_status_t to_wire(const AgentStatus& m);
team_status_t to_wire(const TeamStatus& m);
hello_t to_wire(const Hello& m);
stop_t to_wire(const Stop& m);
world_state_t to_wire(const WorldState& m);
command_t to_wire(const Command& m);
record_ack_t to_wire(const RecordAck& m);
mission_t to_wire(const MissionPart& m);
digest_t to_wire(const Digest& m);

/// Fills `m`; false for what cannot be true: NaN, a count below 0, an id out of range, a text with
/// control characters.
/// @pre counts within the arrays of `m`, as the codec has checked them.
bool from_wire(const contribution_t& w, Contribution& m);
bool from_wire(const agent_status_t& w, AgentStatus& m);
bool from_wire(const team_status_t& w, TeamStatus& m);
bool from_wire(const hello_t& w, Hello& m);
bool from_wire(const stop_t& w, Stop& m);
bool from_wire(const world_state_t& w, WorldState& m);
bool from_wire(const command_t& w, Command& m);
bool from_wire(const record_ack_t& w, RecordAck& m);
bool from_wire(const mission_t& w, MissionPart& m);
bool from_wire(const digest_t& w, Digest& m);

/// Whether a header can be anybody's.
bool plausible(const Header& h);

}  // namespace ergocast
