// SPDX-License-Identifier: BSD-3-Clause
// Where on the earth a recorded scenario lies.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "core/base/result.h"
#include "scenario/scenario.h"
#include "target/geo/local_plane.h"

namespace ergocast {

/// The origin in a scenario's file, of which nothing else needs to be valid; nothing if it has
/// none. Problems if the file cannot be read or the origin is no place.
Result<std::optional<GeoPlace>, std::vector<Problem>> read_origin(
    const std::filesystem::path& file);

}  // namespace ergocast
