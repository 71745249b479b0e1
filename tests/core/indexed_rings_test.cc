// SPDX-License-Identifier: BSD-3-Clause
// The tree of edges gives the answers of all edges, bit for bit.
#include "core/base/indexed_rings.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace ergocast {
namespace {

/// Triangles of very different sizes, some of which cross.
Rings drawn_rings(std::mt19937& random, int count) {
  std::uniform_real_distribution<double> place(-50, 50), size(-6, 2);
  Rings rings;
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector2d at(place(random), place(random));
    const double side_m = std::exp(size(random));
    rings.push_back(
        {at, at + side_m * Eigen::Vector2d(1, 0.3), at + side_m * Eigen::Vector2d(0, 1)});
  }
  return rings;
}

TEST(IndexedRings, AnswerAsAllEdgesDo) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> place(-60, 60), length(0, 9);
  for (const int count : {0, 1, 2, 3, 50, 700}) {
    const Rings rings = drawn_rings(random, count);
    const IndexedRings indexed(rings);
    std::vector<std::uint32_t> near;
    for (int trial = 0; trial < 300; ++trial) {
      const Eigen::Vector2d x_m(place(random), place(random)), y_m(place(random), place(random));
      const Segment way{x_m, trial % 3 == 0 ? y_m : x_m + (y_m - x_m) / 20};
      const double within_m = trial % 2 == 0 ? 0 : length(random);
      double least_m2 = std::numeric_limits<double>::max();
      bool solid = false;
      std::vector<Eigen::Vector2d> expected, found;
      for (const Ring& ring : rings) solid ^= contains(ring, x_m);
      for_segments(rings, [&](const Segment& edge) {
        least_m2 = std::min(least_m2, (edge.nearest_m(x_m) - x_m).squaredNorm());
        if (distance_m(way, edge) <= within_m) expected.push_back(edge.from_m);
      });
      indexed.for_near(way, within_m, near, [&](const Segment& edge) {
        if (distance_m(way, edge) <= within_m) found.push_back(edge.from_m);
      });
      EXPECT_EQ(indexed.least_square_m2(x_m), least_m2);
      EXPECT_EQ(indexed.solid_at(x_m), solid);
      EXPECT_EQ(found, expected) << "in the same order";
    }
  }
}

TEST(IndexedRings, FindTheFirstPairThatTouches) {
  std::mt19937 random(2);
  for (int trial = 0; trial < 40; ++trial) {
    const Rings rings = drawn_rings(random, 60);
    std::optional<std::pair<std::size_t, std::size_t>> first;
    for (std::size_t i = 0; i < 3 * rings.size() && !first; ++i) {
      for (std::size_t j = 0; j < i && !first; ++j) {
        const auto edge = [&](std::size_t e) {
          return Segment{rings[e / 3][e % 3], rings[e / 3][(e + 1) % 3]};
        };
        if (i / 3 != j / 3 && touch(edge(i), edge(j))) first = {i, j};
      }
    }
    const auto found = touching_edges(rings);
    ASSERT_EQ(found.has_value(), first.has_value());
    if (!found) continue;
    EXPECT_EQ(3 * found->ring + found->corner, first->first);
    EXPECT_EQ(3 * found->other_ring + found->other_corner, first->second);
  }
}

TEST(IndexedRings, MayHaveNumbersThatAreNone) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN(),
                   kInfinity = std::numeric_limits<double>::infinity();
  Rings rings;
  for (int i = 0; i < 40; ++i)
    rings.push_back({{i % 3 == 0 ? kNan : i, i % 5 == 0 ? kInfinity : -i}, {1.0 * i, 2}, {}});
  const IndexedRings indexed(rings);
  EXPECT_EQ(indexed.edge_count(), 120u);
  EXPECT_EQ(indexed.rings().size(), 40u);
  touching_edges(indexed);
  EXPECT_EQ(depths(indexed).size(), 40u);
}

}  // namespace
}  // namespace ergocast
