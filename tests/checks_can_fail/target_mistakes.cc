// SPDX-License-Identifier: BSD-3-Clause
// Small edits to the target of a good scenario, and the texts of polygons.
#include <sstream>

#include "tests/checks_can_fail/scenario_mistakes.h"

namespace ergocast::test {

std::string polygon(const std::string& corners, const std::string& more) {
  std::istringstream numbers(corners);
  std::string text = "regions { polygon { ";
  for (std::string x, y; numbers >> x >> y;) text += "vertices { x_m: " + x + " y_m: " + y + " } ";
  return text + more + " } } uniform_weight: 1";
}

std::string hole(const std::string& corners) {
  const std::string text = polygon(corners);
  const auto from = text.find("vertices"), to = text.rfind(" } }");
  return "holes { " + text.substr(from, to - from) + "} ";
}

std::string corners(const std::string& numbers) {
  const std::string text = polygon(numbers);
  const auto from = text.find("vertices"), to = text.rfind(" } }");
  return text.substr(from, to - from);
}

std::string wall(const std::string& numbers, const std::string& more) {
  return "walls { " + corners(numbers) + more + " } ";
}

Mistake in_space(const std::string& from, const std::string& to, const std::string& said) {
  std::string box = R"(domain { size_x_m: 800 size_y_m: 600 origin_z_m: -60 size_z_m: 60 }
target { uniform_weight: 1 }
law { u_max_mps: 5 }
time { duration_s: 60 }
agents { starts { x_m: 10 y_m: 20 z_m: -3 } }
)";
  return {kGood, box.replace(box.find(from), from.size(), to), said};
}

