// SPDX-License-Identifier: BSD-3-Clause
// KML, GeoPackages, shapefiles and GeoTIFF in any reference system: the target and the walls that
// the same shapes give in metres, or words that say why not.
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <sstream>

#include "core/motion/walls.h"
#include "target/geo/bounded_child.h"
#include "tests/scenario/scenarios.h"
#include "tests/support/geo_files.h"
#include "tests/support/temp_folder.h"

namespace ergocast {
namespace {

using namespace test;
using Places = std::vector<Eigen::Vector2d>;

/// The lower left corner of the files in UTM.
constexpr double kEast_m = 512330, kNorth_m = 5403720;
const std::string kUtmOrigin =
    "origin { latitude_deg: 48.786355813883276 longitude_deg: 9.167858251872108 }\n";

class Geodata : public ::testing::Test {
 protected:
  void write(const std::string& name, const std::string& content) const {
    std::ofstream(folder_.path() / name, std::ios::binary) << content;
  }
  Loaded load(const std::string& target, const std::string& more = kUtmOrigin) const {
    write("mine.textproto", more + "domain { size_x_m: 40 size_y_m: 30 }\ntarget { " + target +
                                " }\nlaw { u_max_mps: 5 }\ntime { duration_s: 60 }\n"
                                "agents { starts { x_m: 1 y_m: 1 } }\n");
    return Scenario::load(folder_.path() / "mine.textproto");
  }
  Coefficients mu(const std::string& target) const {
    return good(load(target)).mission().target_coefficients;
  }
  std::string problems(const std::string& target) const { return problems_of(load(target)); }
  static std::string region(const std::string& file) {
    return "regions { polygon { file: \"" + file + "\" } }";
  }
  static std::string map(const std::string& file) { return "maps { file: \"" + file + "\" }"; }
  /// The plane is turned against UTM by 2 mrad, and 0.4 mm longer in each metre: that is 6 cm here.
  void expect_near(const Coefficients& one, const Coefficients& other) const {
    EXPECT_LE((one - other).cwiseAbs().maxCoeff(), 1e-2);
  }

