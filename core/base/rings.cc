// SPDX-License-Identifier: BSD-3-Clause
// Tests the pairs of edges that are near each other with twice the digits of a double, computes
// areas by the shoelace formula and membership by counting crossings.
#include "core/base/rings.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/double_pair.h"
#include "core/base/indexed_rings.h"

namespace ergocast {
namespace {

/// (a − b)(c − d), with twice the digits of a double.
DoublePair product_of_differences(double a, double b, double c, double d) {
  const DoublePair one = exact_sum(a, -b), other = exact_sum(c, -d);
  const DoublePair product = exact_product(one.high, other.high);
  const double rest = one.high * other.low + one.low * other.high;
  return exact_sum(product.high, product.low + rest);
}

/// The side of the line through a and b on which the point lies: 1 left, −1 right, 0 on it. The
/// sign of a small difference must be right.
int side(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& point) {
  const DoublePair left = product_of_differences(b.x(), a.x(), point.y(), a.y());
  const DoublePair right = product_of_differences(b.y(), a.y(), point.x(), a.x());
  const double cross = (left.high - right.high) + (left.low - right.low);
  return (cross > 0) - (cross < 0);
}

bool boxes_apart(const Segment& e, const Segment& f) {
  const Eigen::Array2d e_low = e.from_m.cwiseMin(e.to_m), e_high = e.from_m.cwiseMax(e.to_m);
  const Eigen::Array2d f_low = f.from_m.cwiseMin(f.to_m), f_high = f.from_m.cwiseMax(f.to_m);
  return (e_high < f_low).any() || (f_high < e_low).any();
}

/// Whether `next`, which begins at the end of `edge`, goes back along it.
bool folds_back(const Segment& edge, const Segment& next) {
  return side(edge.from_m, edge.to_m, next.to_m) == 0 &&
         (edge.to_m - edge.from_m).dot(next.to_m - next.from_m) < 0;
}

/// Whether the position of two edges to each other is allowed; `count` is the size of a ring.
bool may_meet(const Edge& e, const Edge& f, std::size_t count) {
  if (e.ring != f.ring) return !touch(e.segment, f.segment);
  if ((e.corner + 1) % count == f.corner) return !folds_back(e.segment, f.segment);
  if ((f.corner + 1) % count == e.corner) return !folds_back(f.segment, e.segment);
  return !touch(e.segment, f.segment);
}

}  // namespace

bool touch(const Segment& e, const Segment& f) {
  return !boxes_apart(e, f) &&
         side(e.from_m, e.to_m, f.from_m) * side(e.from_m, e.to_m, f.to_m) <= 0 &&
         side(f.from_m, f.to_m, e.from_m) * side(f.from_m, f.to_m, e.to_m) <= 0;
}

double distance_m(const Segment& one, const Segment& other) {
  if (touch(one, other)) return 0;
  const auto from = [](const Eigen::Vector2d& x_m, const Segment& segment) {
    return (segment.nearest_m(x_m) - x_m).squaredNorm();
  };
  return std::sqrt(std::min({from(one.from_m, other), from(one.to_m, other),
                             from(other.from_m, one), from(other.to_m, one)}));
}

std::optional<EdgePair> touching_edges(const IndexedRings& rings) {
  for (const Edge& edge : rings.edges()) {
    const Edge* first = nullptr;
    rings.find_near(edge.segment, 0, [&](const Edge& other) {
      const bool earlier = other.number < (first == nullptr ? edge.number : first->number);
      if (earlier && !may_meet(edge, other, rings[edge.ring].size())) first = &other;
      return false;
    });
    if (first != nullptr) return EdgePair{edge.ring, edge.corner, first->ring, first->corner};
  }
  return {};
}

double area_m2(const Ring& ring) {
  double twice = 0;
  for (std::size_t i = 2; i < ring.size(); ++i) {
    const Eigen::Vector2d a = ring[i - 1] - ring[0], b = ring[i] - ring[0];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return 0.5 * std::abs(twice);
}

bool contains(const Ring& ring, const Eigen::Vector2d& x_m) {
  bool inside = false;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    if (crosses_ray({ring[i], ring[i + 1 < ring.size() ? i + 1 : 0]}, x_m)) inside = !inside;
  }
  return inside;
}

std::vector<int> depths(const IndexedRings& rings) {
  std::vector<int> depths;
  for (std::size_t ring = 0; ring < rings.size(); ++ring) {
    std::vector<std::size_t> crossed;
    rings.for_crossed(rings[ring].front(), [&](const Edge& edge) {
      if (edge.ring != ring) crossed.push_back(edge.ring);
    });
    depths.push_back(static_cast<int>(listed_oddly(std::move(crossed)).size()));
  }
  return depths;
}

std::vector<double> crossings_m(const Rings& rings, int axis, double at_m) {
  std::vector<double> crossings;
  for_segments(rings, [&](const Segment& edge) {
    const double from = edge.from_m[axis], to = edge.to_m[axis];
    if ((from > at_m) == (to > at_m)) return;
    const double from_m = edge.from_m[1 - axis], to_m = edge.to_m[1 - axis];
    crossings.push_back(from_m + (at_m - from) / (to - from) * (to_m - from_m));
  });
  std::ranges::sort(crossings);
  return crossings;
}

}  // namespace ergocast
