// SPDX-License-Identifier: BSD-3-Clause
// A table of numbers separated by commas: a line is a row of cells.
#pragma once

#include <Eigen/Core>
#include <string>

#include "target/maps/map_file.h"

namespace ergocast {

/// Reads the whole file once to count its rows and columns. Blanks around a number and empty lines
/// are ignored; an empty cell is 0.
OpenedMap open_csv_map(const std::filesystem::path& file);

/// The text of such a table, the north first, with four significant digits. Row i of `grid` is
/// along x and column j along y, from the lower left corner.
std::string csv_text(const Eigen::MatrixXd& grid);

}  // namespace ergocast