  const TempFolder folder_;
};

std::string kml(const std::string& placemark) {
  return "<?xml version='1.0'?>\n<kml xmlns='http://www.opengis.net/kml/2.2'><Document>"
         "<name>Field</name><Style id='s'><LineStyle><width>2</width></LineStyle></Style>\n"
         "<Folder>" +
         placemark + "</Folder></Document></kml>";
}
std::string kml_polygon(const std::string& outline, const std::string& more = "") {
  return "<Placemark><name>Field</name><styleUrl>#s</styleUrl><Polygon><tessellate>1</tessellate>"
         "<outerBoundaryIs><LinearRing><coordinates>" +
         outline + "</coordinates></LinearRing></outerBoundaryIs>" + more +
         "</Polygon></Placemark>";
}

const std::string kFieldCorners =
    " 9.16799,48.78644,412.5\n 9.16826,48.78644,0 9.16826,48.78653,0\n 9.16799,48.78644,412.5 ";

TEST_F(Geodata, KmlIsTheSameAsGeoJson) {
  write("a.geojson", R"({"type":"Polygon","coordinates":[[[9.16799,48.78644],[9.16826,48.78644],)"
                     R"([9.16826,48.78653],[9.16799,48.78644]]]})");
  const Coefficients plain = mu(region("a.geojson"));
  write("a.kml", kml(kml_polygon(kFieldCorners)));
  EXPECT_EQ(mu(region("a.kml")), plain);
  write("a.kml", kml("<k:Placemark xmlns:k='http://www.opengis.net/kml/2.2'><k:MultiGeometry>"
                     "<k:Polygon><k:outerBoundaryIs><k:LinearRing><k:coordinates>9.16799,48.78644 "
                     "9.16826,48.78644 9.16826,48.78653</k:coordinates></k:LinearRing>"
                     "</k:outerBoundaryIs></k:Polygon></k:MultiGeometry></k:Placemark>"));
  EXPECT_EQ(mu(region("a.kml")), plain);
  write("a.kml", kml(kml_polygon(kFieldCorners,
                                 "<innerBoundaryIs><LinearRing><coordinates>"
                                 "9.1682,48.78645 9.16822,48.78645 9.16822,48.78647"
                                 "</coordinates></LinearRing></innerBoundaryIs>")));
  EXPECT_NE(mu(region("a.kml")), plain);
}

TEST_F(Geodata, KmlThatCouldLoseAShapeIsRefused) {
  const std::string good = kml_polygon(kFieldCorners);
  for (const auto& [placemark, words] : std::vector<std::pair<std::string, std::string>>{
           {"<Placemark><Poligon/></Placemark>", "line 5: <Poligon>: is no polygon"},
           {"<Placemark><Point/></Placemark>", "line 5: <Point>: is no polygon (delete it there"},
           {"<Placemark><name>a</name></Placemark>", "line 5: <Placemark>: has no polygon"},
           {"<NetworkLink/>", "<NetworkLink>: is no polygon"},
           {kml_polygon(kFieldCorners, "<innerBoundary/>"),
            "<innerBoundary>: is no part of a polygon"},
           {kml_polygon("9.168,48,786 9.169,48,786 9.169,48,787,0"),
            "<coordinates>: has no place at \"9.169,48,787,0\""},
           {kml_polygon("9.168,abc 9.169,48.7"), "has no place at \"9.168,abc\""},
           {kml_polygon("9.168, 48.7"), "has no place at \"9.168,\""},
           {kml_polygon("48.7,99.1 48.8,99.1"), "is nowhere on the earth at \"48.7,99.1\""},
           {kml_polygon("9.168,48.7 9.169,48.7"), "has fewer than three places"},
           {kml_polygon("48.786,9.167 48.787,9.167 48.787,9.168"),
            "is more than 1000 km from the origin"},
       }) {
    write("a.kml", kml(good + placemark));
    EXPECT_TRUE(has(problems(region("a.kml")), words)) << placemark;
  }
  write("a.kml", kml("<Placemark><Point/></Placemark><ScreenOverlay/>" + good));
  EXPECT_TRUE(has(problems(region("a.kml")), "line 3: <Point>: is no polygon"));
  EXPECT_TRUE(has(problems(region("a.kml")), "line 3: <ScreenOverlay>: is no polygon"));
  write("a.kml", kml(""));
  EXPECT_TRUE(has(problems(region("a.kml")), "line 2: <kml>: has no polygon"));
  write("a.kml", "PK\3\4");
  EXPECT_TRUE(has(problems(region("a.kml")), "is a KMZ archive"));
  write("a.kml", "<OGRVRTDataSource><OGRVRTLayer name='a'/></OGRVRTDataSource>");
  EXPECT_TRUE(has(problems(region("a.kml")), "<OGRVRTDataSource>: is no KML"));
}

TEST_F(Geodata, PolygonsInUtmAreWhereTheyAre) {
  const Coefficients plain =
      mu("regions { polygon { vertices { x_m: 10 y_m: 10 } vertices { x_m: 30 y_m: 10 } vertices { "
         "x_m: 30 y_m: 20 } vertices { x_m: 10 y_m: 20 } } }");
  Places box;
  for (const auto& [x, y] : {std::pair(10, 10), std::pair(10, 20), std::pair(30, 20),
                             std::pair(30, 10), std::pair(10, 10)})
    box.emplace_back(kEast_m + x, kNorth_m + y);
  write_shapefile(folder_.path() / "a.shp", box);
  expect_near(mu(region("a.shp")), plain);
  const auto source = std::filesystem::path(ERGOCAST_SCENARIO_DIR).parent_path();
  std::filesystem::copy(source / "tests/scenario/utm_field.gpkg", folder_.path() / "a.gpkg");
  expect_near(mu(region("a.gpkg")), plain);
  const Loaded walled =
      load("uniform_weight: 1 } world { speed_limit_mps: 100 walls { file: \"a.gpkg\" }");
  ASSERT_TRUE(walled) << joined(walled.error());
  EXPECT_TRUE(solid_at(walled->mission().walls, {29.8, 15}));
  EXPECT_FALSE(solid_at(walled->mission().walls, {30.2, 15}));
}

TEST_F(Geodata, LayersThatCouldLoseAShapeAreRefused) {
  const Places box = {{kEast_m, kNorth_m},
                      {kEast_m, kNorth_m + 9},
                      {kEast_m + 9, kNorth_m + 9},
                      {kEast_m, kNorth_m}};
  write_shapefile(folder_.path() / "a.shp", box, 5, false);
  EXPECT_TRUE(has(problems(region("a.shp")), "layer a: does not say where on the earth it lies"));
  write("a.prj", "LOCAL_CS[\"lab\",UNIT[\"metre\",1]]");
  EXPECT_TRUE(
      has(problems(region("a.shp")),
          "layer a: is in a local system, which has no place on the earth (write vertices"));
  write_shapefile(folder_.path() / "a.shp", box, 3);
  EXPECT_TRUE(has(problems(region("a.shp")), "layer a, feature 0: is a LINESTRING, not a polygon"));
  write_shapefile(folder_.path() / "a.shp", {});
  EXPECT_TRUE(has(problems(region("a.shp")), "layer a, feature 0: has no geometry"));
  write_shapefile(folder_.path() / "a.shp", {{1e9, 1e9}, {1e9, 2e9}, {2e9, 2e9}, {1e9, 1e9}});
  EXPECT_TRUE(has(problems(region("a.shp")), "a place that is nowhere on the earth"));
  write_shapefile(folder_.path() / "a.shp", {}, 5, true, 2);
  EXPECT_TRUE(has(problems(region("a.shp")), "layer a, feature 1: has no geometry"));
  EXPECT_TRUE(has(problems(region("a.shp")), "layer a, feature 0: has no geometry"));
  // The second one ends early.
  write_shapefile(folder_.path() / "a.shp", box, 5, true, 2);
  std::filesystem::resize_file(folder_.path() / "a.shp", 300);
  EXPECT_TRUE(has(problems(region("a.shp")), "layer a, feature 1: has no geometry"));
  write("a.gpkg", "<OGRVRTDataSource><OGRVRTLayer name='a'/></OGRVRTDataSource>");
  EXPECT_TRUE(has(problems(region("a.gpkg")), "a.gpkg: cannot be opened: "));
  EXPECT_TRUE(has(problems(region("none.gpkg")), "none.gpkg: "));
}

/// More in the north-east; no data along the west.
TinyTiff slope() {
  TinyTiff tiff;
  for (int row = 0; row < tiff.rows; ++row)
    for (int column = 0; column < tiff.columns; ++column)
      tiff.values.push_back(column < 5 ? -9999.F : static_cast<float>(column + 60 - 2 * row));
  return tiff;
}

TEST_F(Geodata, GeoTiffInUtmIsTheSameAsAGridInMetres) {
  const TinyTiff tiff = slope();
  std::string grid = "ncols 40\nnrows 30\nxllcorner 0\nyllcorner 0\ncellsize 1\n";
  for (const float value : tiff.values) grid += std::to_string(value) + ' ';
  write("a.asc", grid);
  const Coefficients plain = mu(map("a.asc"));
  write("a.tif", tiff.bytes());
  expect_near(mu(map("a.tif")), plain);
  TinyTiff packed = tiff;
  packed.metadata =
      "<GDALMetadata><Item name='SCALE' sample='0' role='scale'>0.25</Item>"
      "<Item name='OFFSET' sample='0' role='offset'>-10</Item></GDALMetadata>";
  for (float& value : packed.values)
    if (value >= 0) value = 4 * (value + 10);
  write("c.tif", packed.bytes());
  expect_near(mu(map("c.tif")), plain);
  TinyTiff moved = tiff;  // half of it is outside the domain
  moved.upper_left_m.x() -= 20;
  write("b.tif", moved.bytes());
  write("b.asc", grid.replace(grid.find("xllcorner 0"), 11, "xllcorner -20"));
  expect_near(mu(map("b.tif")), mu(map("b.asc")));
  EXPECT_GE((mu(map("b.tif")) - plain).cwiseAbs().maxCoeff(), 0.05);
}

// EPSG:4326 names the latitude first, and files have the longitude first.
TEST_F(Geodata, GeoTiffInDegreesIsWhereItIs) {
  constexpr double kCell_deg = 1e-5, kWest_deg = 9.1679, kSouth_deg = 48.7864;
  TinyTiff tiff;
  tiff.columns = 20, tiff.rows = 10;
  tiff.values.assign(200, 1);
  tiff.cell_m = kCell_deg;
  tiff.upper_left_m = {kWest_deg, kSouth_deg + 10 * kCell_deg};
  tiff.system = 4326;
  tiff.in_degrees = true;
  write("a.tif", tiff.bytes());
  std::ostringstream corners;
  corners.precision(12);
  for (const auto& [x, y] :
       {std::pair(0, 0), std::pair(20, 0), std::pair(20, 10), std::pair(0, 10), std::pair(0, 0)})
    corners << kWest_deg + x * kCell_deg << ',' << kSouth_deg + y * kCell_deg << ' ';
  write("a.kml", kml(kml_polygon(corners.str())));
  EXPECT_LE((mu(map("a.tif")) - mu(region("a.kml"))).cwiseAbs().maxCoeff(), 0.05);
}

TEST_F(Geodata, GeoTiffThatIsNoDensityHereIsRefused) {
  const auto said = [&](const TinyTiff& tiff) {
    write("a.tif", tiff.bytes());
    return problems(map("a.tif"));
  };
  const auto with = [](void (*change)(TinyTiff&)) {
    TinyTiff tiff = slope();
    change(tiff);
    return tiff;
  };
  EXPECT_TRUE(has(said(with([](TinyTiff& t) { t.no_data = ""; })),
                  "a.tif, column 0, row 0: -9999 is no density"));
  EXPECT_TRUE(has(said(with([](TinyTiff& t) { t.system = 0; })),
                  "does not say where on the earth it lies"));
  EXPECT_TRUE(has(said(with([](TinyTiff& t) { t.system = kLocal; })),
                  "is in a local system, which has no place on the earth (write it as a grid"));
  EXPECT_TRUE(has(said(with([](TinyTiff& t) { t.bands = 2; })), "has 2 bands"));
  EXPECT_TRUE(has(said(with([](TinyTiff& t) { t.upper_left_m.x() += 9000; })),
                  "has no cell in the domain"));
  EXPECT_TRUE(has(said(with([](TinyTiff& t) { t.cell_m = 0.001; })),
                  "cells along a side of the domain, above the limit 4096"));
  write("a.tif", slope().bytes().substr(0, 3000));
  EXPECT_TRUE(has(problems(map("a.tif")), "a.tif is broken: "));
  write("a.tif", "<VRTDataset rasterXSize='1' rasterYSize='1'></VRTDataset>");
  EXPECT_TRUE(has(problems(map("a.tif")), "a.tif is no GeoTIFF: "));
  const Loaded nowhere = load(map("a.tif"), "");
  ASSERT_FALSE(nowhere);
  EXPECT_TRUE(has(joined(nowhere.error()), "needs to know where on the earth the scenario lies"));
}

// A library may fail in any way: the program goes on, and says so.
TEST(BoundedChild, AnswersOrFails) {
  EXPECT_EQ(in_bounded_child(100, [] { return std::string(100, 'a'); }), std::string(100, 'a'));
  EXPECT_EQ(in_bounded_child(99, [] { return std::string(100, 'a'); }), std::nullopt);
  EXPECT_EQ(in_bounded_child(100, []() -> std::string { std::abort(); }), std::nullopt);
  EXPECT_EQ(in_bounded_child(100, []() -> std::string { throw std::bad_alloc(); }), std::nullopt);
  // An exception must not go on in a second copy of the program, which here would end well.
  const pid_t self = getpid();
  try {
    EXPECT_EQ(in_bounded_child(100, []() -> std::string { throw std::runtime_error("a"); }),
              std::nullopt);
  } catch (const std::runtime_error&) {
    if (getpid() != self) _exit(0);
    throw;
  }
}

}  // namespace
}  // namespace ergocast
