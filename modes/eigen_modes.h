// SPDX-License-Identifier: BSD-3-Clause
// The lowest eigenfunctions of the five-point Laplacian on free cells, without a slope at walls.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "modes/free_grid.h"

namespace ergocast {

struct EigenModes {
  Eigen::VectorXd eigenvalues_per_m2;  ///< ascending, the first 0
  Eigen::MatrixXd values;              ///< a column each, max |value| 1; the first all 1
};

/// The lowest `count` modes of a grid. Equal grids and the same program give the same bits: order,
/// signs and random numbers are fixed. Takes a second or more.
/// @return  nothing if it does not converge, which has not been seen
/// @pre 2 ≤ count ≤ cells / 4
std::optional<EigenModes> eigen_modes(const FreeGrid& grid, int count);

}  // namespace ergocast
