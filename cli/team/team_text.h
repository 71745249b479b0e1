// SPDX-License-Identifier: BSD-3-Clause
// A team's picture as text for people and as JSON for programs.
#pragma once

#include <string>
#include <vector>

#include "cli/team/team_view.h"

namespace ergocast {

/// A headline, a row for each agent, and one for coordinator, world and logger; at most 100 columns
/// wide for usual values. Every line ends with a line break.
/// @param colour  whether to use the terminal's colours: red for trouble, yellow for warnings
std::string team_table(const TeamPicture& picture, bool colour);

/// One JSON object on one line; unknown values are null.
std::string team_json(const TeamPicture& picture);

/// "world", "coordinator", "logger", or an agent's number.
std::string name_of(AgentId sender);

/// "silent 4 s", "waiting for 3", "ok": the condition of one row.
std::string condition_text(const AgentRow& row);

/// The first `rows` lines of `text`. If lines are missing, the last line has their number.
std::string cut_to_height(const std::string& text, std::size_t rows);

}  // namespace ergocast
