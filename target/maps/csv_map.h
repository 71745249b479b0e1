// SPDX-License-Identifier: BSD-3-Clause
// A table of numbers separated by commas: a line is a row of cells.
#pragma once

#include <Eigen/Core>
#include <string>

#include "target/maps/map_file.h"

namespace ergocast {

/// Reads the file once to count. Blanks around a number and empty lines are ignored; an empty cell
/// is 0.
OpenedMap open_csv_map(const std::filesystem::path& file);

/// `grid`, row i along x and column j along y from the lower left corner, as such a table with the
/// north first; four significant digits.
std::string csv_text(const Eigen::MatrixXd& grid);

}  // namespace ergocast
