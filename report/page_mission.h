// SPDX-License-Identifier: BSD-3-Clause
// What a page gets of a mission, as JSON: the plan, and what was changed in flight. The page of a
// record and that of a running team both use it.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>

#include "core/mission/amendments.h"
#include "core/mission/mission.h"
#include "report/target_density.h"

namespace ergocast {

/// The mission: {"name", "seed", "origin_m", "size_m", "modes", "target": μ_k, "weights": λ_k /
/// h_k², "dt_s", "tick_count", "agents", "u_max_mps": of the fastest kind, "radio_range_m",
/// "free_domain", "conventions": [[name, text], …], "density": null or {"width", "height", "full",
/// "data"}, "body_radius_m": half the distance that bodies keep, "stations": [{"id", "at_m" from
/// the domain's corner, "rest_from" in ticks that count, "battery": true if it has one}, …],
/// "vehicles": [{"count", "vehicle": "FIXED_WING"}, …] of the planned kinds, "half_life_ticks",
/// "keeps_history": true}. From "body_radius_m" on, a key is present only where it applies. Origin,
/// size and modes have two numbers, in a box three. With "free_domain" μ and λ are still those of
/// cosines, with which the page draws; φ² over time is in the modes of the free domain. `density`
/// has a byte for each cell, the north-west first; 255 is `full` times the uniform density or more.
/// In a box it is the average along z.
/// @param density  in multiples of the uniform density; if empty, the page draws the sum of the μ_k
nlohmann::ordered_json page_mission(const Mission& mission, const Field& density);

/// [{"number", "kind": "target", "from": the world's tick, "hash": of the target, in hexadecimal,
/// "by": its operator}, …]; of an end "tick_count", of a law "law", law_text(); of a
/// sighting or dismissal "text", to_text().
/// @param laws   of these amendments, those that are known
/// @param notes  likewise
nlohmann::ordered_json page_amendments(std::span<const Amendment> list,
                                       std::span<const LawChange> laws,
                                       std::span<const SearchNote> notes, const Mission& mission);
/// [{"number", "closed", "from", "until": the world's ticks, "corners_m": from the domain's corner,
/// in a box also "heights_m"}, …]
nlohmann::ordered_json page_zones(std::span<const Zone> zones, const Box& domain);
/// The name of a target in "targets": its hash in hexadecimal.
std::string page_target_name(std::uint64_t hash);
/// The coefficients with which the page draws a target, with a free domain those of cosines.
nlohmann::ordered_json page_target(const TargetChange& change);

/// Whether any agent's vehicle has a heading, so that the page gets them with the positions.
bool any_that_turn(const Mission& mission);

/// "quadrimodal_corners", or "unnamed mission".
std::string title_of(const Mission& mission);

}  // namespace ergocast
