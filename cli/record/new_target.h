// SPDX-License-Identifier: BSD-3-Clause
// A new target for a mission: its coefficients from a file, and how far it is from another target.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "core/mission/amendments.h"
#include "core/mission/mission.h"
#include "scenario/scenario.h"

namespace ergocast::cli {

/// Compiles `file` and the overrides of its target for a mission (Scenario::load_target()). Returns
/// all problems; also one if this program does not compile the mission itself as the team has it.
/// @param recorded  the scenario of the mission, for its origin; may be missing or empty
Result<Scenario, std::vector<Problem>> load_new_target(const Mission& mission,
                                                       const std::filesystem::path& file,
                                                       const Overrides& overrides,
                                                       const std::filesystem::path& recorded);

/// The same for the text of a target, in which nothing names a file.
Result<Scenario, std::vector<Problem>> parse_new_target(const Mission& mission,
                                                        std::string_view text);

/// The text that load_zone() needs: the mission with the origin of its recorded scenario.
std::string zone_context(const Mission& mission, const std::filesystem::path& recorded);

/// How long ticks take, as people write it: "39.3 s".
std::string seconds_text(Tick ticks, const Mission& mission);

/// The coefficients of a compiled target, as AMEND carries them.
TargetChange target_change_of(const Scenario& scenario);

/// The target that the mission's plan has, or the newest of the list that holds at `tick`.
TargetChange target_now(const Mission& mission, const Amendments& list, Tick tick);

/// The share of one target's mass that has to be moved to make the other: half the integral of
/// |ρ_a − ρ_b|, as far as the modes tell it. From 0 to 1.
double share_that_differs(const Mission& mission, const TargetChange& a, const TargetChange& b);

}  // namespace ergocast::cli