namespace {

std::string map_of(const std::string& file, const std::string& more = "") {
  const bool extent = more.empty() && !file.ends_with(".asc");
  return "maps { file: \"" + file + "\" " + more +
         (extent ? "origin_x_m: 0 origin_y_m: 0 size_x_m: 100 size_y_m: 50" : "") + " }";
}

const std::string kSquare = "10 10 40 10 40 40 10 40";

std::vector<Mistake> mistakes_of_targets() {
  const std::string bell = "gaussians { mean_x_m: 5 mean_y_m: 5 ";
  std::string big = polygon(kSquare, hole("20 20 21 20 21 21"));
  big.insert(big.find("vertices"), repeated(4200, "vertices { x_m: 1 y_m: 1 } "));
  return {
      {kUniform, "", "target: there is nothing to cover"},
      {kUniform, bell + "}", "target.gaussians[0]: has no width"},
      {kUniform, bell + "sigma_m: 5 covariance { xx_m2: 25 yy_m2: 25 } }",
       "target.gaussians[0]: has both"},
      {kUniform, bell + "sigma_m: 0.009 }", "target.gaussians[0].sigma_m: 0.009 is below"},
      {kUniform, bell + "covariance { xx_m2: 9e-5 yy_m2: 25 } }",
       "target.gaussians[0].covariance.xx_m2: 9e-05 is below"},
      {kUniform, bell + "covariance { xx_m2: 25 yy_m2: 9e-5 } }",
       "target.gaussians[0].covariance.yy_m2: 9e-05 is below"},
      {kUniform, bell + "covariance { xx_m2: 25 yy_m2: 25 xy_m2: 25 } }",
       "target.gaussians[0].covariance.xy_m2: 25 leaves too little"},
      {kUniform, "gaussians { mean_x_m: 500 mean_y_m: 5 sigma_m: 5 }",
       "target: only 0 of its weight"},
      {kUniform,
       "gaussians { mean_x_m: 100.047 mean_y_m: 25 covariance { xx_m2: 1e-4 yy_m2: 1e-4 xy_m2: "
       "8.9999e-5 } }",
       "target: its coefficients can be off by"},
      {kUniform, repeated(65, bell + "sigma_m: 5 } "), "target: 65 Gaussians are above the limit"},
      {kUniform, repeated(17, map_of("even.csv")), "target: 17 maps are above the limit"},
      {kUniform, repeated(65, "regions { } "), "target: 65 regions are above the limit"},
      {kUniform, repeated(65, "keep_outs { } "), "target: 65 keep-outs are above the limit"},
      {kUniform, big, "target: 4207 vertices are above the limit"},

      {kUniform, "regions { polygon { file: \"pier.geojson\" } }",
       "target.regions[0].polygon.file: needs to know where on the earth"},
      {kUniform, "regions { polygon { file: \"pier.geojson\" vertices { x_m: 1 y_m: 1 } } }",
       "target.regions[0].polygon.file: stands beside vertices"},
      {kUniform,
       "regions { polygon { file: \"many.geojson\" } } } "
       "origin { latitude_deg: 47.5 longitude_deg: 9.2",
       "target.regions[0].polygon.file: "},
      {kUniform,
       "regions { polygon { file: \"line.geojson\" } } } "
       "origin { latitude_deg: 47.5 longitude_deg: 9.2",
       "target.regions[0].polygon.file: "},
      {kUniform, kUniform + " keep_outs { file: \"square.svg\" }", "target.keep_outs[0].file: "},
      {kUniform, kUniform + " keep_outs { file: \"many.svg\" }", "target.keep_outs[0].file: "},
      {kUniform, kUniform + " keep_outs { file: \"bright.svg\" }", "target.keep_outs[0].file: "},
      {"size_y_m: 50 }\ntarget { uniform_weight: 1",
       "size_y_m: 100 } target { uniform_weight: 1 keep_outs { file: \"deep.svg\" }",
       "deep.svg: librsvg cannot paint it within 20 s of processor time and 768 MiB"},
      {kUniform, kUniform + " keep_outs { file: \"crossing.svg\" }", "target.keep_outs[0].file: "},
      {kUniform, kUniform + " keep_outs { file: \"overlap.svg\" }", "target.keep_outs[0].file: "},
      {kUniform, kUniform + " keep_outs { file: \"outside.svg\" }", "target.keep_outs[0].file: "},
      {kUniform, kUniform + " keep_outs { file: \"pier.geojson\" solid_white: true }",
       "target.keep_outs[0].solid_white: is for drawings"},
      {kUniform, "regions { polygon { " + repeated(2, "vertices { x_m: 1 y_m: 1 } ") + "} }",
       "target.regions[0].polygon: 2 vertices enclose nothing"},
      {kUniform, "uniform_weight: 1 keep_outs { vertices { x_m: 1 y_m: 1 } }",
       "target.keep_outs[0]: 1 vertices enclose nothing"},
      {kUniform, polygon("10 10 40 10 40 10 40 40"),
       "target.regions[0].polygon: vertices[1] and vertices[2] are the same"},
      {kUniform, polygon(kSquare + " 10 10"),
       "target.regions[0].polygon: vertices[4] and vertices[0] are the same"},
      {kUniform, polygon("10 10 40 40 40 10 10 40"),
       "target.regions[0].polygon: the edges that begin at"},
      {kUniform, polygon(kSquare, hole("50 10 60 10 60 20")),
       "target.regions[0].polygon.holes[0]: the hole is outside"},
      {kUniform, polygon(kSquare, hole("20 20 30 20 30 30 20 30") + hole("24 24 25 24 25 25")),
       "target.regions[0].polygon.holes[1]: the hole is inside"},
      {kUniform, polygon("10 10 20 20 40 40"),
       "target.regions[0].polygon: all its vertices are on one line"},
      {kUniform, polygon("10 10 10.001 10 10.001 10.001"), "target.regions[0].polygon: its area"},
      {kUniform, polygon("200 10 300 10 300 20"), "target.regions[0]: nothing of it is left"},
      {kUniform,
       polygon("10 10 20 10 20 20") +
           " keep_outs { vertices { x_m: 5 y_m: 5 } vertices { x_m: 45 y_m: 5 } vertices { x_m: 45 "
           "y_m: 45 } vertices { x_m: 5 y_m: 45 } }",
       "target.regions[0]: nothing of it is left"},
  };
}

/// Mistakes of maps; `files` are written beside the scenario.
std::vector<Mistake> mistakes_of_maps() {
  const std::string at = "target.maps[0].file: ";
  const std::string extent = "origin_x_m: 0 origin_y_m: 0 size_x_m: 100 size_y_m: 50";
  const std::string file = "file: \"even.csv\" ";
  std::vector<Mistake> all = {
      {kUniform, "maps { " + extent + " }", at + "is missing"},
      {kUniform, map_of("even.jpg"), "even.jpg does not end in"},
      {kUniform, map_of("even.nc"), at},
      {kUniform, map_of("even.tif", " "), at + "a GeoTIFF needs to know"},
      {kUniform, map_of("good.asc", extent), "target.maps[0].origin_x_m: this kind of map states"},
      {kUniform, map_of("good.asc", "first_row: SOUTH"),
       "target.maps[0].first_row: this kind of map always"},
      {kUniform, map_of("even.csv", "origin_x_m: 500 origin_y_m: 0 size_x_m: 1 size_y_m: 1"),
       "target.maps[0]: nothing of it is left"},
  };
  for (const char* name : {"origin_x_m", "origin_y_m", "size_x_m", "size_y_m"}) {
    std::string others = extent;
    const auto begin = others.find(name),
               end = std::min(others.find(' ', others.find(' ', begin) + 1), others.size());
    others.erase(begin, end - begin);
    all.push_back({kUniform, map_of("even.csv", others),
                   std::string("target.maps[0].") + name + ": is missing"});
    all.push_back({kUniform, map_of("good.asc", std::string(name) + ": 1"),
                   std::string("target.maps[0].") + name + ": this kind of map states"});
  }
  for (const char* bad :
       {"none.csv",    "folder.csv",     "locked.csv",     "empty.csv",    "wide.csv",  "long.csv",
        "ragged.csv",  "zero.csv",       "words.csv",      "negative.csv", "huge.csv",  "nan.csv",
        "marked.csv",  "wide_words.csv", "semicolons.csv", "tabs.csv",     "blank.csv", "many.csv",
        "picture.csv", "tiff.csv",       "photo.csv",      "sheet.csv",    "grid.csv",  "page.csv",
        "commas.csv",  "oblong.asc",     "key.asc",        "twice.asc",    "bare.asc",  "lacks.asc",
        "both.asc",    "half.asc",       "flat.asc",       "short.asc",    "more.asc",  "text.png",
        "cut.png",     "palette.png",    "colour.png",     "bits.png",     "laced.png"}) {
    all.push_back({kUniform, map_of(bad), at});
  }
  return all;
}

Mistake of_grid(const std::string& file, const std::string& said,
                const std::string& choice = "time_index: 1") {
  return in_space(kUniform, "voxels { file: \"" + file + "\" variable: \"chl\" " + choice + " }",
                  "target.voxels[0]: " + said);
}

std::vector<Mistake> mistakes_of_grids() {
  return {
      of_grid("sour.nc", ""),
      of_grid("text.nc", ""),
      of_grid("salt.nc", ""),
      of_grid("words.nc", ""),
      of_grid("good.nc", "", ""),
      of_grid("good.nc", "", "time_index: 2"),
      of_grid("good.nc", "", "time_index: 1 x_axis: \"lon\""),
      of_grid("good.nc", "", "time_index: 1 x_axis: \"y\" y_axis: \"y\""),
      of_grid("text_range.nc", ""),
      of_grid("member.nc", ""),
      of_grid("flat.nc", ""),
      of_grid("plane.nc", ""),
      {kUniform, "voxels { file: \"good.nc\" variable: \"chl\" time_index: 1 }",
       "target.voxels[0]: "},
      of_grid("billion.nc", ""),
      of_grid("long.nc", ""),
      of_grid("uneven.nc", ""),
      of_grid("bare.nc", ""),
      of_grid("degrees.nc", ""),
      of_grid("unitless.nc", ""),
      of_grid("single.nc", ""),
      of_grid("shape.nc", ""),
      of_grid("nan.nc", ""),
      of_grid("tangled.nc", ""),
      of_grid("zero.nc", ""),
      of_grid("away.nc", ""),
  };
}

}  // namespace

std::vector<Mistake> target_mistakes() {
  std::vector<Mistake> all = mistakes_of_targets();
  for (const auto& mistakes : {mistakes_of_maps(), mistakes_of_grids()})
    all.insert(all.end(), mistakes.begin(), mistakes.end());
  return all;
}

}  // namespace ergocast::test
