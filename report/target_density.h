// SPDX-License-Identifier: BSD-3-Clause
// The target as a picture in the run directory, so that a report needs neither scenario nor maps.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <variant>

#include "report/raster.h"

namespace ergocast {

/// What is to be covered, in multiples of the uniform density: a table with the north-west first.
inline constexpr const char* kTargetDensityFile = "target_density.csv";

/// The table as it stands in the file.
std::string target_density_text(const Field& density);

/// Nothing on success, otherwise the error.
std::optional<std::string> write_target_density(const std::filesystem::path& file,
                                                const Field& density);

/// An empty field if there is no such file, otherwise what is wrong with it.
std::variant<Field, std::string> read_target_density(const std::filesystem::path& file);

}  // namespace ergocast
