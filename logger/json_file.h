// SPDX-License-Identifier: BSD-3-Clause
// Reads a JSON file of a run directory.
#pragma once

#include <cstddef>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/base/result.h"

namespace ergocast {

/// What a file may hold.
struct JsonLimits {
  std::size_t bytes, values;
};

/// Null if there is no such file. An error names the file and the remedy.
Result<nlohmann::ordered_json> read_json(const std::filesystem::path& file,
                                         const JsonLimits& limits);

/// The remedy for a damaged file of a run directory.
inline constexpr const char* kCopyAgainOrRemove =
    "copy it again from where the run was recorded, or remove it";

}  // namespace ergocast
