// SPDX-License-Identifier: BSD-3-Clause
// Sweeps over the levels between corners and crossings, and walks along each level from left to
// right.
#include "target/trapezoids.h"

#include <algorithm>
#include <cmath>

namespace ergocast {
namespace {

/// An edge that is not horizontal, directed upwards.
struct Edge {
  Eigen::Vector2d low, high;
  std::size_t polygon;  ///< the polygon that it belongs to

  double x_at(double y) const {
    if (y >= high.y()) return high.x();
    return low.x() + (y - low.y()) / (high.y() - low.y()) * (high.x() - low.x());
  }
};

void add_edges(const Ring& ring, std::size_t polygon, std::vector<Edge>& edges) {
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Eigen::Vector2d &a = ring[i], &b = ring[(i + 1) % ring.size()];
    if (a.y() < b.y()) edges.push_back({a, b, polygon});
    if (b.y() < a.y()) edges.push_back({b, a, polygon});
  }
}

void add_edges(const Polygon& shape, std::size_t polygon, std::vector<Edge>& edges) {
  add_edges(shape.outline, polygon, edges);
  for (const Ring& hole : shape.holes) add_edges(hole, polygon, edges);
}

Polygon outline_of(const Eigen::Vector2d& size_m) {
  return {{{0, 0}, {size_m.x(), 0}, size_m, {0, size_m.y()}}, {}};
}

/// y of every corner and crossing from 0 to `height`, ascending, each once.
std::vector<double> levels_of(const std::vector<Edge>& edges, double height) {
  std::vector<double> levels;
  for (const Edge& edge : edges) levels.insert(levels.end(), {edge.low.y(), edge.high.y()});
  for (std::size_t i = 0; i < edges.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const double from = std::max(edges[i].low.y(), edges[j].low.y());
      const double to = std::min(edges[i].high.y(), edges[j].high.y());
      if (from >= to) continue;
      const double before = edges[i].x_at(from) - edges[j].x_at(from);
      const double after = edges[i].x_at(to) - edges[j].x_at(to);
      if (before * after < 0) levels.push_back(from + before / (before - after) * (to - from));
    }
  }
  std::erase_if(levels, [&](double y) { return !(y >= 0 && y <= height); });
  std::sort(levels.begin(), levels.end());
  levels.erase(std::unique(levels.begin(), levels.end()), levels.end());
  return levels;
}

/// Tracks which polygons a sweep from left to right is inside of. A point is free if it is inside
/// the first `wanted` polygons and outside the others.
class PlaneSweep {
 public:
  PlaneSweep(std::size_t polygons, std::size_t wanted) : inside_(polygons), wanted_(wanted) {}

  void cross(std::size_t polygon) {
    inside_[polygon] = !inside_[polygon];
    int& count = polygon < wanted_ ? found_ : kept_out_;
    inside_[polygon] ? ++count : --count;
  }
  bool free() const { return found_ == static_cast<int>(wanted_) && kept_out_ == 0; }

 private:
  std::vector<bool> inside_;
  std::size_t wanted_;
  int found_ = 0, kept_out_ = 0;
};

Trapezoid piece(const Edge& left, const Edge& right, double low, double high) {
  Trapezoid cut{low, high, left.x_at(low), left.x_at(high), right.x_at(low), right.x_at(high)};
  cut.right_low = std::max(cut.right_low, cut.left_low);  // equal or greater except for rounding
  cut.right_high = std::max(cut.right_high, cut.left_high);
  return cut;
}

/// @param shapes  a piece is inside the first `wanted` of them and outside the others
std::vector<Trapezoid> cut_up(const std::vector<Polygon>& shapes, std::size_t wanted,
                              const Eigen::Vector2d& size_m) {
  std::vector<Edge> edges;
  for (std::size_t i = 0; i < shapes.size(); ++i) add_edges(shapes[i], i, edges);
  const std::vector<double> levels = levels_of(edges, size_m.y());

  std::vector<Trapezoid> pieces;
  for (std::size_t slab = 1; slab < levels.size(); ++slab) {
    const double low = levels[slab - 1], high = levels[slab], middle = low + 0.5 * (high - low);
    std::vector<const Edge*> across;
    for (const Edge& edge : edges) {
      if (edge.low.y() <= low && edge.high.y() >= high) across.push_back(&edge);
    }
    std::stable_sort(across.begin(), across.end(), [&](const Edge* a, const Edge* b) {
      return a->x_at(middle) < b->x_at(middle);
    });
    PlaneSweep sweep(shapes.size(), wanted);
    const Edge* left = nullptr;
    for (const Edge* edge : across) {
      if (sweep.free() && left->x_at(middle) < edge->x_at(middle)) {
        pieces.push_back(piece(*left, *edge, low, high));
      }
      sweep.cross(edge->polygon);
      left = edge;
    }
  }
  return pieces;
}

}  // namespace

Trapezoid Trapezoid::between(double from, double to) const {
  const double height = high - low;
  const auto at = [&](double x_low, double x_high, double y) {
    if (y <= low) return x_low;
    if (y >= high) return x_high;
    return x_low + (y - low) / height * (x_high - x_low);
  };
  return {from,
          to,
          at(left_low, left_high, from),
          at(left_low, left_high, to),
          at(right_low, right_high, from),
          at(right_low, right_high, to)};
}

std::array<Eigen::Vector2d, 4> Trapezoid::corners() const {
  return {{{left_low, low}, {right_low, low}, {right_high, high}, {left_high, high}}};
}

std::vector<Trapezoid> free_area(const Eigen::Vector2d& size_m,
                                 std::span<const Polygon> keep_outs) {
  std::vector<Polygon> shapes{outline_of(size_m)};
  shapes.insert(shapes.end(), keep_outs.begin(), keep_outs.end());
  return cut_up(shapes, 1, size_m);
}

std::vector<Trapezoid> free_area_within(const Polygon& region, const Eigen::Vector2d& size_m,
                                        std::span<const Polygon> keep_outs) {
  std::vector<Polygon> shapes{outline_of(size_m), region};
  shapes.insert(shapes.end(), keep_outs.begin(), keep_outs.end());
  return cut_up(shapes, 2, size_m);
}

}  // namespace ergocast
