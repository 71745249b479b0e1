// SPDX-License-Identifier: BSD-3-Clause
// Finds the symmetry lines of the domain through a point, and measures the distance from them.
#include "lab/manifolds.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace ergocast::lab {
namespace {

constexpr double kOnIt = 1e-9;  // as a share of the sides
constexpr double kEscapedShare = 0.01;

bool near(double a, double b) { return std::abs(a - b) <= kOnIt; }

/// The lines through `s`, a place in the unit square, that are symmetry lines of the domain.
std::vector<Manifold> lines_at(const Eigen::Vector2d& s, const Eigen::Vector2d& x_m, bool square) {
  std::vector<Manifold> lines;
  const Eigen::Vector2d along[] = {{1, 0}, {0, 1}};
  for (int axis = 0; axis < 2; ++axis) {
    if (near(s[axis], 0) || near(s[axis], 1))
      lines.push_back({ManifoldKind::kEdge, x_m, along[axis]});
    if (near(s[axis], 0.5)) lines.push_back({ManifoldKind::kMidline, x_m, along[axis]});
  }
  const double r = std::sqrt(0.5);
  if (square && near(s.x(), s.y())) lines.push_back({ManifoldKind::kDiagonal, x_m, {r, -r}});
  if (square && near(s.x(), 1 - s.y())) lines.push_back({ManifoldKind::kDiagonal, x_m, {r, r}});
  return lines;
}

ManifoldKind crossing_of(const std::vector<Manifold>& lines) {
  const auto count = [&lines](ManifoldKind kind) {
    return std::count_if(lines.begin(), lines.end(),
                         [&](const Manifold& m) { return m.kind == kind; });
  };
  if (count(ManifoldKind::kEdge) == 2) return ManifoldKind::kCorner;
  if (count(ManifoldKind::kMidline) == 2) return ManifoldKind::kCenter;
  return ManifoldKind::kCrossing;
}

}  // namespace

double Manifold::distance_m(const Eigen::Vector3d& x_m) const {
  const Eigen::Vector2d off_m = x_m.head<2>() - point_m;
  return normal.isZero() ? off_m.norm() : std::abs(off_m.dot(normal));
}

std::optional<Manifold> manifold_at(const Eigen::Vector3d& x_m, const Box& domain) {
  const Eigen::Vector2d place_m = x_m.head<2>();
  const Eigen::Vector2d share =
      (place_m - domain.origin_m.head<2>()).cwiseQuotient(domain.size_m.head<2>());
  const bool square = near(domain.size_m.x() / domain.size_m.y(), 1);
  const std::vector<Manifold> lines = lines_at(share, place_m, square);
  if (lines.empty()) return std::nullopt;
  if (lines.size() == 1) return lines.front();
  return Manifold{crossing_of(lines), place_m, {0, 0}};
}

double escape_distance_m(const Box& domain) { return kEscapedShare * domain.shortest_side_m(); }

}  // namespace ergocast::lab
