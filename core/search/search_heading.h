// SPDX-License-Identifier: BSD-3-Clause
// The heading of a searching agent: the best of 32 short straight ways.
//
//   V(d) = Σ_i w_i (1 − exp(−γ τ_i(d))) − 10 r² / A s_d ∇u·d,   w_i = b_i² / max b (1 + 4 q_i)
//
// b_i is what is left in cell i, and τ_i(d) is how long it is in the sensor's range on the way with
// the direction d. q_i is the share of what was searched around it: among the twelve cells that are
// at most two cells away. What lies outside of the domain or has no mass counts as searched. So
// agents pass close beside what was searched, and leave no narrow strips there. The square makes
// them leave what was half searched. The last term leads where little is left nearby: u is the
// potential of core/search/search_field.h, and A is a cell's area.
//
// Ways are 1.5 r long with the sensor's radius r, or as long as the agent comes until it chooses
// again. They end at sides and walls: s_d is their length.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "core/base/indexed_rings.h"
#include "core/search/search_cells.h"

namespace ergocast {

/// What an agent knows, one number a cell.
struct SearchKnowledge {
  const Eigen::VectorXd& left;    ///< b_i, with the sum 1
  const Eigen::VectorXd& missed;  ///< exp(−E_i) of the looks E_i; 0 where the target has no mass
};

class SearchHeading {
 public:
  /// @param rate_per_s  γ
  SearchHeading(const SearchCells& cells, IndexedRings walls, double rate_per_s);

  /// The direction of the best way, of length 1; 0 if all ways are equal. Does not allocate.
  /// @param gradient  ∇u at `x_m`
  /// @param speed_mps  of the agent, above 0
  /// @param hold_s  until it chooses again
  Eigen::Vector3d best(const Eigen::Vector3d& x_m, const SearchKnowledge& known,
                       const Eigen::Vector3d& gradient, double speed_mps, double hold_s);

 private:
  /// A cell that is in range of some ways: its middle as seen from the agent.
  struct Near {
    double x_m, y_m, worth;
  };
  void find_near(const Eigen::Vector3d& x_m, const SearchKnowledge& known, double reach_m);
  double searched_around(const Eigen::VectorXd& missed, int i, int j) const;
  double free_m(const Eigen::Vector3d& x_m, const Eigen::Vector2d& along, double reach_m) const;
  double found(const Eigen::Vector2d& along, double length_m, double nats_per_m) const;

  Cells cells_;
  double radius_m_, rate_per_s_, pull_;
  IndexedRings walls_;
  std::array<Eigen::Vector2d, 32> ways_;
  std::vector<Near> near_;
};

}  // namespace ergocast
