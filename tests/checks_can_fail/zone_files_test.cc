// SPDX-License-Identifier: BSD-3-Clause
// Each problem of the file of a zone, through a rehearsal. A zone of a running mission is read by
// the same functions.
#include "tests/checks_can_fail/expect_said.h"
#include "tests/process/support/programs.h"

namespace ergocast::test {
namespace {

class ZoneFilesCanFail : public OwnHost {
 protected:
  static std::string corner(int x_m, int y_m) {
    return "vertices { x_m: " + std::to_string(x_m) + " y_m: " + std::to_string(y_m) + " }\n";
  }
  /// Rehearses a zone in a plane of 2 km, and stores what is printed.
  void expect_problem(const std::string& name, const std::string& content,
                      const std::string& problem,
                      const std::string& scenario = "quadrimodal_corners") {
    write_file(folder_ / name, content);
    EXPECT_EQ(ergocast({"simulate", scenario, "--duration", "60", "--out", folder_ / "run",
                        "--amend", "30+10:" + (folder_ / name).string()}),
              2)
        << content;
    EXPECT_NE(output().find(problem), std::string::npos) << problem << ":\n" << output();
    EXPECT_NE(output().find(name), std::string::npos) << "the file is not named:\n" << output();
    said_.push_back(output());
  }

  const std::string square_ =
      corner(100, 100) + corner(400, 100) + corner(400, 400) + corner(100, 400);
  std::vector<std::string> said_;
};

TEST_F(ZoneFilesCanFail, InEachOfTheirProblems) {
  expect_problem("solid.textproto", square_ + "solid: true", "is not for zones");
  expect_problem(
      "hole.textproto",
      square_ + "holes { " + corner(200, 200) + corner(300, 200) + corner(300, 300) + "}",
      "a zone has no holes");
  expect_problem("two.textproto", square_ + "} keep_outs {" + square_, "the file has 2 polygons");
  std::string many;
  for (int i = 0; i < 33; ++i) many += corner(100 + 10 * i, 100) + corner(105 + 10 * i, 130);
  expect_problem("many.textproto", many + corner(400, 900), "has 67 corners, above the limit 64");
  std::string far = square_;
  for (auto at = far.find("00 "); at != far.npos; at = far.find("00 ", at + 5))
    far.replace(at, 3, "00000 ");
  expect_problem("far.textproto", far,
                 "far.textproto:1:12: vertices[0].x_m: 100000 is far outside the domain");
  expect_problem("crossing.textproto",
                 corner(100, 100) + corner(400, 400) + corner(400, 100) + corner(100, 400),
                 "cross");
  expect_problem("typo.textproto", "vertex { x_m: 1 }",
                 "unknown field \"vertex\" (a zone's text has vertices { x_m: … y_m: … }");
  expect_problem("nan.textproto", corner(100, 100) + "vertices { x_m: 9 y_m: nan }" + square_,
                 "nan.textproto:2:19: vertices[1].y_m: nan is not a number");
  expect_problem("twice.textproto", corner(100, 100) + corner(200, 100) + corner(200, 100),
                 "twice.textproto:3:1: vertices[2]: vertices[1] and vertices[2] are the same");
  expect_problem("line.textproto", corner(100, 100) + corner(200, 200) + corner(300, 300),
                 "all its vertices are on one line");
  expect_problem("empty.textproto", " \n", "empty.textproto: is empty");
  expect_problem("empty.geojson", "", "empty.geojson: is empty");
  expect_problem("whole.textproto", "target { keep_outs { " + square_ + "} }",
                 "is a scenario, and a zone is one polygon");
  expect_problem("table.csv", "100,100\n400,100\n400,400\n", "table.csv: is no polygon");
  expect_problem("place.geojson",
                 R"({"type":"Polygon","coordinates":[[[8,47],[8.001,47],[8,47.001],[8,47]]]})",
                 "needs the origin of the mission's scenario");
  expect_problem("drawing.svg", "no drawing", "drawing.svg: line 1: is no XML");
  expect_problem("low.textproto", square_ + "low_z_m: 1", "low_z_m");
  expect_problem("high.textproto", square_ + "high_z_m: 1", "high_z_m");
  expect_problem("heights.textproto", square_ + "low_z_m: 1e6 high_z_m: 2e6",
                 "from 1000000 to 2000000 m it has no height in the domain", "cube_corners");
  const std::vector<Unsayable> unsayable = {
      {"scenario/zone_file.cc", "the running mission",
       "the mission is one that a program has written"},
      {"scenario/zone_file.cc", " in Polygon", "it is taken out of a message"},
      {"scenario/zone_file.cc", ": file", "it is taken out of a message"},
      {"scenario/zone_file.cc", "cannot be a zone of this domain",
       "all that is_zone() asks is checked before"}};
  expect_all_said({"scenario/zone_file.cc"}, said_, unsayable);
}

}  // namespace
}  // namespace ergocast::test
