// SPDX-License-Identifier: BSD-3-Clause
// Polygons from a drawing: the target that vertices in metres give, and an error with file, line,
// field and remedy for everything else.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "tests/scenario/scenarios.h"
#include "tests/support/temp_folder.h"

namespace ergocast {
namespace {

using namespace test;

/// A drawing of the small scenario's 100 m × 50 m, with units of 5 m.
std::string drawing(const std::string& content, const std::string& box = "0 0 20 10") {
  return "<svg viewBox=\"" + box + "\">\n" + content + "</svg>";
}

class SvgTarget : public ::testing::Test {
 protected:
  Loaded load(const std::string& target, const std::string& svg = "") {
    std::ofstream(folder_.path() / "floor.svg") << svg;
    std::ofstream(folder_.path() / "mine.textproto")
        << small_with("uniform_weight: 1", "uniform_weight: 1 " + target);
    return Scenario::load(folder_.path() / "mine.textproto");
  }
  Coefficients target(const std::string& text, const std::string& svg = "") {
    return good(load(text, svg)).mission().target_coefficients;
  }
  void expect_same(const std::string& svg, const std::string& vertices) {
    EXPECT_LE((target(kFile, svg) - target(vertices)).cwiseAbs().maxCoeff(), 1e-12) << svg;
  }
  void expect_problem(const std::string& svg, const std::string& what) {
    const Loaded result = load(kFile, svg);
    const std::string printed = result ? "" : joined(result.error());
    EXPECT_TRUE(has(printed, "mine.textproto:3:"));
    EXPECT_TRUE(has(printed, "target.keep_outs[0].file: " +
                                 (folder_.path() / "floor.svg").string() + ": " + what));
    EXPECT_EQ(std::count(printed.begin(), printed.end(), '\n'), 1) << printed;
  }

  static constexpr const char* kFile = "keep_outs { file: \"floor.svg\" }";
  const TempFolder folder_;
};

std::string ring(double low_x, double low_y, double high_x, double high_y) {
  std::string text;
  for (const auto& [x, y] : {std::pair(low_x, low_y), std::pair(high_x, low_y),
                             std::pair(high_x, high_y), std::pair(low_x, high_y)})
    text += "vertices { x_m: " + std::to_string(x) + " y_m: " + std::to_string(y) + " } ";
  return text;
}

TEST_F(SvgTarget, TheDrawingCoversTheDomainWithYUp) {
  expect_same(drawing(R"(<rect x="2" y="1" width="4" height="3"/>)"),
              "keep_outs { " + ring(10, 30, 30, 45) + "}");
  expect_same(drawing(R"(<rect x="-8" y="11" width="4" height="3"/>)", "-10 10 20 10"),
              "keep_outs { " + ring(10, 30, 30, 45) + "}");
}

TEST_F(SvgTarget, ARingInsideAnotherIsAHoleAndOneInAHoleIsNone) {
  expect_same(drawing(R"(<path fill-rule="evenodd" d="M1 1h8v8h-8z M2 2h6v6h-6z M3 3h2v2h-2z"/>)"),
              "keep_outs { " + ring(5, 5, 45, 45) + "holes { " + ring(10, 10, 40, 40) +
                  "} } keep_outs { " + ring(15, 25, 25, 35) + "}");
}

TEST_F(SvgTarget, ARingThatGoesRoundTheSameWayIsNoHole) {
  expect_same(drawing(R"(<path d="M1 1h8v8h-8z M2 2h6v6h-6z"/>)"),
              "keep_outs { " + ring(5, 5, 45, 45) + "}");
}

TEST_F(SvgTarget, NamesTheElementThatIsWrong) {
  expect_problem(drawing(R"(<polygon points="1 1 1"/>)"),
                 "line 2: <polygon>: has an odd number of coordinates (save it anew");
  expect_problem(
      drawing("\n<path d=\"M0 0H20V10H0V5H20V6H0z\"/>"),
      "more than 90 % of it is solid (it is painted because line 3: <path> crosses itself)");
  expect_problem(drawing(R"(<rect width="12" height="10"/><rect x="10" width="10" height="10"/>)"),
                 "more than 90 % of it is solid (it is painted because line 2: <rect> touches or "
                 "overlaps line 2: <rect>)");
  expect_problem(drawing(R"(<rect x="25" width="1" height="1"/>)"),
                 "none of its polygons meets the domain");
  expect_problem(drawing(R"(<rect width="1" height="1"/>)", "0 0 20 15"),
                 "its viewBox is 20 by 15, and the domain has another shape (set domain.size_y_m "
                 "to 75, or the drawing's size to the domain's)");
  std::string many = "<path d=\"M1 1";
  for (int i = 0; i < 5000; ++i) many += "h.001v.001";
  expect_problem(drawing(many + "V1z\"/>"), "has 10002 vertices, above the limit 4096 (simplify");
}

}  // namespace
}  // namespace ergocast
