// SPDX-License-Identifier: BSD-3-Clause
// Invalid polygons and valid ones.
#include "scenario/rules/polygon_flaw.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace ergocast {
namespace {

Ring box(double x, double y, double size) {
  return {{x, y}, {x + size, y}, {x + size, y + size}, {x, y + size}};
}

/// "hole: what"; empty if nothing is wrong. Checks that the other orientation of the rings gives
/// the same.
std::string problem_of(Polygon polygon, double min_area_m2 = 1e-6) {
  const auto text = [&] {
    const auto flaw = flaw_of(polygon, min_area_m2);
    return flaw ? std::to_string(flaw->hole) + ": " + flaw->what : "";
  };
  const std::string printed = text();
  std::reverse(polygon.outline.begin(), polygon.outline.end());
  for (Ring& hole : polygon.holes) std::reverse(hole.begin(), hole.end());
  EXPECT_EQ(text().empty(), printed.empty()) << printed;
  return printed;
}

TEST(Polygons, ThatAreSoundAreLetThrough) {
  EXPECT_EQ(problem_of({box(0, 0, 10), {}}), "");
  EXPECT_EQ(problem_of({{{0, 0}, {10, 0}, {5, 5}, {10, 10}, {0, 10}, {4, 5}}, {}}), "");
  EXPECT_EQ(problem_of({{{0, 0}, {5, 0}, {10, 0}, {10, 10}}, {}}),
            "");  // a vertex on a straight edge
  EXPECT_EQ(problem_of({box(0, 0, 10), {box(1, 1, 2), box(4, 4, 2), box(7, 7, 2)}}), "");
}

TEST(Polygons, WithTooFewOrRepeatedVerticesAreNamed) {
  EXPECT_EQ(problem_of({{}, {}}), "-1: 0 vertices enclose nothing");
  EXPECT_EQ(problem_of({{{0, 0}, {1, 1}}, {}}), "-1: 2 vertices enclose nothing");
  EXPECT_EQ(problem_of({{{0, 0}, {4, 0}, {4, 0}, {0, 4}}, {}}),
            "-1: vertices[1] and vertices[2] are the same");
  EXPECT_EQ(problem_of({box(0, 0, 10), {{{1, 1}, {2, 2}}}}), "0: 2 vertices enclose nothing");
  EXPECT_EQ(problem_of({{{0.1, 0.1}, {0.2, 0.2}, {0.7, 0.7}, {0.3, 0.3}}, {}}),
            "-1: all its vertices are on one line");
  const auto closed = flaw_of({{{0, 0}, {4, 0}, {0, 4}, {0, 0}}, {}}, 1);
  ASSERT_TRUE(closed);
  EXPECT_EQ(closed->remedy, "leave out the last: a ring closes by itself");
}

TEST(Polygons, ThatCrossOrTouchThemselvesAreNamed) {
  EXPECT_EQ(problem_of({{{0, 0}, {10, 10}, {10, 0}, {0, 10}}, {}}),
            "-1: the edges that begin at vertices[0] and vertices[2] cross or touch");
  // A corner on another edge, a corner on another corner, an edge that goes back along the last.
  EXPECT_NE(problem_of({{{0, 0}, {10, 0}, {10, 10}, {5, 0}, {0, 10}}, {}}), "");
  EXPECT_NE(problem_of({{{0, 0}, {4, 0}, {5, 5}, {6, 0}, {10, 0}, {10, 9}, {5, 5}, {0, 9}}, {}}),
            "");
  EXPECT_NE(problem_of({{{0, 0}, {10, 0}, {5, 0}}, {}}), "");
  EXPECT_NE(problem_of({{{0, 0}, {10, 0}, {10, 5}, {10, -5}}, {}}), "");
}

TEST(Polygons, WithHolesInTheWrongPlacesAreNamed) {
  EXPECT_EQ(problem_of({box(0, 0, 10), {box(1, 1, 2), box(20, 20, 2)}}),
            "1: the hole is outside the polygon");
  EXPECT_EQ(problem_of({box(0, 0, 10), {box(1, 1, 6), box(2, 2, 2)}}),
            "1: the hole is inside holes[0]");
  EXPECT_NE(problem_of({box(0, 0, 10), {box(8, 8, 4)}}), "");
  EXPECT_NE(problem_of({box(0, 0, 10), {box(0, 1, 4)}}), "");  // touches the outline
  EXPECT_NE(problem_of({box(0, 0, 10), {box(1, 1, 3), box(3, 3, 3)}}), "");
  EXPECT_NE(problem_of({box(0, 0, 10), {box(-5, -5, 30)}}), "");
}

TEST(Polygons, WithHardlyAnyAreaAreNamed) {
  EXPECT_EQ(problem_of({box(0, 0, 1), {}}, 1), "");
  EXPECT_EQ(problem_of({box(0, 0, 1), {}}, 1.5), "-1: its area, 1 m², is below the limit 1.5 m²");
}

}  // namespace
}  // namespace ergocast
