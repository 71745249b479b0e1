// SPDX-License-Identifier: BSD-3-Clause
// Halves the edges at the median of their middles, along the longer side of the box around them.
#include "core/base/indexed_rings.h"

#include <algorithm>
#include <cmath>
#include <compare>
#include <utility>

namespace ergocast {
namespace {

/// The share of a length, and of a coordinate, that rounding may take.
constexpr double kRounding = 1e-9, kRoundingOfPlaces = 1e-14;

/// Twice the middle of an edge along an axis.
double middle(const Edge& edge, int axis) {
  return edge.segment.from_m[axis] + edge.segment.to_m[axis];
}

}  // namespace

std::vector<std::size_t> listed_oddly(std::vector<std::size_t> listed) {
  std::ranges::sort(listed);
  std::vector<std::size_t> odd;
  for (auto at = listed.begin(); at != listed.end();) {
    const auto next = std::upper_bound(at, listed.end(), *at);
    if ((next - at) % 2 == 1) odd.push_back(*at);
    at = next;
  }
  return odd;
}

IndexedRings::IndexedRings(Rings rings) {
  if (rings.empty()) return;
  auto content = std::make_shared<Content>();
  content->rings = std::move(rings);
  for (std::uint32_t ring = 0; ring < content->rings.size(); ++ring) {
    const Ring& corners = content->rings[ring];
    for (std::uint32_t i = 0; i < corners.size(); ++i) {
      const auto number = static_cast<std::uint32_t>(content->edges.size());
      content->order.push_back(number);
      content->edges.push_back(
          {{corners[i], corners[i + 1 < corners.size() ? i + 1 : 0]}, number, ring, i});
    }
  }
  build(*content, 0, 0, content->edges.size());
  content_ = std::move(content);
}

const Rings& IndexedRings::rings() const {
  static const Rings none;
  return content_ ? content_->rings : none;
}

void IndexedRings::build(Content& content, std::size_t node, std::size_t first, std::size_t end) {
  if (first == end) return;
  if (content.nodes.size() <= node) content.nodes.resize(node + 1);
  Bounds& bounds = content.nodes[node];
  const Segment& some = content.edges[content.order[first]].segment;
  for (const int axis : {0, 1}) {
    double &low = bounds.low[static_cast<std::size_t>(axis)],
           &high = bounds.high[static_cast<std::size_t>(axis)];
    low = high = some.from_m[axis];
    for (std::size_t i = first; i < end; ++i) {
      const Segment& segment = content.edges[content.order[i]].segment;
      low = std::min({low, segment.from_m[axis], segment.to_m[axis]});
      high = std::max({high, segment.from_m[axis], segment.to_m[axis]});
    }
  }
  if (end - first <= kMostInLeaf) return;
  const int axis = bounds.high[0] - bounds.low[0] >= bounds.high[1] - bounds.low[1] ? 0 : 1;
  const std::size_t half = first + (end - first) / 2;
  const auto at = [&](std::size_t i) {
    return content.order.begin() + static_cast<std::ptrdiff_t>(i);
  };
  // A total order, also of numbers that are none.
  std::nth_element(at(first), at(half), at(end), [&](std::uint32_t one, std::uint32_t other) {
    const double mine = middle(content.edges[one], axis), its = middle(content.edges[other], axis);
    return std::strong_order(mine, its) < 0;
  });
  build(content, 2 * node + 1, first, half);
  build(content, 2 * node + 2, half, end);
}

double IndexedRings::Bounds::square_m2(const Eigen::Vector2d& x_m) const {
  const double x = std::max({0.0, low[0] - x_m.x(), x_m.x() - high[0]});
  const double y = std::max({0.0, low[1] - x_m.y(), x_m.y() - high[1]});
  return x * x + y * y;
}

bool IndexedRings::Bounds::beside_ray(const Eigen::Vector2d& x_m) const {
  return low[1] > x_m.y() || high[1] < x_m.y() || high[0] < x_m.x();
}

/// By their boxes, and then by which side of the line through the way the box is on.
bool IndexedRings::Bounds::apart(const Segment& way, double within_m) const {
  const Eigen::Vector2d &a = way.from_m, &b = way.to_m;
  const double x =
      std::max({0.0, low[0] - std::max(a.x(), b.x()), std::min(a.x(), b.x()) - high[0]});
  const double y =
      std::max({0.0, low[1] - std::max(a.y(), b.y()), std::min(a.y(), b.y()) - high[1]});
  const double far_m = within_m * (1 + kRounding);
  if (x * x + y * y > far_m * far_m) return true;
  const Eigen::Vector2d along = b - a;
  const Eigen::Vector2d middle(low[0] + (high[0] - low[0]) / 2, low[1] + (high[1] - low[1]) / 2);
  const Eigen::Vector2d half((high[0] - low[0]) / 2, (high[1] - low[1]) / 2), to = middle - a;
  const double wide = std::abs(along.x()) * half.y() + std::abs(along.y()) * half.x();
  const double unsure = kRoundingOfPlaces * along.lpNorm<1>() *
                        (a.lpNorm<1>() + b.lpNorm<1>() + middle.lpNorm<1>() + half.lpNorm<1>());
  return std::abs(along.x() * to.y() - along.y() * to.x()) > wide + far_m * along.norm() + unsure;
}

void IndexedRings::collect(const Segment& way, double within_m,
                           std::vector<std::uint32_t>& near) const {
  near.clear();
  find_near(way, within_m, [&](const Edge& edge) {
    near.push_back(edge.number);
    return false;
  });
  std::ranges::sort(near);
}

double IndexedRings::least_square_m2(const Eigen::Vector2d& x_m, double more_than_m2) const {
  double least_m2 = std::numeric_limits<double>::max();
  least_square(0, 0, edge_count(), x_m, more_than_m2, least_m2);
  return least_m2;
}

void IndexedRings::least_square(std::size_t node, std::size_t first, std::size_t end,
                                const Eigen::Vector2d& x_m, double more_than_m2,
                                double& least_m2) const {
  if (first == end || content_->nodes[node].square_m2(x_m) * (1 - kRounding) > least_m2) return;
  if (end - first <= kMostInLeaf) {
    for (std::size_t i = first; i < end; ++i) {
      const Segment& segment = content_->edges[content_->order[i]].segment;
      const double square_m2 = (segment.nearest_m(x_m) - x_m).squaredNorm();
      if (square_m2 > more_than_m2) least_m2 = std::min(least_m2, square_m2);
    }
    return;
  }
  const std::size_t half = first + (end - first) / 2, one = 2 * node + 1, other = one + 1;
  const bool other_first =
      content_->nodes[other].square_m2(x_m) < content_->nodes[one].square_m2(x_m);
  if (other_first) least_square(other, half, end, x_m, more_than_m2, least_m2);
  least_square(one, first, half, x_m, more_than_m2, least_m2);
  if (!other_first) least_square(other, half, end, x_m, more_than_m2, least_m2);
}

bool IndexedRings::is_crowded() const {
  std::size_t tests = 0;
  const auto search_all = [&](const Segment& way, const auto& apart) {
    search(
        0, 0, edge_count(),
        [&](const Bounds& bounds) { return ++tests > kMaxEdgeTests || apart(bounds, way); },
        [&](const Edge&) { return ++tests > kMaxEdgeTests; });
  };
  for (const Edge& edge : edges())
    search_all(edge.segment,
               [](const Bounds& bounds, const Segment& way) { return bounds.apart(way, 0); });
  if (tests > kMaxEdgeTests) return true;
  tests = 0;
  for (const Ring& ring : rings())
    search_all({ring.front(), ring.front()}, [](const Bounds& bounds, const Segment& way) {
      return bounds.beside_ray(way.from_m);
    });
  return tests > kMaxEdgeTests;
}

bool IndexedRings::solid_at(const Eigen::Vector2d& x_m) const {
  bool solid = false;
  for_crossed(x_m, [&](const Edge&) { solid = !solid; });
  return solid;
}

}  // namespace ergocast
