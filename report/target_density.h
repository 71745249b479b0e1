// SPDX-License-Identifier: BSD-3-Clause
// The target density as a table in the run directory, so that a report needs neither scenario nor
// maps.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>

#include "core/base/result.h"

namespace ergocast {

/// One value a cell: row i along x, column j along y, both upwards from the domain's origin.
using Field = Eigen::MatrixXd;

/// The density in multiples of the uniform density: a table with the north-west first.
inline constexpr const char* kTargetDensityFile = "target_density.csv";

/// The content of the file.
std::string target_density_text(const Field& density);

/// Writes the file; returns nullopt on success, otherwise the error.
std::optional<std::string> write_target_density(const std::filesystem::path& file,
                                                const Field& density);

/// An empty field if there is no such file; an error if it cannot be read.
Result<Field> read_target_density(const std::filesystem::path& file);

}  // namespace ergocast
