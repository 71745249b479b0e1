// SPDX-License-Identifier: BSD-3-Clause
// Makes the data of a record's page as JSON, and report.html with these data.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "core/mission/mission.h"
#include "logger/run_data.h"
#include "report/target_density.h"

namespace ergocast {

/// {"mission", "summary", "metrics", "tracks", "stride", "rows", "standing", "team", "home_from",
/// "amendments", "targets", "zones"}: the record's data for the page. "standing" has the agents
/// that stand in their last state. "amendments" and "targets",
/// {page_target_name(): page_target(), …}, are present only if there are any. "home_from", {"0":
/// tick, …}, is present only without `team`: the ticks at which agents with a station went home by
/// the rule of core/motion/way_home.h.
/// @param team  the agents' states over time (cli/team/recorded_team.h), or null
nlohmann::ordered_json page_record(const RunData& run, const Mission& mission,
                                   const nlohmann::ordered_json& summary, const Field& density,
                                   const nlohmann::ordered_json& team);

/// Makes report.html. Keys that are missing in `summary`, or have another type, are left out.
std::string report_page(const RunData& run, const Mission& mission,
                        const nlohmann::ordered_json& summary, const Field& density,
                        const nlohmann::ordered_json& team);

}  // namespace ergocast
