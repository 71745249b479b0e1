// SPDX-License-Identifier: BSD-3-Clause
// Regions and keep-outs from GeoJSON: the same target as vertices in metres give, and an error with
// file, member, field and remedy for everything else.
#include <gtest/gtest.h>

#include <fstream>
#include <numbers>

#include "scenario/origin.h"
#include "target/geo/geojson.h"
#include "target/geo/local_plane.h"
#include "tests/scenario/scenarios.h"
#include "tests/support/temp_folder.h"

namespace ergocast {
namespace {

using namespace test;
namespace fs = std::filesystem;

const GeoPlace kOrigin{47.5, 9.2};

std::string position(const Eigen::Vector2d& x_m) {
  const GeoPlace place = LocalPlane(kOrigin).to_place(x_m);
  char text[80];
  std::snprintf(text, sizeof text, "[%.15g,%.15g]", place.longitude_deg, place.latitude_deg);
  return text;
}
std::string ring(const std::vector<Eigen::Vector2d>& corners) {
  std::string text = "[";
  for (const Eigen::Vector2d& corner : corners) text += position(corner) + ",";
  return text + position(corners.front()) + "]";
}
std::string box_ring(double x, double y, double size) {
  return ring({{x, y}, {x + size, y}, {x + size, y + size}, {x, y + size}});
}
std::string vertices(double x, double y, double size) {
  std::string text;
  for (const Eigen::Vector2d& corner :
       {Eigen::Vector2d(x, y), Eigen::Vector2d(x + size, y), Eigen::Vector2d(x + size, y + size),
        Eigen::Vector2d(x, y + size)}) {
    text += "vertices { x_m: " + std::to_string(corner.x()) +
            " y_m: " + std::to_string(corner.y()) + " } ";
  }
  return text;
}
std::string polygon(const std::string& rings) {
  return R"({"type":"Polygon","coordinates":[)" + rings + "]}";
}
std::string collection(const std::vector<std::string>& geometries) {
  std::string text = R"({"type":"FeatureCollection","features":[)";
  for (const std::string& geometry : geometries) {
    text += (text.back() == '[' ? "" : ",") +
            std::string(R"({"type":"Feature","properties":{},"geometry":)") + geometry + "}";
  }
  return text + "]}";
}

constexpr const char* kWhere = "origin { latitude_deg: 47.5 longitude_deg: 9.2 }";

class GeoJsonTarget : public ::testing::Test {
 protected:
  Loaded load(const std::string& target, const std::string& geojson,
              const std::string& where = kWhere) {
    std::ofstream(folder_ / "a.geojson") << geojson;
    std::ofstream(folder_ / "mine.textproto") << where << small_with("uniform_weight: 1", target);
    return Scenario::load(folder_ / "mine.textproto");
  }
  std::string problem_of(const std::string& geojson, const std::string& where = kWhere,
                         const std::string& target = kRegion) {
    const Loaded result = load(target, geojson, where);
    return result ? "" : joined(result.error());
  }
  void expect(const std::string& geojson, const std::string& what) {
    const std::string printed = problem_of(geojson);
    EXPECT_TRUE(has(printed, "mine.textproto:3:")) << "of the field";
    EXPECT_TRUE(has(printed, "target.regions[0].polygon.file: " + (folder_ / "a.geojson").string() +
                                 ": " + what));
    EXPECT_EQ(std::count(printed.begin(), printed.end(), '\n'), 1) << printed;
  }

