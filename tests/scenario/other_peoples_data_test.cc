// SPDX-License-Identifier: BSD-3-Clause
// Tables, geodata and grids as spreadsheets, maps and models write them: targets where their
// authors see them, or words that say why not.
#include <gtest/gtest.h>

#include <fstream>

#include "tests/scenario/scenarios.h"
#include "tests/scenario/water_column.h"
#include "tests/support/temp_folder.h"

namespace ergocast {
namespace {

using namespace test;

class OtherPeoplesData : public ::testing::Test {
 protected:
  void write(const std::string& name, const std::string& content) const {
    std::ofstream(folder_.path() / name, std::ios::binary) << content;
  }
  Loaded of_target(const std::string& target) const {
    write("mine.textproto", small_with("uniform_weight: 1", target));
    return Scenario::load(folder_.path() / "mine.textproto");
  }
  Coefficients mu(const std::string& target) const {
    return good(of_target(target)).mission().target_coefficients;
  }
  std::string problems(const std::string& target) const { return problems_of(of_target(target)); }

  const TempFolder folder_;
};

TEST_F(OtherPeoplesData, TablesAreReadOrNamed) {
  const std::string at = " origin_x_m: 0 origin_y_m: 0 size_x_m: 100 size_y_m: 50 }";
  const auto table = [&](const std::string& content) {
    write("a.csv", content);
    return "maps { file: \"a.csv\"" + at;
  };
  const Coefficients plain = mu(table("1,2\n3,4\n"));
  EXPECT_EQ(mu(table("1, 2\r\n3, 4\r\n\r\n")), plain);
  EXPECT_TRUE(has(problems(table("1;2\n3;4\n")), "line 1: semicolons separate the numbers"));
  for (const char* blank : {"\t", " "})
    EXPECT_TRUE(has(problems(table("1" + std::string(blank) + "2\n")),
                    "line 1: blanks or tabs separate the numbers (write commas: tr"));
  for (const auto& [begin, is] : std::vector<std::pair<std::string, std::string>>{
           {"\x89PNG", "a PNG picture (let its name end in .png)"},
           {"II*", "a TIFF picture (let its name end in .tif)"},
           {"\xff\xd8\xff", "a JPEG picture (convert in.jpg"},
           {"PK\3\4", "a ZIP archive, such as a spreadsheet (save the table as CSV)"},
           {"CDF", "a NetCDF or HDF5 file (write voxels {"},
           {"\x89HDF", "a NetCDF or HDF5 file (write voxels {"},
           {"SQLite format 3", "a document or a database, not a map"},
           {"<html>", "a document or a database, not a map"},
           {"{}", "a document or a database, not a map"},
           {std::string("1\0,\0", 4), "in UTF-16"}})
    EXPECT_TRUE(has(problems(table(begin + "\n")), "a.csv is " + is));
  EXPECT_TRUE(has(problems(table("1,2,\n3,4,\n")), "every line ends in a comma"));
  EXPECT_TRUE(has(problems(table("1,2, \n3,4,\t\r\n")), "every line ends in a comma"));
  EXPECT_EQ(mu(table("1,\n3,4\n")), mu(table("1,0\n3,4\n")));
  EXPECT_TRUE(has(problems(table("\xef\xbb\xbf"
                                 "1,2\n3,4\n")),
                  "begins with a byte order mark"));
  EXPECT_TRUE(has(problems(table(std::string("\xff\xfe"
                                             "1\0,\0",
                                             6))),
                  "is in UTF-16"));
  const auto grid = [&](const std::string& content) {
    write("a.asc", "ncols 2\nnrows 1\nxllcorner 0\nyllcorner 0\n" + content);
    return std::string("maps { file: \"a.asc\" }");
  };
  const Coefficients square = mu(grid("cellsize 50\n1 2\n"));
  EXPECT_EQ(mu(grid("dx 50\ndy 50\n1 2\n")), square);
  EXPECT_TRUE(has(problems(grid("dx 50\ndy 25\n1 2\n")), "its cells are not square"));
  const Coefficients west = mu(grid("cellsize 50\n1 0\n"));
  EXPECT_EQ(mu(grid("cellsize 50\nnodata_value 3.4028234663852886e+38\n1 3.40282347e+38\n")), west);
}

TEST_F(OtherPeoplesData, AllProblemsOfATableAreNamedAtOnce) {
  write("a.csv", "1,a\n3,4\nb,-6\n");
  const std::string rows = problems(
      "maps { file: \"a.csv\" origin_x_m: 0 origin_y_m: 0 "
      "size_x_m: 100 size_y_m: 50 }");
  EXPECT_TRUE(has(rows, "a.csv, line 1: a is not a number"));
  EXPECT_TRUE(has(rows, "a.csv, line 3: b is not a number"));
  write("a.asc", "ncols 1\nnrows 3\nxllcorner 0\nyllcorner 0\ncellsize 9\n1\n-2\n0x\n");
  const std::string cells = problems("maps { file: \"a.asc\" }");
  EXPECT_TRUE(has(cells, "a.asc, line 7: -2 is negative"));
  EXPECT_TRUE(has(cells, "a.asc, line 8: 0x is not a number"));
}

TEST_F(OtherPeoplesData, PlacesOnTheEarthAreReadOrNamed) {
  const auto region = [&](const std::string& content) {
    write("a.geojson", content);
    return "regions { polygon { file: \"a.geojson\" } } } "
           "origin { latitude_deg: 47.5 longitude_deg: 9.2";
  };
  const auto collection = [](const std::string& geometry, const std::string& more = "") {
    return R"({"type":"FeatureCollection","features":[)" + more +
           R"({"type":"Feature","properties":{},"geometry":)" + geometry + "}]}";
  };
  const std::string triangle =
      R"({"type":"Polygon","coordinates":[[[9.2005,47.5001],[9.2009,47.5001],[9.2009,47.5003],)";
  const std::string end = "[9.2005,47.5001]]]}";
  const Coefficients plain = mu(region(collection(triangle + end)));
  EXPECT_EQ(mu(region(collection(triangle + "[9.2009,47.5003]," + end))), plain);
  for (const char* empty : {"null", R"({"type":"Polygon","coordinates":[]})",
                            R"({"type":"MultiPolygon","coordinates":[]})"}) {
    const Scenario left = good(of_target(region(collection(
        triangle + end, R"({"type":"Feature","geometry":)" + std::string(empty) + "},"))));
    EXPECT_EQ(left.mission().target_coefficients, plain);
    EXPECT_TRUE(has(joined(left.warnings()), "has no place, and is left out (delete it there"));
  }
  const std::string empty = R"({"type":"Feature","geometry":null},)";
  EXPECT_TRUE(
      has(joined(good(of_target(region(collection(triangle + end, empty + empty)))).warnings()),
          "has no place, and is left out, with 1 more (delete it there"));
  EXPECT_TRUE(has(problems(region("\xff\xfe{")), "is in UTF-16, and GeoJSON is UTF-8"));
  const std::string comma = problems(region("{\"type\":[1,]}"));
  EXPECT_TRUE(has(comma, "a.geojson: line 1, column 12: is no JSON: "));
  EXPECT_TRUE(has(comma, "(remove the comma before it)"));
  EXPECT_TRUE(has(problems(region("{\xe2\x80\x9ctype\xe2\x80\x9d:1}")), "(write straight quotes)"));
  const std::string two = problems(region(collection(
      triangle + "[9.2006,47.5003]]]}", R"({"type":"Feature","geometry":{"type":"Point"}},)")));
  EXPECT_TRUE(has(two, "features[0].geometry: has the type Point, which is no polygon"));
  EXPECT_TRUE(has(two, "features[1].geometry.coordinates[0]: is not closed"));
  EXPECT_TRUE(has(problems(region("<?xml version=\"1.0\"?><kml/>")), "is XML such as KML"));
}

// Numbers outside the valid range, and those that no program wrote, are no part of the target.
TEST_F(OtherPeoplesData, GridsHaveTheNumbersThatTheirAttributesMean) {
  const auto of = [&](const WaterColumn& column) {
    column.write(folder_.path() / "column.nc");
    const Loaded loaded =
        Scenario::parse(water_column_scenario(), (folder_.path() / "c.textproto").string());
    return good(loaded).mission().target_coefficients;
  };
  const Coefficients plain = of({});
  using Change = void (*)(WaterColumn&);
  const auto land = [](WaterColumn& column, double value) {
    auto& chl = column.at("chl");
    chl.attributes.pop_back();  // _FillValue
    for (double& one : chl.values) one = one == -999 ? value : one;
  };
  // Limits of another type than the stored numbers are for the unpacked ones.
  for (const auto& [attribute, value, stored] :
       {std::tuple("valid_max", 90.0, 9999.0), std::tuple("valid_min", -0.05, -6.0),
        std::tuple("missing_value", 9999.0, 9999.0), std::tuple("", 0.0, -32767.0)}) {
    WaterColumn column;
    land(column, stored);
    if (*attribute != '\0') column.at("chl").attributes.emplace_back(attribute, value);
    EXPECT_LE((of(column) - plain).cwiseAbs().maxCoeff(), 1e-14) << attribute;
  }
  WaterColumn within;
  land(within, 9999);
  within.at("chl").attributes.emplace_back("valid_range", std::vector<double>{-0.05, 90});
  EXPECT_LE((of(within) - plain).cwiseAbs().maxCoeff(), 1e-14);
  WaterColumn wrong;
  land(wrong, 9999);
  EXPECT_NE(of(wrong), plain);
  for (const Change change : std::initializer_list<Change>{
           [](WaterColumn& c) { c.at("depth").attributes[1].second = "Down"; },
           [](WaterColumn& c) {
             c.at("depth").attributes.erase(c.at("depth").attributes.begin() + 1);
           },
       }) {
    WaterColumn column;
    change(column);
    EXPECT_LE((of(column) - plain).cwiseAbs().maxCoeff(), 1e-14);
  }
  WaterColumn shifted;  // 40000 is −25536 in 16 bits
  auto& chl = shifted.at("chl");
  chl.attributes = {
      {"_Unsigned", "true"}, {"scale_factor", 0.01}, {"add_offset", -400.0}, {"_FillValue", -1.0}};
  for (double& one : chl.values) one = one == -999 ? -1 : one + 40000 - 65536;
  EXPECT_LE((of(shifted) - plain).cwiseAbs().maxCoeff(), 1e-9);
  write("name.textproto", "name: \xe2\x80\x9cmine\xe2\x80\x9d\n");
  const Loaded curly = Scenario::load(folder_.path() / "name.textproto");
  ASSERT_FALSE(curly);
  EXPECT_TRUE(has(joined(curly.error()), "a character outside of quotes is not ASCII"));
}

}  // namespace
}  // namespace ergocast
