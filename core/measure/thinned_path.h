// SPDX-License-Identifier: BSD-3-Clause
// The way of a body in a bounded number of positions, evenly spaced in ticks.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace ergocast {

class ThinnedPath {
 public:
  /// Limit (ROS 2): positions of one agent's path. Beyond it: every second one is left out.
  static constexpr std::size_t kMostPositions = 500;

  void add(const Eigen::Vector3d& x_m) {
    if (offered_++ % every_ != 0) return;
    path_m_.push_back(x_m);
    if (path_m_.size() < kMostPositions) return;
    every_ *= 2;
    for (std::size_t i = 0; 2 * i < path_m_.size(); ++i) path_m_[i] = path_m_[2 * i];
    path_m_.resize((path_m_.size() + 1) / 2);
  }
  /// In their order; the first one is always kept.
  const std::vector<Eigen::Vector3d>& path_m() const { return path_m_; }

 private:
  std::vector<Eigen::Vector3d> path_m_;
  std::size_t every_ = 1, offered_ = 0;
};

}  // namespace ergocast