  static constexpr const char* kRegion = "regions { polygon { file: \"a.geojson\" } }";
  const TempFolder own_;
  const fs::path& folder_ = own_.path();
};

TEST(LocalPlane, IsTrueAtItsOriginAndComesBackEverywhere) {
  for (const GeoPlace& origin :
       {kOrigin, GeoPlace{-33.9, 179.99}, GeoPlace{89.9, -120}, GeoPlace{0, 0}}) {
    const LocalPlane plane(origin);
    EXPECT_LE(plane.to_local_m(origin).norm(), 1e-6);
    for (const Eigen::Vector2d& x_m :
         {Eigen::Vector2d(1000, 0), Eigen::Vector2d(-3e5, 4e5), Eigen::Vector2d(0, -9e5)}) {
      const GeoPlace place = plane.to_place(x_m);
      EXPECT_LE(std::abs(place.longitude_deg), 180);
      EXPECT_LE((plane.to_local_m(place) - x_m).norm(), 1e-6 * x_m.norm());
    }
  }
}

TEST(LocalPlane, MeasuresTheEllipsoid) {
  // A degree of the meridian at 47.5°, and of the parallel, from the radii of curvature of WGS 84.
  const double a = 6378137, e2 = 0.00669437999014, rad = std::numbers::pi / 180;
  const double sine = std::sin(47.5 * rad), root = std::sqrt(1 - e2 * sine * sine);
  const LocalPlane plane(kOrigin);
  const double north = plane.to_local_m({47.501, 9.2}).y(),
               east = plane.to_local_m({47.5, 9.201}).x();
  EXPECT_NEAR(north, 0.001 * rad * a * (1 - e2) / (root * root * root), 1e-3);
  EXPECT_NEAR(east, 0.001 * rad * a / root * std::cos(47.5 * rad), 1e-4);
}

TEST_F(GeoJsonTarget, GivesTheCoefficientsOfTheSamePolygonsInMetres) {
  const std::string both = collection(
      {polygon(box_ring(10, 10, 30) + "," + box_ring(20, 20, 10)), polygon(box_ring(60, 5, 20))});
  const Scenario read = good(load("regions { weight: 3 polygon { file: \"a.geojson\" } }", both));
  // 900 − 100 and 400 m²: two thirds and one third of the weight.
  const Scenario written = good(load(
      "regions { weight: 2 polygon { " + vertices(10, 10, 30) + "holes { " + vertices(20, 20, 10) +
          "} } } regions { weight: 1 polygon { " + vertices(60, 5, 20) + "} }",
      both));
  EXPECT_LE((read.mission().target_coefficients - written.mission().target_coefficients)
                .cwiseAbs()
                .maxCoeff(),
            1e-9);
  // The record does not need the file any more.
  fs::remove(folder_ / "a.geojson");
  const Scenario again = good(Scenario::parse(read.print(), "again.textproto"));
  EXPECT_EQ(encode_plan(again.mission()), encode_plan(read.mission()));
  EXPECT_EQ(read.map_files(), std::vector<fs::path>{folder_ / "a.geojson"});
}

TEST_F(GeoJsonTarget, CutsKeepOutsFromAnyKindOfFile) {
  const std::string target = "uniform_weight: 1 keep_outs { file: \"a.geojson\" }";
  const auto mu = [&](const Loaded& loaded) { return good(loaded).mission().target_coefficients; };
  const Coefficients wanted =
      mu(load("uniform_weight: 1 keep_outs { " + vertices(60, 5, 20) + " }", ""));
  // Heights, a part far from the domain, and every form of a polygon.
  const std::string far = box_ring(900, 5, 20);
  for (const std::string& text :
       {polygon(box_ring(60, 5, 20)), collection({polygon(far), polygon(box_ring(60, 5, 20))}),
        R"({"type":"MultiPolygon","coordinates":[[)" + far + "],[" + box_ring(60, 5, 20) + "]]}",
        R"({"type":"Feature","geometry":)" + polygon(box_ring(60, 5, 20)) + "}"}) {
    EXPECT_LE((mu(load(target, text)) - wanted).cwiseAbs().maxCoeff(), 1e-9) << text;
  }
}

TEST_F(GeoJsonTarget, RefusesWhatIsNoPolygonWithItsMember) {
  expect("{", "line 1, column 2: is no JSON: ");
  expect("[1]",
         "is no GeoJSON object with a type (keep features of the types Polygon and MultiPolygon)");
  expect(R"({"type":"FeatureCollection","features":[]})", "has no polygon (draw one");
  expect(R"({"type":"FeatureCollection"})", "has no list \"features\"");
  expect(collection({polygon(box_ring(10, 10, 30)), R"({"type":"LineString","coordinates":[]})"}),
         "features[1].geometry: has the type LineString, which is no polygon");
  expect(collection({polygon("[[9,47],[9,48],[10,48]]")}),
         "features[0].geometry.coordinates[0]: has fewer than four positions");
  expect(collection({polygon("[[9,47],[9,48],[10,48],[9,47.1]]")}),
         "features[0].geometry.coordinates[0]: is not closed (repeat its first position");
  expect(collection({polygon("[[9,47],[9],[10,48],[9,47]]")}),
         "features[0].geometry.coordinates[0][1]: is no position (write [longitude, latitude])");
  expect(collection({polygon("[[9,47],[9,98],[10,48],[9,47]]")}),
         "features[0].geometry.coordinates[0][1]: latitude 98 is outside -90 to 90");
  expect(collection({polygon("[[9,47],[189,8],[10,48],[9,47]]")}),
         "features[0].geometry.coordinates[0][1]: longitude 189 is outside -180 to 180");
  // Latitude and longitude in the wrong order.
  expect(collection({polygon("[[47,9],[48,9],[48,10],[47,9]]")}),
         "features[0].geometry: [47, 9] is more than 1000 km from the origin (write longitude");
  expect(collection({polygon(ring({{10, 10}, {40, 40}, {40, 10}, {10, 40}}))}),
         "features[0].geometry: ring 0: ");
  expect(collection({polygon(box_ring(10, 10, 30) + "," + box_ring(90, 10, 5))}),
         "features[0].geometry: ring 1: ");
  expect(collection({polygon(box_ring(200, 10, 30))}), "none of its polygons meets the domain");
  expect(R"({"type":"Polygon","crs":{"properties":{"name":"EPSG:2056"}},"coordinates":[]})",
         "crs: is another reference system than WGS 84 (convert it: ogr2ogr");
  std::string many = "[";
  for (int i = 0; i < 5000; ++i) many += position({0.001 * i, 1}) + ",";
  expect(collection({polygon(many + position({0, 1}) + "]")}),
         "has 5000 vertices, above the limit 4096 (simplify it: ogr2ogr -simplify");
}

// Each bracket would take a hundred bytes. tests/process/commands/bad_input_test.cc has larger
// ones.
TEST_F(GeoJsonTarget, RefusesWhatIsNestedDeeperThanAnyPolygon) {
  expect(std::string(1000, '['), "is nested in more than 64 levels (simplify it");
}

TEST_F(GeoJsonTarget, NeedsAnOriginThatIsAPlace) {
  const std::string text = collection({polygon(box_ring(10, 10, 30))});
  EXPECT_EQ(problem_of(text), "");
  EXPECT_TRUE(has(problem_of(text, ""),
                  "target.regions[0].polygon.file: needs to know where on the earth the scenario "
                  "lies (add origin { latitude_deg: … longitude_deg: … }"));
  EXPECT_TRUE(has(problem_of(text, "origin { latitude_deg: 97.5 longitude_deg: 9.2 }"),
                  "origin.latitude_deg: 97.5 is above the limit 90"));
  EXPECT_TRUE(
      has(problem_of(text, "origin { latitude_deg: 47.5 }"), "origin.longitude_deg: is missing"));
  EXPECT_TRUE(
      has(problem_of(text, kWhere,
                     "regions { polygon { file: \"a.geojson\" " + vertices(1, 1, 5) + "} }"),
          "stands beside vertices or holes (keep one of them)"));
  EXPECT_TRUE(has(problem_of(text, kWhere, "regions { polygon { file: \"b.geojson\" } }"),
                  "b.geojson: there is no such file (check the name"));
}

TEST_F(GeoJsonTarget, AProblemOfALaterPolygonNamesItsMember) {
  const std::string text =
      collection({polygon(box_ring(10, 10, 10)), polygon(box_ring(60, 10, 10))});
  EXPECT_TRUE(has(
      problem_of(text, kWhere, std::string(kRegion) + " keep_outs { " + vertices(55, 5, 30) + " }"),
      (folder_ / "a.geojson").string() + ": features[1].geometry: nothing of it is left"));
}

TEST_F(GeoJsonTarget, TheOriginOfARecordIsReadByItself) {
  load(kRegion, collection({polygon(box_ring(10, 10, 30))}));
  const auto origin = read_origin(folder_ / "mine.textproto").value();
  ASSERT_TRUE(origin.has_value());
  EXPECT_EQ(origin->latitude_deg, 47.5);
  EXPECT_EQ(origin->longitude_deg, 9.2);
  load(kRegion, "", "");
  EXPECT_FALSE(read_origin(folder_ / "mine.textproto").value().has_value());
  load(kRegion, "", "origin { latitude_deg: 91 longitude_deg: 0 }");
  EXPECT_TRUE(has(joined(read_origin(folder_ / "mine.textproto").error()), "above the limit 90"));
  EXPECT_TRUE(has(joined(read_origin(folder_ / "none").error()), "there is no such file"));
}

}  // namespace
}  // namespace ergocast
