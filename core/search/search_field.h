// SPDX-License-Identifier: BSD-3-Clause
// The potential that searching agents descend: high where teammates will search, low where much is
// left to find.
//
//   u − a² Δu = p − b,   no flow through the domain's sides and through walls
//
// b is the density of what is left to find and p that of what teammates will take care of, both in
// cells of core/search/search_cells.h. The equation smooths over the distance a. A cell exchanges
// with each of its four neighbours, unless a wall crosses the line between their middles.
#pragma once

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <array>
#include <vector>

#include "core/measure/cells.h"
#include "core/mission/mission.h"

namespace ergocast {

class SearchField {
 public:
  /// Prepares the solution for a map; takes milliseconds for 64 × 64 cells.
  SearchField(const Cells& cells, const Rings& walls, double smoothing_m);

  /// Solves for a source p − b, one number a cell. Does not allocate.
  void solve(const Eigen::VectorXd& source);
  /// ∇u at a place: mean slopes at the middles of cells, and bilinear between them.
  Eigen::Vector3d gradient(const Eigen::Vector3d& x_m) const;
  const Eigen::VectorXd& potential() const { return u_; }

  /// Whether the middles of a cell and of the next one along `axis` see each other.
  bool linked(int axis, int i, int j) const {
    return links_[static_cast<std::size_t>(axis)]
                 [cells_.column(i, 0) + static_cast<std::size_t>(j)];
  }

 private:
  void find_links(const Rings& walls);
  double slope(int axis, int i, int j) const;
  double mean_slope(int axis, int i, int j) const;

  Cells cells_;
  std::array<std::vector<char>, 2> links_;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver_;
  Eigen::VectorXd diagonal_;     // of the factors
  Eigen::VectorXd u_, ordered_;  // ordered_: in the order of the factors
};

}  // namespace ergocast
