// SPDX-License-Identifier: BSD-3-Clause
// Shapes of drawings: the same corners however they are written, and an error with line, element
// and remedy for everything else.
#include "target/geo/svg.h"

#include <gtest/gtest.h>

#include <fstream>

#include "tests/support/temp_folder.h"

namespace ergocast {
namespace {

using Corners = std::vector<Eigen::Vector2d>;

/// A drawing of 20 × 10 units with `content`, which stands on line 2.
std::string drawing(const std::string& content) {
  return "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 20 10\">\n" + content +
         "\n</svg>";
}

Drawing drawn(const std::string& text) {
  const auto parsed = parse_svg(text);
  if (parsed) return *parsed;
  ADD_FAILURE() << parsed.error().member << ": " << parsed.error().what;
  return {};
}

Corners only_ring(const std::string& content) {
  const Drawing result = drawn(drawing(content));
  if (result.shapes.size() != 1 || result.shapes.front().rings.size() != 1) return {};
  return result.shapes.front().rings.front();
}

PolygonFileProblem problem_of(const std::string& text) {
  const auto parsed = parse_svg(text);
  if (!parsed) return parsed.error();
  ADD_FAILURE() << "accepted: " << text;
  return {};
}

/// From (2, 6) to (5, 9) with y up: from (2, 1) to (5, 4) in the drawing.
const Corners kSquare = {{2, 9}, {5, 9}, {5, 6}, {2, 6}};

TEST(Svg, ShapesAreTheSameHoweverTheyAreWritten) {
  EXPECT_EQ(only_ring(R"~(<rect x="2" y="1" width="3" height="3"/>)~"), kSquare);
  EXPECT_EQ(only_ring(R"~(<polygon points="2,1 5,1 5,4 2,4"/>)~"), kSquare);
  EXPECT_EQ(only_ring(R"~(<polygon points="2 1 5 1,5 4 2 4 2 1"/>)~"), kSquare);
  EXPECT_EQ(only_ring(R"~(<path d="M2,1 L5,1 L5,4 L2,4 Z"/>)~"), kSquare);
  EXPECT_EQ(only_ring(R"~(<path d="M2 1 5 1 5 4 2 4"/>)~"), kSquare);
  EXPECT_EQ(only_ring(R"~(<path d="m2 1h3v3h-3z"/>)~"), kSquare);
  EXPECT_EQ(only_ring(R"~(<path d="m2 1 3 0 0 3-3 0z"/>)~"), kSquare);
  EXPECT_EQ(only_ring(R"~(<path d="M 2,1 H 5 V 4 H 2 V 1 z"/>)~"), kSquare);
  EXPECT_EQ(only_ring(R"~(<path d="M+.2e1 1l3 0 0 3-3-0z"/>)~"), kSquare);
}

TEST(Svg, TransformsOfGroupsCount) {
  EXPECT_EQ(only_ring(R"~(<g transform="translate(2,1)"><rect width="3" height="3"/></g>)~"),
            kSquare);
  EXPECT_EQ(
      only_ring(R"~(<g transform="translate(2 1) scale(3)"><rect width="1" height="1"/></g>)~"),
      kSquare);
  EXPECT_EQ(only_ring(R"~(<g transform="translate(1)"><g transform="matrix(3 0 0 3 1 1)">
      <rect width="1" height="1"/></g></g>)~"),
            kSquare);
  const Corners turned =
      only_ring(R"~(<rect x="2" y="1" width="3" height="3" transform="rotate(90, 3.5, 2.5)"/>)~");
  ASSERT_EQ(turned.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_LT((turned[i] - kSquare[(i + 1) % 4]).norm(), 1e-12) << i;
  const Corners leaning = only_ring(R"~(<rect width="3" height="3" transform="skewX(45)"/>)~");
  ASSERT_EQ(leaning.size(), 4U);
  EXPECT_LT((leaning[2] - Eigen::Vector2d(6, 7)).norm(), 1e-12);
}

// −15.6 + 31.7 is 16.1, and 16.1 + 15.6 is more than 31.7.
TEST(Svg, TheViewBoxHasItsOwnEdgesWhereverItBegins) {
  const Drawing result = drawn(
      "<svg viewBox='-15.6 -15.6 31.7 31.7'><rect x='-15.6' y='-15.6' width='2' "
      "height='2'/></svg>");
  ASSERT_EQ(result.shapes.size(), 1U);
  const auto& ring = result.shapes.front().rings.front();
  EXPECT_EQ(ring.front(), Eigen::Vector2d(0, 31.7));
}

TEST(Svg, SubpathsAreRingsOfOneShape) {
  const Drawing result = drawn(drawing(
      R"~(<path d="M0 0H20V10H0Z M1 1v8h18v-8z"/><rect x="4" y="4" width="1" height="1"/>)~"));
  ASSERT_EQ(result.shapes.size(), 2U);
  EXPECT_EQ(result.size, Eigen::Vector2d(20, 10));
  ASSERT_EQ(result.shapes[0].rings.size(), 2U);
  EXPECT_EQ(result.shapes[0].rings[1], (Corners{{1, 9}, {1, 1}, {19, 1}, {19, 9}}));
  // Relative to the point to which Z went back.
  const Drawing second = drawn(drawing(R"~(<path d="m1 1h2v2h-2zm5 0h2v2h-2z"/>)~"));
  EXPECT_EQ(second.shapes.at(0).rings.at(1).front(), Eigen::Vector2d(6, 9));
  // A line after Z begins where Z went back to.
  const Drawing third = drawn(drawing(R"(<path d="m1 1h2v2h-2zh-1v1z"/>)"));
  EXPECT_EQ(third.shapes.at(0).rings.at(1), (Corners{{1, 9}, {0, 9}, {0, 8}}));
}

TEST(Svg, TheViewBoxMayBeginAnywhere) {
  const Drawing result =
      drawn(R"~(<svg viewBox="-5 10 20 10"><rect x="-3" y="11" width="3" height="3"/></svg>)~");
  ASSERT_EQ(result.shapes.size(), 1U);
  EXPECT_EQ(result.shapes[0].rings.at(0), kSquare);
}

TEST(Svg, WhatShowsNoAreaIsLeftOut) {
  const std::string wall = R"~(<rect x="2" y="1" width="3" height="3"/>)~";
  EXPECT_EQ(only_ring("<!-- a floor --><title>Floor</title><defs><rect/></defs>" + wall), kSquare);
  EXPECT_EQ(only_ring(R"~(<circle r="1" fill="none"/><line x1="1" style="fill: none"/>)~" + wall),
            kSquare);
  EXPECT_EQ(only_ring(R"~(<g style="display:none"><circle r="1"/><text>A</text></g>)~" + wall),
            kSquare);
  EXPECT_EQ(only_ring(R"~(<s:namedview xmlns:s="http://other"/>)~" + wall), kSquare);
  EXPECT_EQ(only_ring(R"~(<g fill="none"><circle r="1"/></g>)~" + wall), kSquare);
  EXPECT_EQ(
      only_ring(R"~(<g fill="none"><rect x="2" y="1" width="3" height="3" fill="black"/></g>)~"),
      kSquare);
}

TEST(Svg, WhatIsNoStraightDarkShapeIsPainted) {
  for (const auto& [content, because] : std::vector<std::pair<std::string, std::string>>{
           {R"~(<circle r="1"/>)~", "is no straight shape"},
           {R"~(<use href="#a"/>)~", "is no straight shape"},
           {R"~(<path d="M0 0C1 1 2 2 3 3z"/>)~", "has curves"},
           {R"~(<path d="M0 0a1 1 0 013 3z"/>)~", "has curves"},
           {R"~(<rect width="3" height="3" rx="1"/>)~", "has round corners"},
           {R"~(<rect width="30%" height="3"/>)~", "has lengths in percent"},
           {R"~(<rect width="3" height="3" stroke="red"/>)~", "has a stroke"},
           {R"~(<rect width="3" height="3" fill="white"/>)~", "has the fill white"},
           {R"~(<rect width="3" height="3" opacity=".5"/>)~", "has opacity: .5"},
           {R"~(<rect height="3" style="width: 3px"/>)~", "has its place in its style"},
           {"<style>g{fill:red}</style>", "sets properties of shapes"},
       }) {
    const Drawing result = drawn(drawing(content + R"~(<rect id="a" width="3" height="3"/>)~"));
    EXPECT_EQ(result.paint_because,
              "line 2: " + content.substr(0, content.find_first_of(" >")) + "> " + because);
    EXPECT_TRUE(result.shapes.empty());
  }
}

TEST(Svg, WhatItCannotReadIsNamedWithLineAndRemedy) {
  struct Bad {
    std::string content, what;
  };
  for (const auto& [content, what] : std::vector<Bad>{
           {R"~(<image width="1"/>)~", "is not read"},
           {R"~(<path d="L0 0 1 1 2 0z"/>)~", "d does not begin with M"},
           {R"~(<path d="M0 0 1 1 2 0z 5"/>)~", "d has a number where a command is due"},
           {R"~(<path d="M0 0 1 1 2"/>)~", R"(d has no finite number at "")"},
           {R"~(<path d="M0 0 1 1z"/>)~", "has a part with fewer than three corners"},
           {R"~(<path d=""/>)~", "has no corners"},
           {R"~(<path d="M0 0 1e999 1 2 0z"/>)~", R"(d has no finite number at "1e999 1 2 0z")"},
           {R"~(<polygon points="0 0 1 1 2"/>)~", "has an odd number of coordinates"},
           {R"~(<polygon points="0 0 1 nan 2 0"/>)~",
            R"(points has no finite number at "nan 2 0")"},
           {R"~(<rect width="3"/>)~", "has no width or height above 0"},
           {R"~(<rect width="3" height="-3"/>)~", "has a negative width or height"},
           {R"~(<rect width="3ft" height="3"/>)~", "width is in ft, which is not read"},
           {R"~(<rect width="3" height="3" transform="shear(1)"/>)~",
            "transform has a transform that SVG does not know: shear"},
           {R"~(<rect width="3" height="3" transform="scale(1"/>)~", "transform lacks a ')'"},
           {R"~(<rect width="3" height="3" transform="scale(1e300) scale(1e300)"/>)~",
            "is infinitely large"},
       }) {
    const PolygonFileProblem problem = problem_of(drawing(content));
    EXPECT_EQ(problem.what, what) << content;
    EXPECT_EQ(problem.member, "line 2: " + content.substr(0, content.find(' ')) + ">") << content;
    EXPECT_FALSE(problem.remedy.empty());
  }
}

TEST(Svg, FilesThatAreNoDrawingsAreNamed) {
  EXPECT_EQ(problem_of("{}").what, "is no XML: No document element found");
  EXPECT_EQ(problem_of("<svg viewBox='0 0 1 1'>\n<g>").member, "line 2");
  EXPECT_EQ(problem_of("<html/>").what, "is no SVG drawing");
  EXPECT_EQ(problem_of(drawing("")).what, "has no filled or stroked shape");
  for (const char* box : {"", "0 0 1", "0 0 0 1", "0 0 1 -1"}) {
    EXPECT_EQ(
        problem_of(std::string("<svg viewBox='") + box + "'><rect width='1' height='1'/></svg>")
            .what,
        "has no viewBox of four numbers with a width and a height above 0");
  }
  std::string deep = R"~(<rect width="3" height="3"/>)~";
  for (int i = 0; i < 100; ++i) deep = "<g>" + deep + "</g>";
  EXPECT_EQ(problem_of(drawing(deep)).what, "is in more than 64 groups");
}

TEST(Svg, FilesAreReadToTheirLimit) {
  const test::TempFolder folder;
  const auto file = folder.path() / "floor.svg";
  EXPECT_EQ(read_svg(file).error().what, "there is no such file");
  std::ofstream(file) << drawing(R"~(<rect x="2" y="1" width="3" height="3"/>)~");
  EXPECT_EQ(read_svg(file).value().shapes.size(), 1U);
  std::ofstream(file) << drawing(std::string(kMaxPolygonFileBytes, ' '));
  EXPECT_EQ(read_svg(file).error().what, "has more than 16 MiB");
}

}  // namespace
}  // namespace ergocast
