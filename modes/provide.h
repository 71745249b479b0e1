// SPDX-License-Identifier: BSD-3-Clause
// Gives missions the table of modes that they steer by: one that was handed over, or a computed
// one.
//
// A process keeps the tables that it has seen. Equal domains and walls have equal tables, so each
// is computed once at most.
#pragma once

#include <optional>
#include <string>

#include "core/base/result.h"
#include "core/mission/mission.h"
#include "modes/table.h"

namespace ergocast {

/// Keeps a table, which missions of this process may use from now on.
void keep_table(ModesTable table);

/// The table of the mission's domain, walls and number of modes, which takes a second or more
/// unless it is known.
/// @return  or why there is none, as a sentence
/// @pre mission.basis.free_domain, kMostFreeModes modes at most
Result<ModesTable> table_of(const Mission& mission);

/// Sets mission.basis.table to the table of its hash: one that was handed over, or the one that
/// this program computes.
/// @return  why this program has none of this hash, as a sentence; nothing for a mission without
///          free domain
std::optional<std::string> provide_table(Mission& mission);

}  // namespace ergocast
