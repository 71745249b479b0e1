// SPDX-License-Identifier: BSD-3-Clause
// Targets from files: the place of a map, its mass, the coefficients of it, and the errors of an
// unusable one.
#include <gtest/gtest.h>

#include <fstream>

#include "target/raster_integral.h"
#include "target/target.h"
#include "tests/scenario/scenarios.h"
#include "tests/support/grey_png.h"
#include "tests/support/temp_folder.h"

namespace ergocast {
namespace {

using namespace test;
namespace fs = std::filesystem;

class MapTarget : public ::testing::Test {
 protected:
  void write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }
  /// kSmall, whose domain is 100 × 50 m, with this target, in the folder of the maps.
  fs::path scenario_with(const std::string& target) {
    write("mine.textproto", small_with("uniform_weight: 1", target));
    return folder_ / "mine.textproto";
  }
  Scenario loaded(const std::string& target) { return good(Scenario::load(scenario_with(target))); }
  Coefficients mu_of(const std::string& target) {
    return loaded(target).mission().target_coefficients;
  }
  std::string problem_of(const std::string& target) {
    const Loaded result = Scenario::load(scenario_with(target));
    return result ? "" : joined(result.error());
  }

  const TempFolder own_;
  const fs::path& folder_ = own_.path();
};

constexpr const char* kWhole = "origin_x_m: 0 origin_y_m: 0 size_x_m: 100 size_y_m: 50 ";
std::string map_of(const std::string& file, const std::string& more = kWhole) {
  return "maps { file: \"" + file + "\" " + more + " } ";
}

TEST_F(MapTarget, ThreeKindsOfFilesOfOneMapAreOneTarget) {
  // 4 × 2 cells of 25 m, the north-east quarter the densest.
  write("a.csv", "0,1,2,9\n3,0,1,4\n");
  write("a.asc",
        "ncols 4\nnrows 2\nxllcenter 12.5\nyllcenter 12.5\ncellsize 25\n0 1 2 9\n3 0 1 4\n");
  const int values[2][4] = {{0, 1, 2, 9}, {3, 0, 1, 4}};
  write_png(folder_ / "a.png", 4, 2, {.bits = 16},
            [&](int column, int row, int) { return 1000 * values[row][column]; });
  const Coefficients csv = mu_of(map_of("a.csv"));
  EXPECT_LE((mu_of(map_of("a.asc", "")) - csv).cwiseAbs().maxCoeff(), 1e-15);
  EXPECT_LE((mu_of(map_of("a.png")) - csv).cwiseAbs().maxCoeff(), 1e-15);
  EXPECT_LT(csv[16], -0.1);  // cos falls towards the east, where most of it is
  EXPECT_LT(csv[1], -0.1);   // and towards the north
}

TEST_F(MapTarget, FirstRowDefinesWhichWayIsNorth) {
  write("north.csv", "1,2,0\n5,0,1\n0,0,3\n");
  write("south.csv", "0,0,3\n5,0,1\n1,2,0\n");
  const Coefficients mu = mu_of(map_of("north.csv"));
  EXPECT_EQ(mu_of(map_of("north.csv", std::string(kWhole) + "first_row: NORTH")), mu);
  EXPECT_LE((mu_of(map_of("south.csv", std::string(kWhole) + "first_row: SOUTH")) - mu)
                .cwiseAbs()
                .maxCoeff(),
            1e-15);
  EXPECT_GT((mu_of(map_of("south.csv")) - mu).cwiseAbs().maxCoeff(), 0.1);
}

// A map of three Gaussians' values at the centres of cells has their coefficients, up to the square
// of a cell. Half a cell's shift would be off by the first power: 0.05.
TEST_F(MapTarget, ASampledGaussianIsWhereItWas) {
  constexpr int kColumns = 100, kRows = 50;
  const TargetDensity bell{{plane_gaussian(1, {37, 22}, 36 * Eigen::Matrix2d::Identity())}, 0};
  const Box domain{{0, 0, 0}, {100, 50, 0}};
  write_png(folder_ / "bell.png", kColumns, kRows, {.bits = 16}, [&](int column, int row, int) {
    const double density = density_unscaled(bell, domain, {column + 0.5, 50 - (row + 0.5), 0});
    return static_cast<int>(density * 65535 * 2 * 3.14159 * 36);
  });
  const Coefficients mu = mu_of(map_of("bell.png"));
  const Coefficients expected =
      target_coefficients(bell, domain, {.modes_x = 16, .modes_y = 16}).values;
  // A cell's average differs from its centre by (k·1 m)²/24 at most; k = 15π/50 makes it 0.04 times
  // the coefficient, which is 0.002 there. 16 bits are good to 1e-4.
  EXPECT_LE((mu - expected).cwiseAbs().maxCoeff(), 2e-3);
}

TEST_F(MapTarget, OfEqualNumbersIsTheUniformTarget) {
  write("a.csv", "0.3,0.3,0.3\n0.3,0.3,0.3\n");
  Coefficients expected = Coefficients::Zero(256);
  expected[0] = 1;
  EXPECT_LE((mu_of(map_of("a.csv")) - expected).cwiseAbs().maxCoeff(), 1e-15);
  EXPECT_LE(
      (mu_of(map_of("a.csv", "origin_x_m: -7 origin_y_m: -900 size_x_m: 300 size_y_m: 1000")) -
       expected)
          .cwiseAbs()
          .maxCoeff(),
      1e-15);
}

TEST_F(MapTarget, PartsAddUpByTheirWeights) {
  write("left.csv", "1,0\n");
  write("right.csv", "0,1\n");
  const std::string region =
      "polygon { vertices { x_m: 10 y_m: 10 } vertices { x_m: 20 y_m: 10 } "
      "vertices { x_m: 15 y_m: 30 } }";
  const Coefficients left = mu_of(map_of("left.csv")), right = mu_of(map_of("right.csv"));
  const Coefficients triangle = mu_of("regions { " + region + " }");
  const Coefficients all =
      mu_of("uniform_weight: 1 " + map_of("left.csv", std::string(kWhole) + "weight: 3") +
            map_of("right.csv") + "regions { weight: 5 " + region + " }");
  Coefficients expected = 3 * left + right + 5 * triangle;
  expected[0] += 1;
  EXPECT_LE((all - expected / 10).cwiseAbs().maxCoeff(), 1e-14);
}

TEST_F(MapTarget, KeepOutsCutMapsAsTheyCutRegions) {
  write("a.csv", "2\n");
  const std::string keep_outs =
      "keep_outs { vertices { x_m: 40 y_m: -5 } vertices { x_m: 80 y_m: 30 } vertices { x_m: 30 "
      "y_m: 40 } }"
      "keep_outs { vertices { x_m: 50 y_m: 5 } vertices { x_m: 90 y_m: 20 } vertices { x_m: 50 "
      "y_m: 45 } }";
  const Coefficients uniform = mu_of("uniform_weight: 1 " + keep_outs);
  EXPECT_LE((mu_of(map_of("a.csv") + keep_outs) - uniform).cwiseAbs().maxCoeff(), 1e-14);
  EXPECT_GT(uniform.cwiseAbs().sum(), 1.5);
}

TEST_F(MapTarget, EqualInputsGiveEqualBytesAndThePlanNeedsNoMap) {
  write("a.csv", "0,1,2,9\n3,0,1,4\n");
  fs::create_directories(folder_ / "b");
  fs::copy(folder_ / "a.csv", folder_ / "b" / "other.csv");
  const Scenario scenario = loaded(map_of("a.csv"));
  EXPECT_EQ(plan_of(loaded(map_of("b/other.csv"))), plan_of(scenario));
  EXPECT_EQ(plan_of(good(Scenario::parse(scenario.print(), "/elsewhere/mine.textproto"))),
            plan_of(scenario));
  EXPECT_TRUE(has(scenario.print(), "file: \"" + (folder_ / "a.csv").string() + "\""));

  fs::remove_all(folder_);
  const std::vector<std::byte> plan = plan_of(scenario);
  const auto read = decode_plan(plan);
  ASSERT_TRUE(read) << read.error();
  EXPECT_EQ(read->target_coefficients, scenario.mission().target_coefficients);
  const std::string bytes(reinterpret_cast<const char*>(plan.data()), plan.size());
  EXPECT_EQ(bytes.find("a.csv"), std::string::npos);
}

TEST_F(MapTarget, PictureShowsIt) {
  write("a.csv", "0,1,2,9\n3,0,1,4\n");
  const DensityGrid density = loaded(map_of("a.csv")).target_density();
  EXPECT_EQ(density.rows(), 256);
  EXPECT_EQ(density.cols(), 128);
  EXPECT_NEAR(density.mean(), 1, 1e-12);
  EXPECT_NEAR(density(255, 127), 9 * 8 / 20.0, 1e-12);  // north-east: 9 of a mean of 20/8
  EXPECT_NEAR(density(0, 0), 3 * 8 / 20.0, 1e-12);
}

// ---- problems ----

TEST_F(MapTarget, ThatCannotBeUsedIsOneProblemAtItsField) {
  write("zero.csv", "0,0\n0,0\n");
  write("negative.csv", "1,2\n3,-4\n");
  write("ragged.csv", "1,2\n3\n");
  write("good.csv", "1,2\n");
  write("good.asc", "ncols 1\nnrows 1\nxllcorner 0\nyllcorner 0\ncellsize 10\n1\n");
  write_png(folder_ / "wide.png", 100000, 1, {}, [](int, int, int) { return 1; });
  const std::string file = "mine.textproto:3:17: target.maps[0].file: ",
                    here = folder_.string() + "/";
  const std::vector<std::pair<std::string, std::string>> mistakes = {
      {map_of("none.png"),
       file + here + "none.png: there is no such file (check the name; it counts"},
      {map_of("zero.csv"), file + here + "zero.csv has no number above 0 ("},
      {map_of("negative.csv"), file + here + "negative.csv, line 2: -4 is negative"},
      {map_of("ragged.csv"), file + here + "ragged.csv, line 2 has 1 numbers"},
      {map_of("wide.png"), file + here + "wide.png has 100000 columns and 1 rows"},
      {map_of("good.bmp"), "target.maps[0].file: " + here +
                               "good.bmp does not end in .png, .pgm, .csv, .asc, .tif or .yaml"},
      {map_of(""), "target.maps[0].file: is missing"},
      {map_of("good.csv", "origin_x_m: 0 origin_y_m: 0 size_x_m: 1"),
       "mine.textproto:3:10: target.maps[0].size_y_m: is missing (say where the map lies"},
      {map_of("good.csv", "origin_x_m: 0 origin_y_m: 0 size_x_m: 1 size_y_m: -2"),
       "target.maps[0].size_y_m: -2 is below the limit 0.001"},
      {map_of("good.csv", std::string(kWhole) + "weight: 0"),
       "target.maps[0].weight: 0 is not above 0"},
      {map_of("good.csv", "origin_x_m: 200 origin_y_m: 0 size_x_m: 9 size_y_m: 9"),
       "mine.textproto:3:10: target.maps[0]: nothing of it is left inside the domain: its extent "
       "is x 200 "
       "to 209 m, y 0 to 9 m, the domain x 0 to 100 m, y 0 to 50 m (move its extent over the "
       "domain)"},
      {map_of("good.asc", "size_x_m: 5"),
       "target.maps[0].size_x_m: this kind of map states its own extent"},
      {map_of("good.asc", "first_row: SOUTH"),
       "target.maps[0].first_row: this kind of map always begins"},
  };
  for (const auto& [target, expected] : mistakes) {
    const std::string printed = problem_of(target);
    EXPECT_TRUE(has(printed, expected));
    EXPECT_EQ(std::count(printed.begin(), printed.end(), '\n'), 1) << printed;
  }
}

TEST_F(MapTarget, TwoThatCannotBeUsedAreTwoProblemsBesideOthers) {
  std::string text = small_with("uniform_weight: 1", map_of("a.csv") + "\n" + map_of("b.csv"));
  text.replace(text.find("u_max_mps: 5"), 12, "u_max_mps: 0");
  EXPECT_EQ(problems_of(text).size(), 3u) << joined(problems_of(text));
}

constexpr const char* kTriangle =
    "vertices { x_m: 10 y_m: 10 } vertices { x_m: 20 y_m: 10 } vertices { x_m: 15 y_m: 30 }";

TEST(PolygonProblems, AreOneEachAtTheirField) {
  const std::string triangle = kTriangle;
  const std::vector<std::pair<std::string, std::string>> mistakes = {
      {"regions { }", "f:3:10: target.regions[0].polygon: 0 vertices enclose nothing"},
      {"regions { polygon { vertices { x_m: 1 } " + triangle + " } }",
       "f:3:30: target.regions[0].polygon.vertices[0].y_m: is missing"},
      {"regions { polygon { " + triangle + " holes { vertices { x_m: 1 y_m: 1 } } } }",
       "target.regions[0].polygon.holes[0]: 1 vertices enclose nothing"},
      {"regions { weight: -1 polygon { " + triangle + " } }",
       "target.regions[0].weight: -1 is not above 0"},
      {"uniform_weight: 1 keep_outs { " + triangle + " vertices { x_m: 10 y_m: 10 } }",
       "f:3:28: target.keep_outs[0]: vertices[3] and vertices[0] are the same (leave out the last"},
      {"uniform_weight: 1 keep_outs { vertices { x_m: 0 y_m: 0 } vertices { x_m: 9 y_m: 9 } "
       "vertices { x_m: 9 y_m: 0 } vertices { x_m: 0 y_m: 9 } }",
       "target.keep_outs[0]: the edges that begin at vertices[0] and vertices[2] cross or touch"},
      {"keep_outs { " + triangle + " }", "target: there is nothing to cover"},
      {"uniform_weight: 1 keep_outs { vertices { x_m: -1 y_m: -1 } vertices { x_m: 300 y_m: -1 } "
       "vertices { x_m: -1 y_m: 300 } }",
       "target: only 0 of its weight is inside the domain and outside the keep-outs"},
      {"uniform_weight: 1 regions { polygon { " + triangle +
           " } } keep_outs { vertices { x_m: 5 y_m: 5 } "
           "vertices { x_m: 25 y_m: 5 } vertices { x_m: 25 y_m: 45 } vertices { x_m: 5 y_m: 45 } }",
       "target.regions[0]: nothing of it is left inside the domain and outside the keep-outs"},
  };
  for (const auto& [target, expected] : mistakes) {
    const std::vector<Problem> problems = problems_of(small_with("uniform_weight: 1", target));
    EXPECT_EQ(problems.size(), 1u) << joined(problems);
    EXPECT_TRUE(has(joined(problems), expected));
  }
}

TEST(PolygonProblems, LimitsOfCountsAreNamed) {
  const auto printed = [](const std::string& part, int count) {
    std::string target = "uniform_weight: 1 ";
    for (int i = 0; i < count; ++i) target += part;
    return joined(problems_of(small_with("uniform_weight: 1", target)));
  };
  const std::string triangle = kTriangle;
  EXPECT_TRUE(has(printed("regions { polygon { " + triangle + " } } ", 65),
                  "65 regions are above the limit 64"));
  EXPECT_TRUE(
      has(printed("keep_outs { " + triangle + " } ", 65), "65 keep-outs are above the limit 64"));
  EXPECT_TRUE(has(printed("maps { file: \"a.asc\" } ", 17), "17 maps are above the limit 16"));
  std::string vertices;
  for (int i = 0; i < 4097; ++i) vertices += "vertices { x_m: 1 y_m: 1 } ";
  EXPECT_TRUE(
      has(printed("keep_outs { " + vertices + " } ", 1), "4097 vertices are above the limit 4096"));
}

TEST(PolygonTarget, PrintsWhatReadsBack) {
  const std::string triangle = kTriangle;
  const Scenario scenario = good(small_with(
      "uniform_weight: 1",
      "uniform_weight: 1 keep_outs { " + triangle +
          " } regions { weight: 2 polygon { "
          "vertices { x_m: 5 y_m: 5 } vertices { x_m: 90 y_m: 5 } vertices { x_m: 50 y_m: 45 } "
          "holes { vertices { x_m: 45 y_m: 10 } vertices { x_m: 55 y_m: 10 } vertices { x_m: 50 "
          "y_m: 20 } } } }"));
  EXPECT_EQ(plan_of(good(scenario.print())), plan_of(scenario));
  EXPECT_TRUE(has(scenario.print(), "vertices { x_m: 45 y_m: 10 }\n"));
}

}  // namespace
}  // namespace ergocast
