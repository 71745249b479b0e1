// SPDX-License-Identifier: BSD-3-Clause
// Rings whose edges are found by where they are.
//
// A tree halves the edges by their places, and each node has the box around its edges. So a
// question about a place looks at the edges near it, however many there are. The tree decides which
// edges are looked at, and the caller what they mean: every answer is bit for bit the one that all
// edges would give.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "core/base/rings.h"

namespace ergocast {

/// Those that are listed an odd number of times, ascending: the rings around a place, if each is
/// listed once for each of its edges that a ray from there crosses.
std::vector<std::size_t> listed_oddly(std::vector<std::size_t> listed);

/// Thousands of pillars in a grid need fewer; thousands of long edges side by side need more.
/// Limit (Scenario): tests by which the edges of walls find those near them. Beyond it: the
/// scenario is refused.
inline constexpr std::size_t kMaxEdgeTests = std::size_t{1} << 23;

/// An edge of rings: its number in the order of for_segments(), its ring, and its first corner.
struct Edge {
  Segment segment;
  std::uint32_t number, ring, corner;
};

/// A constant value, cheap to copy. Any numbers may be in it, also such that are not finite. No
/// query allocates.
class IndexedRings {
 public:
  IndexedRings() = default;
  IndexedRings(Rings rings);  // NOLINT(google-explicit-constructor)
  IndexedRings(std::initializer_list<Ring> rings) : IndexedRings(Rings(rings)) {}

  const Rings& rings() const;
  operator const Rings&() const { return rings(); }  // NOLINT(google-explicit-constructor)
  bool empty() const { return rings().empty(); }
  std::size_t size() const { return rings().size(); }
  auto begin() const { return rings().begin(); }
  auto end() const { return rings().end(); }
  const Ring& operator[](std::size_t ring) const { return rings()[ring]; }
  /// In the order of their numbers.
  std::span<const Edge> edges() const {
    return content_ ? std::span<const Edge>(content_->edges) : std::span<const Edge>();
  }
  std::size_t edge_count() const { return edges().size(); }

  /// Calls `is_it(edge)` for the edges that may be within a distance of `way`, in no order, until
  /// it returns true. Returns whether it did.
  bool find_near(const Segment& way, double within_m, auto&& is_it) const {
    const auto apart = [&](const Bounds& bounds) { return bounds.apart(way, within_m); };
    return search(0, 0, edge_count(), apart, is_it);
  }
  /// Calls `each(segment)` for the edges that may be within a distance of `way`, in order.
  /// @param near  scratch; room for edge_count() entries never grows
  void for_near(const Segment& way, double within_m, std::vector<std::uint32_t>& near,
                auto&& each) const {
    collect(way, within_m, near);
    for (const std::uint32_t number : near) each(edges()[number].segment);
  }
  /// The least of all edges' squared distances from `x_m` [m²]; the greatest number if none is
  /// above `more_than_m2`.
  double least_square_m2(const Eigen::Vector2d& x_m, double more_than_m2 = -1) const;
  /// Whether an odd number of rings contain `x_m`.
  bool solid_at(const Eigen::Vector2d& x_m) const;
  /// Whether it takes more than kMaxEdgeTests to find the edges near each edge, or those to the
  /// right of each ring's first corner. Then touching_edges() or depths() would take seconds.
  bool is_crowded() const;
  /// Calls `each(edge)` for the edges that a ray from `x_m` to the right crosses, as contains() of
  /// core/base/rings.h sees it.
  void for_crossed(const Eigen::Vector2d& x_m, auto&& each) const {
    const auto apart = [&](const Bounds& bounds) { return bounds.beside_ray(x_m); };
    search(0, 0, edge_count(), apart, [&](const Edge& edge) {
      if (crosses_ray(edge.segment, x_m)) each(edge);
      return false;
    });
  }

 private:
  /// The box around edges.
  struct Bounds {
    std::array<double, 2> low, high;

    /// Whether no point of the box is within a distance of `way`. Rounding never makes it true.
    bool apart(const Segment& way, double within_m) const;
    /// Whether no edge in the box crosses the ray from `x_m` to the right.
    bool beside_ray(const Eigen::Vector2d& x_m) const;
    double square_m2(const Eigen::Vector2d& x_m) const;
  };
  struct Content {
    Rings rings;
    std::vector<Edge> edges;           // by number
    std::vector<std::uint32_t> order;  // numbers, by place
    std::vector<Bounds> nodes;         // the children of node i are 2 i + 1 and 2 i + 2
  };
  static constexpr std::size_t kMostInLeaf = 4;

  static void build(Content& content, std::size_t node, std::size_t first, std::size_t end);
  void collect(const Segment& way, double within_m, std::vector<std::uint32_t>& near) const;
  void least_square(std::size_t node, std::size_t first, std::size_t end,
                    const Eigen::Vector2d& x_m, double more_than_m2, double& least_m2) const;
  /// Passes the edges of a node's part [first, end) on to `is_it`, without those in nodes that are
  /// `apart`.
  bool search(std::size_t node, std::size_t first, std::size_t end, const auto& apart,
              auto&& is_it) const {
    if (first == end || apart(content_->nodes[node])) return false;
    if (end - first <= kMostInLeaf) {
      for (std::size_t i = first; i < end; ++i)
        if (is_it(content_->edges[content_->order[i]])) return true;
      return false;
    }
    const std::size_t middle = first + (end - first) / 2;
    return search(2 * node + 1, first, middle, apart, is_it) ||
           search(2 * node + 2, middle, end, apart, is_it);
  }

  std::shared_ptr<const Content> content_;  // null: no rings
};

}  // namespace ergocast
