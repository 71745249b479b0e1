// SPDX-License-Identifier: BSD-3-Clause
// Files of other people, tests/scenario/cases: each is right, or refused in words that help.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <map>
#include <set>

#include "core/base/rings.h"
#include "tests/scenario/scenarios.h"

namespace ergocast {
namespace {

using namespace test;

/// Where something is, and how much of it there is: the area of walls, or the area that the target
/// would have if all of it were as dense as its densest place.
struct Figures {
  double x_m, y_m, area_m2;
};
struct Case {
  const char* name;
  const char* words = "";     ///< of the refusal; empty if it is right
  Figures expected{0, 0, 0};  ///< computed from the file by hand
};

constexpr Figures kSmallBox{14, 17.5, 40}, kFilledSquare{15, 15, 100}, kLatLonBox{0, 0, 33797};

const Case kCases[] = {
    {"asc_dxdy", "", {21.923, 10.897, 650}},
    {"asc_f32nd", "", {22.143, 10.714, 641.7}},
    {"csv_bom", "csv_bom.csv begins with a byte order mark (remove it: sed"},
    {"csv_semi", "csv_semi.csv, line 1: semicolons separate the numbers (write points and commas"},
    {"csv_trailcomma", "csv_trailcomma.csv: every line ends in a comma (remove it: sed"},
    {"csv_utf16", "csv_utf16.csv is in UTF-16 (convert it: iconv -f UTF-16 -t UTF-8"},
    {"gj_dup", "", kLatLonBox},
    {"gj_holetouch",
     "features[0].geometry: ring 1: the edges that begin at vertices[3] and holes[0].vertices[0] "
     "cross or touch (move one of them"},
    {"gj_kml", "", {25.3, -37.1, 16899}},
    {"gj_nullgeom", "", kLatLonBox},
    {"map_p5", "", {14.313, 15, 842.1}},
    {"map_yaml", "", {10, 15, 600}},
    {"nc_2d", "nc_2d.nc: v is a plane without an axis z, and the domain is a box (remove size_z_m"},
    {"nc_short_defaultfill", "", {21, 15.5, 1124.9}},
    {"nc_unsigned_offset", "", {20.459, 14.778, 709.1}},
    {"nc_validrange", "", {21.391, 16.974, 831.25}},
    {"nc_zpos_Down", "", {21.471, 16.765, 850}},
    {"nc_zpos_Down2", "", {21.471, 16.765, 850}},
    {"svg_a", "", kSmallBox},
    {"svg_clip", "line 3: <g>: clip-path refers to #c, which is not there (delete it, or draw #c"},
    {"svg_css_hide", "", kSmallBox},
    {"svg_css_transform", "", {24, 12.5, 40}},
    {"svg_css_wall", "", {15.5, 20, 30}},
    {"svg_hex8", "", kSmallBox},
    {"svg_hidden_wall", "", {5.5, 20, 10}},
    {"svg_important", "", kSmallBox},
    {"svg_nestedsvg", "", {12, 18.75, 10}},
    {"svg_nonzero", "", kFilledSquare},
    {"svg_prefix", "", kSmallBox},
    {"svg_rgba0", "", kSmallBox},
    {"svg_samedir", "", kFilledSquare},
    {"svg_switch", "", kSmallBox},
    {"svg_three", "", {12.789, 18.587, 44.53}},
    {"svg_transparent", "", kSmallBox},
    {"svg_two_walls", "", {17.038, 23.577, 26}},
    {"svg_visibility", "", kSmallBox},
    {"tp_nbsp",
     "tp_nbsp.textproto:1:22: a character outside of quotes is not ASCII (write straight"},
    {"tp_smart", "tp_smart.textproto:1:7: name: a character outside of quotes is not ASCII (write"},
    {"utm_lab",
     "domain.origin_y_m: 5403720 is more than 800000 m from 0, too far for a domain of 8 m (count "
     "from its corner; if these are coordinates of a map, such as UTM, write the corner as origin"},
};

std::filesystem::path cases_folder() {
  return std::filesystem::path(ERGOCAST_SCENARIO_DIR).parent_path() / "tests/scenario/cases";
}

/// By Green's formula; holes go round the other way.
Figures figures_of(const Rings& walls) {
  Eigen::Vector2d moment(0, 0);
  double area = 0;
  for (const Ring& ring : walls) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Eigen::Vector2d &a = ring[i], &b = ring[(i + 1) % ring.size()];
      const double twice = a.x() * b.y() - a.y() * b.x();
      area += twice / 2;
      moment += twice / 6 * (a + b);
    }
  }
  return {moment.x() / area, moment.y() / area, std::abs(area)};
}

Figures figures_of(const DensityGrid& density, const Box& domain) {
  const double width_m = domain.size_m.x() / static_cast<double>(density.rows());
  const double height_m = domain.size_m.y() / static_cast<double>(density.cols());
  Eigen::Vector2d moment(0, 0);
  for (Eigen::Index i = 0; i < density.rows(); ++i)
    for (Eigen::Index j = 0; j < density.cols(); ++j)
      moment += density(i, j) * Eigen::Vector2d((static_cast<double>(i) + 0.5) * width_m,
                                                (static_cast<double>(j) + 0.5) * height_m);
  const Eigen::Vector2d mean = domain.origin_m.head<2>() + moment / density.sum();
  return {mean.x(), mean.y(), density.sum() / density.maxCoeff() * width_m * height_m};
}

class CasesOfOtherPeople : public ::testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(Files, CasesOfOtherPeople, ::testing::ValuesIn(kCases),
                         [](const auto& one) { return std::string(one.param.name); });

TEST_P(CasesOfOtherPeople, IsRightOrRefusedInWordsThatHelp) {
  const auto& [name, words, expected] = GetParam();
  const std::string_view folder = std::string_view(name).starts_with("svg") ? "drawings" : ".";
  const Loaded loaded =
      Scenario::load(cases_folder() / folder / (std::string(name) + ".textproto"));
  if (*words != '\0') {
    ASSERT_FALSE(loaded);
    EXPECT_EQ(loaded.error().size(), 1U) << joined(loaded.error());
    EXPECT_TRUE(has(joined(loaded.error()), words));
    return;
  }
  ASSERT_TRUE(loaded) << joined(loaded.error());
  const Mission& mission = loaded->mission();
  const Figures seen = mission.walls.empty() ? figures_of(loaded->target_density(), mission.domain)
                                             : figures_of(mission.walls);
  // A cell of the picture, and what painting widens.
  const double slack_m = mission.domain.size_m.x() / 250;
  EXPECT_NEAR(seen.x_m, expected.x_m, slack_m);
  EXPECT_NEAR(seen.y_m, expected.y_m, slack_m);
  EXPECT_NEAR(seen.area_m2, expected.area_m2, 0.03 * expected.area_m2);
}

// A file without a line in the table would be tried by nobody.
TEST(CasesOfOtherPeople, AreAllInTheTable) {
  std::set<std::string> named, kept;
  for (const Case& one : kCases) named.insert(one.name);
  for (const auto& file : std::filesystem::recursive_directory_iterator(cases_folder()))
    if (file.path().extension() == ".textproto") kept.insert(file.path().stem());
  EXPECT_EQ(named, kept);
}

}  // namespace
}  // namespace ergocast
