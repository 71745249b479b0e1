// SPDX-License-Identifier: BSD-3-Clause
// A zone for a running mission, from a file: a polygon as scenarios have it, GeoJSON or a drawing.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/mission/zones.h"
#include "scenario/parse/problem.h"

namespace ergocast {

/// Whether a file can be a zone: a drawing or GeoJSON by its name, or text that begins with a field
/// of Polygon and not with one of a scenario.
bool looks_like_zone(const std::filesystem::path& file);

/// The corners and heights of the one polygon in `file`, which is_zone() except for its ticks.
/// Returns all problems, with file, line and field.
/// @param running  the text of the mission; it may have an origin, which GeoJSON needs
Result<Zone, std::vector<Problem>> load_zone(const std::filesystem::path& file,
                                             const std::string& running);

}  // namespace ergocast
