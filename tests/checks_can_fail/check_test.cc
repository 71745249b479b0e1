// SPDX-License-Identifier: BSD-3-Clause
// Each finding of `ergocast check` for a scenario that has it: small edits to a good one, and every
// field outside its limits, which are read from the program's own table of fields.
#include <google/protobuf/text_format.h>

#include <cmath>
#include <functional>
#include <set>
#include <sstream>

#include "scenario/defaults.h"
#include "scenario/fields.h"
#include "scenario/scenario.pb.h"
#include "tests/checks_can_fail/expect_said.h"
#include "tests/process/programs.h"
#include "tests/scenario/water_column.h"
#include "tests/support/grey_png.h"

namespace ergocast::test {
namespace {

namespace fs = std::filesystem;
using google::protobuf::FieldDescriptor;
using Block = google::protobuf::Message;

const std::string kGood = R"(domain { size_x_m: 100 size_y_m: 50 }
target { uniform_weight: 1 }
law { u_max_mps: 5 }
time { duration_s: 60 }
agents { starts { x_m: 10 y_m: 20 } }
)";

/// One mistake put into kGood, and the beginning of its error text; the line is that of `from`.
struct Mistake {
  std::string from, to, said;
  bool has_line = true;
};

std::string repeated(int count, const std::string& text) {
  std::string all;
  for (int i = 0; i < count; ++i) all += text;
  return all;
}

std::string polygon(const std::string& corners, const std::string& more = "") {
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

std::string map_of(const std::string& file, const std::string& more = "") {
  const bool extent = more.empty() && !file.ends_with(".asc");
  return "maps { file: \"" + file + "\" " + more +
         (extent ? "origin_x_m: 0 origin_y_m: 0 size_x_m: 100 size_y_m: 50" : "") + " }";
}

const std::string kUniform = "uniform_weight: 1", kLaw = "law {", kTime = "duration_s: 60";
const std::string kSquare = "10 10 40 10 40 40 10 40";

std::vector<Mistake> mistakes_of_the_text() {
  return {
      {"size_x_m: 100", "size_x_m: 1,5", "domain.size_x_m: 1,5 has a comma"},
      {"size_x_m: 100", "size_x_m: ten", "domain.size_x_m: ten is not a number"},
      {"size_x_m: 100", "size_x_m 100", "domain.size_x_m: Expected \":\""},
      {"size_x_m: 100", "size_x_m: 100 size_x_m: 1", "domain.size_x_m: is written more than once"},
      {"size_x_m: 100", "size_x_m: 100 size_q_m: 1", "unknown field \"size_q_m\" in Domain"},
      {kLaw, "law { modes_x: 5", "unknown field \"modes_x\" in Law"},
      {kLaw, "law { nonsense: 5", "unknown field \"nonsense\" in Law"},
      {kLaw, "[other.field]: 5 law {", "unknown extension"},
      {kLaw, "law { regularization: BOTH", "law.regularization: unknown value \"BOTH\""},
      {kLaw, "basis { normalized: yes } law {", "basis.normalized: yes is neither true nor false"},
      {kLaw, "basis { modes_x: 4.5 } law {", "basis.modes_x: 4.5 is not a whole number"},
      {kLaw, "seed: -1 law {", "seed: -1 is not 0 or above"},
      {kLaw, "seed: 18446744073709551616 law {", "seed: 18446744073709551616 is out of range"},
      {kLaw, "name: five law {", "name: five is not a quoted text"},
      {"} }\n", "}\n", "this block is not closed"},
      {kLaw, "# \xE9\nlaw {", "this is not UTF-8"},
      {kLaw, repeated(20, "law {"), "blocks lie deeper than the limit"},
      {kLaw, repeated(60, "seed: x ") + kLaw, "has more mistakes than these", false},
      {kLaw, "#" + std::string(1 << 20, ' ') + "\nlaw {", "is longer than the limit", false},
      {kLaw, "name: \"../x\" law {", "name: cannot name a folder"},
      {kLaw, "description: \"\\xff\" law {", "description: is not UTF-8"},
      {kLaw, "description: \"" + std::string(2001, 'x') + "\" law {", "description: 2001 bytes"},
  };
}

/// A distance among vehicles of 20 m/s; then, unless it says otherwise, the law.
std::string keeping(const std::string& separation, const std::string& world,
                    const std::string& then = kLaw) {
  return "separation { " + separation + " } world { speed_limit_mps: 20 " + world + " } " + then;
}

std::string wings(const std::string& limits, const std::string& then = kLaw) {
  return "vehicle { kind: FIXED_WING " + limits + " } world { speed_limit_mps: 20 } " + then;
}

std::vector<Mistake> mistakes_between_fields() {
  return {
      {"size_x_m: 100", "size_x_m: 100 origin_x_m: 10000001", "domain.origin_x_m: "},
      {"size_x_m: 100", "size_x_m: 100 origin_y_m: 10000001", "domain.origin_y_m: "},
      {kLaw, "basis { modes_x: 1 modes_y: 1 } law {", "basis: a single mode"},
      {"u_max_mps: 5", "u_max_mps: 501", "law.u_max_mps: 501 makes u_max_mps"},
      {kLaw, "law { noise_intensity: 159", "law.noise_intensity: 159 makes"},
      {kLaw, "law { noise_ceiling: 159", "law.noise_ceiling: 159 makes"},
      {kLaw, "law { noise_intensity: 3 noise_ceiling: 2", "law.noise_ceiling: 2 is below"},
      {kLaw, "law { perturbation: CONSTANT noise_ceiling: 2", "law.noise_ceiling: has no effect"},
      {kLaw, "law { contraction_gain_per_s: 0.1", "law.u_max_mps: 5 is too weak"},
      {"u_max_mps: 5", "u_max_mps: 500 contraction_gain_per_s: 11",
       "law.contraction_gain_per_s: 11 makes"},
      {kLaw, "law { contraction_center: POINT contraction_y_m: 3",
       "law.contraction_x_m: is missing"},
      {kLaw, "law { contraction_center: POINT contraction_x_m: 3",
       "law.contraction_y_m: is missing"},
      {kLaw, "law { contraction_x_m: 3", "law.contraction_x_m: has no effect"},
      {kTime, "duration_s: 0.04", "time.duration_s: 0.04 is less than one step"},
      {kTime, "duration_s: 1001 dt_s: 1e-5", "time.duration_s: 100100000 steps"},
      {kTime, "duration_s: 60 dt_s: 0.001 pace: REALTIME realtime_factor: 20",
       "time.realtime_factor: 20 makes a step last"},
      {kTime, "duration_s: 60 broadcast_period_ticks: 30 high_mode_period_factor: 34",
       "time.high_mode_period_factor: 34 makes 1020 ticks"},
      {"starts { x_m: 10 y_m: 20 }", "", "agents: the team is empty"},
      {"agents {", "agents { random_count: 1024", "agents: a team of 1025"},
      {"agents {", "agents { quorum: 2", "agents.quorum: 2 is above"},
      {"{ x_m: 10", "{ x_m: 101", "agents.starts[0].x_m: 101 is outside"},
      {"y_m: 20", "y_m: -1", "agents.starts[0].y_m: -1 is outside"},
      {"agents {", "world { disturbance_intensity: 1000 } agents {",
       "world.disturbance_intensity: 1000"},
      {kLaw, "separation { distance_m: 5 } law {",
       "world.speed_limit_mps: is missing, and separation relies on it", false},
      {kLaw, keeping("distance_m: 26", ""), "separation.distance_m: 26 is above a quarter"},
      {kLaw, "vehicle { kind: ACCELERATION } law {", "vehicle.max_acceleration_mps2: is missing",
       false},
      {kLaw, "vehicle { max_acceleration_mps2: 5 } law {",
       "vehicle.max_acceleration_mps2: has no effect"},
      {kLaw, "vehicle { kind: ACCELERATION max_acceleration_mps2: 5 } law {",
       "world.speed_limit_mps: is missing, and all kinds but POINT rely on it", false},
      {kLaw,
       "world { speed_limit_mps: 20 } vehicle { kind: ACCELERATION max_acceleration_mps2: 5 } "
       "law {",
       "vehicle.max_acceleration_mps2: 5 stops a vehicle after"},
      {kLaw, wings("max_turn_radps: 1"), "vehicle.min_speed_mps: is missing", false},
      {kLaw, wings("min_speed_mps: 2"), "vehicle.max_turn_radps: is missing", false},
      {kLaw, wings("min_speed_mps: 5 max_turn_radps: 1"), "vehicle.min_speed_mps: 5 is not below"},
      {kLaw, wings("min_speed_mps: 2 max_turn_radps: 0.1"),
       "vehicle.max_turn_radps: 0.1 turns a vehicle on a circle"},
      {"agents {", wings("min_speed_mps: 2 max_turn_radps: 0.16", "agents {"),
       "agents.starts[0]: is nearer to an edge than"},
      {kLaw, wings("min_speed_mps: 2 max_turn_radps: 1 max_acceleration_mps2: 1"),
       "vehicle.max_acceleration_mps2: has no effect with kind: FIXED_WING"},
      {kLaw,
       keeping("distance_m: 5 position_error_m: 0.1",
               "} vehicle { kind: ACCELERATION max_acceleration_mps2: 50"),
       "separation: allows errors, disturbances"},
      {kLaw, keeping("distance_m: 5", "disturbance_intensity: 1"),
       "separation.disturbance_m: 1.898 is not below a quarter of a step"},
      {"time {", keeping("distance_m: 5 guard: false", "", "time { pace: REALTIME "),
       "time.command_hold_s: 0.5 is too long without separation.guard"},
      {"time {",
       keeping("distance_m: 20 lease_s: 2", "", "time { pace: REALTIME command_hold_s: 0.2 "),
       "distance_m / (4 speed_limit_mps) - dt_s = 0.15"},
      {"time {", keeping("distance_m: 5 lease_s: 2", "", "time { pace: REALTIME "),
       "- dt_s, which is below 0 (write a greater distance_m, or a smaller dt_s"},
      {"agents {", keeping("distance_m: 0.1 lease_s: 2", "", "agents { random_count: 256 "),
       "separation.lease_s: is for at most 256 agents, not 257"},
      {kLaw, keeping("distance_m: 5 lease_s: 0.2", ""),
       "separation.lease_s: 0.2 is not between 0.5 and 1000"},
      {kLaw, keeping("distance_m: 5 lease_s: 2 guard: true", ""),
       "separation.lease_s: says that nobody knows all places"},
      {kLaw, keeping("distance_m: 5 lease_s: 2", "radio_range_m: 50"),
       "separation.lease_s: needs all agents to hear each other"},
      {kLaw, keeping("distance_m: 5 lease_s: 2 disturbance_m: 0.1", ""),
       "separation.lease_s: relies on bodies that stay where they stand"},
      {"agents {", keeping("distance_m: 12", "", "agents { random_count: 22 "),
       "separation.distance_m: 23 agents 12 m apart take up"},
      {"agents {", keeping("distance_m: 12", "", "agents { starts { x_m: 19 y_m: 20 } "),
       "agents.starts[1]: is 9 m from starts[0]"},
  };
}

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
      {kUniform, map_of("even.tif"), at},
      {kUniform, map_of("good.asc", extent),
       "target.maps[0].origin_x_m: an ESRI ASCII grid states"},
      {kUniform, map_of("good.asc", "first_row: SOUTH"),
       "target.maps[0].first_row: an ESRI ASCII grid"},
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
                   std::string("target.maps[0].") + name + ": an ESRI ASCII grid states"});
  }
  for (const char* bad :
       {"none.csv",   "folder.csv", "locked.csv", "empty.csv",    "wide.csv", "long.csv",
        "ragged.csv", "zero.csv",   "words.csv",  "negative.csv", "huge.csv", "nan.csv",
        "key.asc",    "twice.asc",  "bare.asc",   "lacks.asc",    "both.asc", "half.asc",
        "flat.asc",   "short.asc",  "more.asc",   "text.png",     "cut.png",  "palette.png",
        "colour.png", "bits.png",   "laced.png"}) {
    all.push_back({kUniform, map_of(bad), at});
  }
  return all;
}

/// One mistake put into a scenario of a box; the scenario stands in the place of kGood.
Mistake in_space(const std::string& from, const std::string& to, const std::string& said) {
  std::string box = R"(domain { size_x_m: 800 size_y_m: 600 origin_z_m: -60 size_z_m: 60 }
target { uniform_weight: 1 }
law { u_max_mps: 5 }
time { duration_s: 60 }
agents { starts { x_m: 10 y_m: 20 z_m: -3 } }
)";
  return {kGood, box.replace(box.find(from), from.size(), to), said};
}

Mistake of_grid(const std::string& file, const std::string& said,
                const std::string& choice = "time_index: 1") {
  return in_space(kUniform, "voxels { file: \"" + file + "\" variable: \"chl\" " + choice + " }",
                  "target.voxels[0]: " + said);
}

/// Mistakes in the kinds of a team of two.
std::vector<Mistake> mistakes_of_kinds() {
  const std::string from = "starts { x_m: 10 y_m: 20 }";
  const auto kinds = [&](const std::string& first, const std::string& second,
                         const std::string& said, bool has_line = true) {
    return Mistake{from,
                   from + " random_count: 1 kind { name: \"a\" count: 1 " + first + " } kind { " +
                       second + " }",
                   said, has_line};
  };
  const std::string good = "name: \"b\" count: 1";
  return {
      kinds("", "name: \"b\" count: 2",
            "agents.kind: the counts add up to 3 agents, and the team has 2"),
      kinds("", "name: \"a\" count: 1", "agents.kind[1].name: another kind is called \"a\", too"),
      kinds("", "count: 1", "agents.kind[1].name: is missing"),
      kinds("", "name: \"x y\" count: 1", "agents.kind[1].name: cannot name a kind"),
      kinds("", "name: \"b\"", "agents.kind[1].count: is missing"),
      kinds("quality: 0", good, "agents.kind[0].quality: 0 is not above 0"),
      kinds("footprint_sigma_m: -1", good,
            "agents.kind[0].footprint_sigma_m: -1 is below the limit 0"),
      kinds("footprint_sigma_m: 101", good,
            "agents.kind[0].footprint_sigma_m: 101 is larger than the domain"),
      kinds("u_max_mps: 501", good, "agents.kind[0].u_max_mps: 501 makes a step of the input"),
      kinds("u_max_mps: 0.001", good, "agents.kind[0].u_max_mps: 0.001 is too weak"),
      kinds("noise_intensity: 2 noise_ceiling: 1", good,
            "agents.kind[0].noise_ceiling: 1 is less than the kind's least noise"),
      kinds("noise_intensity: 200 noise_ceiling: 200", good,
            "agents.kind[0].noise_intensity: 200 makes a step of the least noise"),
      kinds("noise_ceiling: 200", good,
            "agents.kind[0].noise_ceiling: 200 makes a step of the greatest noise"),
      kinds("band { from: 3 to: 2 }", good, "agents.kind[0].band: covers no mode"),
      kinds("band { from: 100 }", good, "agents.kind[0].band: covers no mode"),
      kinds("vehicle { kind: UNICYCLE }", good,
            "agents.kind[0].vehicle.max_turn_radps: is missing"),
      kinds("vehicle { min_speed_mps: 1 }", good,
            "agents.kind[0].vehicle.min_speed_mps: has no effect with kind: POINT"),
      kinds("vehicle { kind: UNICYCLE max_turn_radps: 1 }", good,
            "world.speed_limit_mps: is missing, and all kinds but POINT rely on it", false),
      kinds("speed_limit_mps: 20 vehicle { kind: ACCELERATION max_acceleration_mps2: 5 }", good,
            "agents.kind[0].vehicle.max_acceleration_mps2: 5 stops a vehicle after"),
      kinds("speed_limit_mps: 3 vehicle { kind: FIXED_WING max_turn_radps: 1 min_speed_mps: 4 }",
            good, "agents.kind[0].vehicle.min_speed_mps: 4 is not below law.u_max_mps and agents"),
      kinds(
          "speed_limit_mps: 20 vehicle { kind: FIXED_WING max_turn_radps: 0.16 min_speed_mps: 2 }",
          good, "agents.starts[0]: is nearer to an edge than"),
      kinds("", good + " } " + repeated(15, "kind { name: \"c\" count: 1 } ") + " kind { " + good,
            "agents.kind: 18 kinds are above the limit 16"),
  };
}

/// Corners in turn as a wall's or keep-out's fields.
std::string corners(const std::string& numbers) {
  const std::string text = polygon(numbers);
  const auto from = text.find("vertices"), to = text.rfind(" } }");
  return text.substr(from, to - from);
}
std::string wall(const std::string& numbers, const std::string& more = "") {
  return "walls { " + corners(numbers) + more + " } ";
}

std::vector<Mistake> mistakes_of_walls() {
  const std::string block = "60 10 80 10 80 30 60 30", limit = "speed_limit_mps: 1000 ";
  const auto world = [](const std::string& fields, const std::string& said, bool has_line = true) {
    return Mistake{kLaw, "world { " + fields + " } law {", said, has_line};
  };
  const std::string block_and_limit = limit + wall(block);
  std::string many;
  for (int i = 0; i < 342; ++i) {
    const std::string x = std::to_string(20 + i / 5.0);
    many += wall(x + " 1 " + std::to_string(20.1 + i / 5.0) + " 1 " + x + " 2");
  }
  return {
      world(limit + "wall_clearance_m: 1", "world.wall_clearance_m: has no effect without walls"),
      world(limit + wall(block, "solid: true"), "world.walls[0].solid: is for keep-outs"),
      {kUniform, "regions { polygon { " + corners(block) + " solid: true } }",
       "target.regions[0].polygon.solid: is for keep-outs"},
      world(limit + wall("60 10 80 10"), "world.walls[0]: 2 vertices enclose nothing"),
      world(limit + wall(block, hole("90 10 95 10 95 20")),
            "world.walls[0].holes[0]: the hole is outside"),
      world(limit + wall("60 10 1101 10 80 30"), "world.walls[0]: has a vertex that is farther"),
      world(limit + many, "world: 1026 vertices of walls are above the limit 1024", false),
      world(block_and_limit + wall("70 20 90 20 90 40"),
            "world.walls[1]: crosses, touches or overlaps world.walls[0]"),
      world(block_and_limit + wall("65 15 70 15 70 20"),
            "world.walls[1]: crosses, touches or overlaps world.walls[0]"),
      {kUniform,
       kUniform + " keep_outs { " + corners(block) + " solid: true } keep_outs { solid: true " +
           corners("70 20 90 20 90 40") + " } } world { speed_limit_mps: 1000 ",
       "target.keep_outs[1]: crosses, touches or overlaps target.keep_outs[0]"},
      world(wall(block), "world.speed_limit_mps: is missing, and walls rely on it", false),
      world(block_and_limit + "disturbance_intensity: 1 } vehicle { kind: UNICYCLE "
                              "max_turn_radps: 10",
            "world.disturbance_intensity: pushes vehicles that are no POINT", false),
      world(block_and_limit + "} separation { distance_m: 2 position_error_m: 0.5",
            "world.wall_clearance_m: 0 is too little", false),
      world(limit + wall("5 15 15 15 15 25 5 25"), "agents.starts[0]: is in a wall", false),
      world(block_and_limit + "wall_clearance_m: 51",
            "agents.starts[0]: is 50 m from a wall, nearer than the 51", false),
      world(limit + wall("50 -1 51 -1 51 51 50 51"),
            "world.walls: cut the free domain in 2 parts: the one around x ", false),
      world(limit + wall("20 -20 120 -20 120 70 -20 70 -20 32 20 32") + "wall_clearance_m: 9.9",
            "world.walls: leave only", false),
  };
}

/// Stations where nobody can stay, or come in time.
std::vector<Mistake> mistakes_of_stations() {
  const std::string start = "starts { x_m: 10 y_m: 20 }", second = " random_count: 1";
  const auto home = [&](const std::string& kind, const std::string& said,
                        const std::string& blocks = "", bool has_line = true) {
    return Mistake{start, start + " kind { name: \"a\" count: 1 " + kind + " } } " + blocks + " #{",
                   said, has_line};
  };
  const std::string near = "station { x_m: 12 y_m: 20 } ";
  const std::string block = "world { speed_limit_mps: 1000 wall_clearance_m: 2 " +
                            wall("60 10 80 10 80 30 60 30", hole("65 15 75 15 75 25 65 25")) + "}";
  // A slot in which a body just fits, too narrow for a way that a table of cells can lead.
  const std::string slot = "world { speed_limit_mps: 1000 wall_clearance_m: 2 " +
                           wall("60 10 80 10 80 40 72.3 40 72.3 15 68.2 15 68.2 40 60 40") + "}";
  const std::string one = start + second + " kind { name: \"a\" count: 2 ";
  return {
      {start, start + " random_count: 2 kind { name: \"a\" count: 3 " + near + near + "}",
       "agents.kind[0].station[1]: the kind has 3 agents and 2 stations"},
      home("reserve_s: 5", "agents.kind[0].reserve_s: has no effect without a station"),
      home(near + "reserve_s: 60", "agents.kind[0].reserve_s: 60 is no less than the mission's 60"),
      home("station { x_m: 12 y_m: 51 }", "agents.kind[0].station[0]: is outside the domain"),
      home("station { x_m: 2 y_m: 20 }", "agents.kind[0].station[0]: is nearer to an edge than",
           wings("max_turn_radps: 0.5 min_speed_mps: 2", "")),
      home("station { x_m: 62 y_m: 12 }", "agents.kind[0].station[0]: is in a wall", block),
      home("station { x_m: 59 y_m: 20 }", "agents.kind[0].station[0]: is 1 m from a wall", block),
      home("station { x_m: 70.25 y_m: 20 }",
           "agents.kind[0].station[0]: cannot be reached from the start of agent 0", slot),
      in_space("z_m: -3 }",
               "z_m: -3 } kind { name: \"a\" count: 1 station { x_m: 9 y_m: 9 z_m: 9 } }",
               "agents.kind[0].station[0]: is outside the domain"),
      home("station { x_m: 100 y_m: 20 } reserve_s: 45",
           "agents.kind[0].station[0]: is 18.2 s away from the start of agent 0"),
      {start, one + near + "station { x_m: 13 y_m: 20 } } } " + keeping("distance_m: 5", "", "#{"),
       "agents.kind[0].station[1]: agents 0 and 1 have stations 1 m apart"},
  };
}

/// What the modes of a free domain do not go with.
std::vector<Mistake> mistakes_of_free_domains() {
  const std::string few = "basis { modes_x: 5 modes_y: 4 free_domain: true";
  const std::string start = "starts { x_m: 10 y_m: 20 }";
  const auto kind = [&](const std::string& sees, const std::string& said) {
    return Mistake{start, start + " kind { name: \"a\" count: 1 " + sees + " } } " + few, said};
  };
  const auto wall = [](double low_m, double high_m) {
    const std::string low = std::to_string(low_m), high = std::to_string(high_m);
    return "walls { vertices { x_m: 49 y_m: " + low + " } vertices { x_m: 51 y_m: " + low +
           " } vertices { x_m: 51 y_m: " + high + " } vertices { x_m: 49 y_m: " + high + " } } ";
  };
  // A gap between two rows of cells, which are 0.88 m high.
  const std::string gap = wall(-5, 24.3) + wall(24.9, 55);
  return {
      {kLaw, "basis { modes_x: 21 modes_y: 20 free_domain: true } law {",
       "basis.free_domain: 420 modes are above the limit of a free domain"},
      {kLaw, "world { speed_limit_mps: 100 " + gap + "} " + few + " } law {",
       "basis.free_domain: the free domain has no modes"},
      in_space(kLaw, few + " } law {", "basis.free_domain: needs a plane"),
      kind("footprint_sigma_m: 3", "agents.kind[0].footprint_sigma_m: is a blur of cosines"),
      kind("band { to: 3 }", "agents.kind[0].band: is of cosines"),
  };
}

std::vector<Mistake> mistakes_in_space() {
  const std::string bell = "gaussians { mean_x_m: 5 mean_y_m: 5 mean_z_m: -5 ";
  const std::string prism =
      " vertices { x_m: 10 y_m: 10 } vertices { x_m: 40 y_m: 10 } vertices { x_m: 40 y_m: 40 } } }";
  const std::string map =
      "maps { file: \"even.csv\" origin_x_m: 0 origin_y_m: 0 size_x_m: 100 "
      "size_y_m: 50 layers { low_z_m: -9 high_z_m: -5 value: ";
  return {
      in_space(kLaw, "world { speed_limit_mps: 9 " + wall("60 10 80 10 80 30") + "} law {",
               "world.walls[0]: walls belong to a plane"),
      {"y_m: 20", "y_m: 20 z_m: 3", "agents.starts[0].z_m: the domain is a plane"},
      in_space(kLaw, "basis { modes_x: 17 modes_y: 17 modes_z: 17 } law {",
               "basis: 4913 modes are above the limit"),
      in_space(kLaw,
               "world { speed_limit_mps: 20 } vehicle { kind: UNICYCLE max_turn_radps: 1 } law {",
               "vehicle.kind: UNICYCLE belongs to a plane"),
      in_space(kUniform, bell + "sigma_z_m: 5 covariance { xx_m2: 9 yy_m2: 9 zz_m2: 9 } }",
               "target.gaussians[0].sigma_z_m: has no effect with covariance"),
      in_space(kUniform,
               bell + "covariance { xx_m2: 9 yy_m2: 9 zz_m2: 9 xy_m2: 6 xz_m2: 6 yz_m2: -6 } }",
               "target.gaussians[0].covariance: is not positive definite enough"),
      in_space(kUniform, "regions { polygon { low_z_m: -10 high_z_m: -20" + prism,
               "target.regions[0].polygon: its heights -10 to -20 m enclose nothing"),
      in_space(kUniform, "regions { polygon { low_z_m: 10 high_z_m: 20" + prism,
               "target.regions[0].polygon: its heights 10 to 20 m are outside"),
      in_space(kUniform, map + "0 } }", "target.maps[0]: no layer has a value above 0"),
      in_space(kUniform, map + "1 } layers { low_z_m: -6 high_z_m: -1 } }",
               "target.maps[0].layers[1]: overlaps layers[0]"),
      in_space(kUniform, map + "1 } " + repeated(256, "layers { low_z_m: -9 high_z_m: -5 } ") + "}",
               "target.maps[0]: 257 layers are above the limit"),
      in_space(kUniform, repeated(17, "voxels { file: \"a.nc\" variable: \"v\" } "),
               "target: 17 grids are above the limit"),
      in_space(kUniform, "voxels { variable: \"v\" }", "target.voxels[0].file: is missing"),
      in_space(kUniform, "voxels { file: \"even.csv\" variable: \"v\" }",
               "even.csv does not end in .nc"),
      in_space(kUniform, "voxels { file: \"a.nc\" }", "target.voxels[0].variable: is missing"),
      in_space(kUniform, bell + "covariance { xx_m2: 9 yy_m2: 9 zz_m2: 9 xz_m2: 9 } }",
               "target.gaussians[0].covariance.xz_m2: 9 leaves too little"),
      in_space(kUniform, bell + "covariance { xx_m2: 9 yy_m2: 9 zz_m2: 9 yz_m2: 9 } }",
               "target.gaussians[0].covariance.yz_m2: 9 leaves too little"),
      in_space("starts { x_m: 10 y_m: 20 z_m: -3 }", "", "agents: the team is empty"),
      of_grid("sour.nc", ""),
      of_grid("text.nc", ""),
      of_grid("salt.nc", ""),
      of_grid("words.nc", ""),
      of_grid("good.nc", "", ""),
      of_grid("good.nc", "", "time_index: 2"),
      of_grid("good.nc", "", "time_index: 1 x_axis: \"lon\""),
      of_grid("good.nc", "", "time_index: 1 x_axis: \"y\" y_axis: \"y\""),
      of_grid("member.nc", ""),
      of_grid("flat.nc", ""),
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

class Scenarios : public OwnHost {
 protected:
  void write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }

  void write_files() {
    write_grids();
    const std::string header = "ncols 2\nnrows 1\nxllcorner 0\nyllcorner 0\ncellsize 50\n";
    write("good.asc", header + "1 2\n");
    write("even.csv", "1,2\n3,4\n");
    write("pier.geojson", R"({"type":"Polygon","coordinates":[[[9.2005,47.5001],[9.2006,47.5001],)"
                          R"([9.2006,47.5002],[9.2005,47.5001]]]})");
    write("many.geojson", R"({"type":"Polygon","coordinates":[[)" + repeated(4100, "[9.2,47.5],") +
                              "[9.2,47.5]]]}");
    write("line.geojson", R"({"type":"LineString","coordinates":[]})");
    write("square.svg", "<svg viewBox='0 0 1 1'><rect width='1' height='1'/></svg>");
    write("many.svg",
          "<svg viewBox='0 0 2 1'><path d='M0 0" + repeated(2100, "h.1v.1") + "'/></svg>");
    fs::create_directory(folder_ / "folder.csv");
    fs::create_symlink(unreadable_file(), folder_ / "locked.csv");
    write("empty.csv", "");
    write("wide.csv", repeated(9000, "1,") + "1\n");
    write("long.csv", std::string(2 << 20, ' ') + "1\n");
    write("ragged.csv", "1,2\n3\n");
    write("zero.csv", "0,0\n");
    write("words.csv", "1,two\n");
    write("negative.csv", "1,-2\n");
    write("huge.csv", "1,1e31\n");
    write("nan.csv", "1,nan\n");
    write("key.asc", "columns 2\n" + header + "1 2\n");
    write("twice.asc", "ncols 2\n" + header + "1 2\n");
    write("bare.asc", "ncols\nnrows\n1 2\n");
    write("lacks.asc", "ncols 2\nnrows 1\n1 2\n");
    write("both.asc", "ncols 2\nnrows 1\ncellsize 1\nxllcorner 0\nxllcenter 0\nyllcorner 0\n1 2\n");
    write("half.asc", "ncols 2.5\nnrows 1\nxllcorner 0\nyllcorner 0\ncellsize 50\n1 2\n");
    write("flat.asc", "ncols 2\nnrows 1\nxllcorner 0\nyllcorner 0\ncellsize 0\n1 2\n");
    write("short.asc", header + "1\n");
    write("more.asc", header + "1 2 3\n");
    write("text.png", "P5 3 2 255 abcdef");
    const auto grey = [](int x, int y, int) { return (x + y) % 2; };
    write_png(folder_ / "cut.png", 20, 20, {}, grey);
    fs::resize_file(folder_ / "cut.png", 60);
    write_png(folder_ / "palette.png", 4, 4, {.color = PNG_COLOR_TYPE_PALETTE}, grey);
    write_png(folder_ / "colour.png", 4, 4, {.color = PNG_COLOR_TYPE_RGB}, grey);
    write_png(folder_ / "bits.png", 4, 4, {.bits = 1}, grey);
    write_png(folder_ / "laced.png", 4, 4, {.interlace = PNG_INTERLACE_ADAM7}, grey);
  }

  /// A good grid, and one for each mistake.
  void write_grids() {
    write("text.nc", "x,y\n1,2\n");
    NetcdfWriter(folder_ / "grid.nc", {{"time", 2}, {"z", 1}, {"y", 2}, {"x", 2}, {"ends", 2}},
                 {{"x", {"x"}, {10, 30}, {{"units", "m"}}},
                  {"y", {"y"}, {10, 30}, {{"units", "m"}}},
                  {"z", {"z"}, {10}, {{"units", "m"}, {"bounds", "floor"}}},
                  {"floor", {"z", "ends"}, {0, 20}, {}},
                  {"v", {"time", "z", "y", "x"}, {1, 2, 3, 4, 5, 6, 7, 8}, {}}});
    const auto grid = [&](const char* name, const std::function<void(WaterColumn&)>& change) {
      WaterColumn column;
      change(column);
      column.write(folder_ / name);
    };
    const auto scale = [](NetcdfVariable& variable, double factor, double offset) {
      for (double& value : variable.values) value = value * factor + offset;
    };
    grid("good.nc", [](WaterColumn&) {});
    grid("sour.nc", [](WaterColumn& c) { c.at("chl").values[300] = -1; });
    grid("salt.nc", [](WaterColumn& c) { c.at("chl").name = "salt"; });
    grid("words.nc", [](WaterColumn& c) { c.at("chl").type = NetcdfType::kText; });
    grid("member.nc", [](WaterColumn& c) { c.rename("depth", "member"); });
    grid("flat.nc", [](WaterColumn& c) { c.at("chl").dimensions = {"time", "y", "x"}; });
    grid("billion.nc", [](WaterColumn& c) { c.grow(1000); });
    grid("long.nc", [](WaterColumn& c) { c.grow(9000); });
    grid("uneven.nc", [](WaterColumn& c) { c.at("x").values[3] += 0.02; });
    grid("bare.nc", [](WaterColumn& c) { c.at("x").name = "east"; });
    grid("degrees.nc", [](WaterColumn& c) { c.at("x").attributes[1].second = "degrees_east"; });
    grid("unitless.nc", [](WaterColumn& c) { c.at("x").attributes.pop_back(); });
    grid("single.nc", [](WaterColumn& c) {
      c.dimensions[1].second = 1;
      c.at("depth").attributes.pop_back();
    });
    grid("shape.nc", [](WaterColumn& c) { c.at("depth").attributes[2].second = "nothing"; });
    grid("nan.nc", [](WaterColumn& c) { c.at("x").values[2] = std::nan(""); });
    grid("tangled.nc", [](WaterColumn& c) { std::swap(c.at("y").values[1], c.at("y").values[3]); });
    grid("zero.nc", [&](WaterColumn& c) { scale(c.at("chl"), 0, 0); });
    grid("away.nc", [&](WaterColumn& c) { scale(c.at("y"), 1, 10000); });
  }

  /// A file that root cannot open for reading either.
  static fs::path unreadable_file() {
    for (const auto& bus : fs::directory_iterator("/sys/bus")) {
      const fs::path file = bus.path() / "drivers_probe";
      if (fs::exists(file) && !std::ifstream(file).is_open()) return file;
    }
    ADD_FAILURE() << "no file on this machine that cannot be read";
    return "/dev/null";
  }

  void expect_mistake(const Mistake& mistake) {
    std::string text = kGood;
    const std::size_t at = text.find(mistake.from);
    ASSERT_NE(at, text.npos) << mistake.from;
    write("s.textproto", text.replace(at, mistake.from.size(), mistake.to));
    EXPECT_EQ(ergocast({"check", file_}), 2) << mistake.to.substr(0, 200) << output();
    const std::string begin = file_.string() + ":";
    const auto line =
        std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n') + 1;
    bool found = false;
    for (const std::string& said : note(output())) {
      if (said.find(mistake.said) == said.npos) continue;
      const bool in_line = said.starts_with(begin + std::to_string(line) + ":");
      found = found || !mistake.has_line || in_line || mistake.to.find('\n') != mistake.to.npos;
      EXPECT_TRUE(said.ends_with(")") && !said.ends_with("()")) << said;
    }
    EXPECT_TRUE(found) << mistake.said << " is not said of " << mistake.to.substr(0, 200) << ":\n"
                       << output().substr(0, 2000);
  }

  /// Keeps the output, line by line.
  std::vector<std::string> note(const std::string& text) {
    std::istringstream lines(text);
    std::vector<std::string> all;
    for (std::string line; std::getline(lines, line);) all.push_back(line);
    said_.insert(said_.end(), all.begin(), all.end());
    return all;
  }

  const fs::path file_ = folder_ / "s.textproto";
  std::vector<std::string> said_, said_of_flags_;
};

// ---- fields by themselves
// ------------------------------------------------------------------------

/// A scenario with every block, and every number that other fields determine or limit.
constexpr const char* kRich = R"(
name: "rich" description: "all fields" seed: 1 goal_ergodic_metric: 1
origin { latitude_deg: 47.5 longitude_deg: 9.2 }
domain { origin_x_m: 0 origin_y_m: 0 size_x_m: 100 size_y_m: 50 origin_z_m: 0 size_z_m: 40 }
target {
  gaussians { weight: 1 mean_x_m: 30 mean_y_m: 20 mean_z_m: 20 sigma_m: 5 }
  gaussians { weight: 1 mean_x_m: 60 mean_y_m: 20 mean_z_m: 20 covariance { xx_m2: 25 yy_m2: 25 xy_m2: 1 zz_m2: 25 } }
  uniform_weight: 1
  maps { file: "even.csv" weight: 1 origin_x_m: 0 origin_y_m: 0 size_x_m: 100 size_y_m: 50 first_row: NORTH }
  regions { weight: 1 polygon { vertices { x_m: 1 y_m: 1 } vertices { x_m: 9 y_m: 1 } vertices { x_m: 9 y_m: 9 } } }
  keep_outs { file: "pier.geojson" }
  voxels { file: "grid.nc" variable: "v" weight: 1 time_index: 1 x_axis: "x" y_axis: "y" z_axis: "z" time_axis: "time" }
}
basis { modes_x: 8 modes_y: 8 modes_z: 8 }
law {
  u_max_mps: 5 regularization: RELATIVE epsilon: 0.2 perturbation: ADAPTIVE noise_intensity: 0.1 noise_ceiling: 2
  contraction_gain_per_s: 0.001 contraction_center: POINT contraction_x_m: 50 contraction_y_m: 25 contraction_z_m: 20
  anticipation: 2
}
time {
  dt_s: 0.1 duration_s: 60 broadcast_period_ticks: 1 high_mode_period_factor: 4 contribution_encoding: FIXED16 pace: REALTIME
}
agents {
  starts { x_m: 10 y_m: 20 z_m: 20 } random_count: 1 quorum: 1
  kind {
    name: "all" count: 2 u_max_mps: 5 noise_intensity: 0.1 noise_ceiling: 2 footprint_sigma_m: 1 quality: 1
    band { from: 0 to: 9 } vehicle { kind: ACCELERATION max_acceleration_mps2: 900 }
    speed_limit_mps: 90
    station { x_m: 20 y_m: 20 z_m: 20 } station { x_m: 60 y_m: 20 z_m: 20 } reserve_s: 20
  }
}
world { speed_limit_mps: 100 }
vehicle { kind: ACCELERATION max_acceleration_mps2: 1000 }
separation { distance_m: 2 lease_s: 0 }
)";

/// What its kind of vehicles does not have.
constexpr const char* kWinged = R"(
domain { size_x_m: 100 size_y_m: 50 }
target {
  uniform_weight: 1
  keep_outs { vertices { x_m: 60 y_m: 10 } vertices { x_m: 70 y_m: 10 } vertices { x_m: 70 y_m: 20 } solid: true }
}
law { u_max_mps: 5 }
time { duration_s: 60 }
agents { starts { x_m: 10 y_m: 20 } }
world {
  speed_limit_mps: 100 wall_clearance_m: 1
  walls { vertices { x_m: 80 y_m: 10 } vertices { x_m: 90 y_m: 10 } vertices { x_m: 90 y_m: 20 } }
}
vehicle { kind: FIXED_WING max_turn_radps: 1 min_speed_mps: 4 }
)";

/// Calls `visit` for each field that takes a number or a word, with its block.
void each_field(
    Block& message, const std::string& path,
    const std::function<void(Block&, const FieldDescriptor&, const std::string&)>& visit) {
  const auto* reflection = message.GetReflection();
  for (int i = 0; i < message.GetDescriptor()->field_count(); ++i) {
    const FieldDescriptor& field = *message.GetDescriptor()->field(i);
    const std::string name = path + field.name();
    if (field.message_type() == nullptr) {
      if (reflection->HasField(message, &field)) visit(message, field, name);
    } else if (field.is_repeated()) {
      for (int j = 0; j < reflection->FieldSize(message, &field); ++j) {
        each_field(*reflection->MutableRepeatedMessage(&message, &field, j),
                   name + "[" + std::to_string(j) + "].", visit);
      }
    } else if (reflection->HasField(message, &field)) {
      each_field(*reflection->MutableMessage(&message, &field), name + ".", visit);
    }
  }
}

class CheckCanFail : public Scenarios {
 protected:
  const char* rich_ = kRich;

  /// rich_ with the defaults of what it leaves out.
  proto::Scenario rich_scenario() const {
    proto::Scenario scenario;
    EXPECT_TRUE(google::protobuf::TextFormat::ParseFromString(rich_, &scenario));
    fill_in(scenario, file_);
    return scenario;
  }

  /// Expects this problem of the field at `path` after `spoil` was applied.
  void expect_said(const std::string& path, const std::string& what,
                   const std::function<void(Block&, const FieldDescriptor&)>& spoil) {
    proto::Scenario scenario = rich_scenario();
    each_field(scenario, "",
               [&](Block& block, const FieldDescriptor& field, const std::string& at) {
                 if (at == path) spoil(block, field);
               });
    std::string text;
    google::protobuf::TextFormat::PrintToString(scenario, &text);
    write("s.textproto", text);
    EXPECT_EQ(ergocast({"check", file_}), 2) << path << what;
    bool found = false;
    for (const std::string& line : note(output())) {
      found = found || (line.starts_with(file_.string() + ":") &&
                        line.find(" " + path + ": ") != line.npos && line.find(what) != line.npos);
    }
    EXPECT_TRUE(found) << path << ": " << what << ":\n" << output();
  }

  void expect_value_refused(const std::string& path, double value, const std::string& what) {
    expect_said(path, what, [value](Block& block, const FieldDescriptor& field) {
      if (field.cpp_type() == FieldDescriptor::CPPTYPE_DOUBLE) {
        block.GetReflection()->SetDouble(&block, &field, value);
      } else {
        block.GetReflection()->SetInt32(&block, &field, static_cast<std::int32_t>(value));
      }
    });
  }

  void expect_limits(const FieldDescriptor& field, const std::string& path, const FieldRule& rule) {
    const bool whole = field.cpp_type() != FieldDescriptor::CPPTYPE_DOUBLE;
    const Range& range = rule.range;
    // The domain's origin is no place in the domain.
    const bool in_domain = range.coordinate && !path.starts_with("domain.");
    const std::string above = in_domain ? " is far outside the domain" : " is above the limit ";
    const std::string too_low = in_domain ? above : " is below the limit ";
    expect_value_refused(path, whole ? range.high + 1 : 1.01 * range.high, above);
    if (range.low_excluded) {
      expect_value_refused(path, range.low, " is not above ");
    } else {
      const double below = range.low - std::abs(range.low) - 1;
      expect_value_refused(path, whole ? range.low - 1 : below, too_low);
    }
    if (!whole) expect_value_refused(path, std::nan(""), "nan is not a number");
    if (rule.absence != Absence::kRefused) return;
    expect_said(path, "is missing", [](Block& block, const FieldDescriptor& one) {
      block.GetReflection()->ClearField(&block, &one);
    });
  }

  /// Each field at its limits, and missing.
  void plant_in_fields() {
    std::set<std::string> covered;
    for (const char* text : {kRich, kWinged}) {
      rich_ = text;
      plant_in_fields_of_rich(covered);
    }
    const auto* file = proto::Scenario::descriptor()->file();
    for (int i = 0; i < file->message_type_count(); ++i) {
      for (int j = 0; j < file->message_type(i)->field_count(); ++j) {
        const FieldDescriptor& field = *file->message_type(i)->field(j);
        if (field.message_type() != nullptr) continue;
        EXPECT_TRUE(covered.contains(field.full_name()))
            << field.full_name() << ": add it to kRich";
      }
    }
  }

  void plant_in_fields_of_rich(std::set<std::string>& covered) {
    write("s.textproto", rich_);
    EXPECT_EQ(ergocast({"check", file_}), 0) << output();
    proto::Scenario rich = rich_scenario();
    each_field(rich, "", [&](Block&, const FieldDescriptor& field, const std::string& path) {
      if (!covered.insert(field.full_name()).second) return;
      if (const FieldRule* rule = rule_of(field)) expect_limits(field, path, *rule);
      if (field.enum_type() == nullptr) return;
      expect_said(path, "has no value 99", [](Block& block, const FieldDescriptor& one) {
        block.GetReflection()->SetEnumValue(&block, &one, 99);
      });
    });
  }

  void plant_in_the_text() {
    write("s.textproto", kGood);
    EXPECT_EQ(ergocast({"check", file_}), 0) << output();
    for (const auto& mistakes :
         {mistakes_of_the_text(), mistakes_between_fields(), mistakes_of_targets(),
          mistakes_of_maps(), mistakes_of_kinds(), mistakes_of_free_domains(), mistakes_of_walls(),
          mistakes_of_stations(), mistakes_in_space()}) {
      for (const Mistake& mistake : mistakes) expect_mistake(mistake);
    }
  }

  void expect_refused(std::vector<std::string> arguments, const std::string& what) {
    EXPECT_EQ(ergocast(std::move(arguments)), 2) << what << ":\n" << output();
    note(output());
    EXPECT_NE(output().find(what), std::string::npos) << what << ":\n" << output();
  }

  /// Invalid files, and flags.
  void plant_outside_the_text() {
    write("s.textproto", kGood);
    expect_refused({"check", folder_ / "none.textproto"}, "none.textproto: there is no such file");
    expect_refused({"check", folder_}, ": is a folder, not a file");
    expect_refused({"check", "/dev/zero"}, "/dev/zero: is not a regular file");
    expect_refused({"check", "/proc/self/mem"}, "/proc/self/mem: cannot be read");
    expect_refused({"simulate", file_, "--agents", "1025", "--out", out()},
                   "--agents: 1025 is outside");
    const std::pair<const char*, const char*> flags[] = {
        {"name=a,b", "is a text"},
        {"law.epsilom=1", "did you mean law.epsilon?"},
        {"law.zzzzzz=1", "the fields there are"},
        {"law.epsilon.x=1", "epsilon has no fields of its own"},
        {"law=1", "is a block"},
        {"agents.starts.x_m=1", "there may be several starts"},
        {"law[0].epsilon=1", "there is only one law"},
        {"agents.starts[1].x_m=1", "the scenario lists 1 starts"},
        {"target.gaussians[0].sigma_m=1", "the scenario lists 0 gaussians"},
        {"law.regularization=SOME", "unknown value \"SOME\""},
        {"law.epsilon=1 2", "--vary law.epsilon=1 2: "},
    };
    for (const auto& [flag, what] : flags) {
      expect_refused({"study", file_, "--vary", flag, "--seeds", "1", "--out", out()}, what);
      said_of_flags_.push_back(output());
    }
    expect_refused({"check", file_, "--set", "law.epsilon=1", "--set", "law.epsilon=2"},
                   "--set law.epsilon=1 says it too");
    said_of_flags_.push_back(output());
  }

  void expect_warning(const std::string& law, const std::string& limit, const std::string& what) {
    std::string text = kGood + "world { speed_limit_mps: " + limit + " }\n";
    write("s.textproto", text.insert(text.find("u_max_mps"), law + " "));
    EXPECT_EQ(ergocast({"check", file_}), 0) << output();
    note(output());
    EXPECT_TRUE(output().starts_with("warning: " + file_.string() + ":6:")) << output();
    EXPECT_NE(output().find(what), std::string::npos) << what << ":\n" << output();
  }

  void expect_warning_of_coarse_steps() {
    std::string text = kGood;
    write("s.textproto", text.insert(text.find(kTime), "dt_s: 0.6 "));
    EXPECT_EQ(ergocast({"check", file_}), 0) << output();
    note(output());
    EXPECT_TRUE(output().starts_with("warning: " + file_.string() + ":4:")) << output();
    EXPECT_NE(output().find("time.dt_s: 0.6 is coarse"), std::string::npos) << output();
  }

  void expect_warning_of_rare_modes(const std::string& basis, const std::string& what) {
    std::string text = kGood + "basis { " + basis + " }\n";
    write("s.textproto", text.insert(text.find(kTime), "high_mode_period_factor: 60 "));
    EXPECT_EQ(ergocast({"check", file_}), 0) << output();
    note(output());
    EXPECT_TRUE(output().starts_with("warning: " + file_.string() + ":4:")) << output();
    EXPECT_NE(output().find("time.high_mode_period_factor: 60 " + what), std::string::npos)
        << output();
  }

  void expect_warning_of_packing() {
    std::string text = kGood;
    text.insert(text.find("agents {"),
                "world { speed_limit_mps: 1000 }\nseparation { distance_m: 10 }\n");
    text.replace(text.find("} }\n", text.find("agents {")), 4, "} random_count: 9 }\n");
    write("s.textproto", text);
    EXPECT_EQ(ergocast({"check", file_}), 0) << output();
    note(output());
    EXPECT_TRUE(output().starts_with("warning: " + file_.string() + ":6:")) << output();
    EXPECT_NE(output().find("10 agents 10 m apart take up 15.71 %"), std::string::npos) << output();
  }

  void expect_warning_of_late_vehicles(const std::string& response_s, const std::string& what) {
    write("s.textproto", kGood +
                             "world { speed_limit_mps: 1000 }\nseparation { distance_m: 2 "
                             "response_s: " +
                             response_s + " }\n");
    EXPECT_EQ(ergocast({"check", file_}), 0) << output();
    note(output());
    EXPECT_NE(output().find(what), std::string::npos) << what << ":\n" << output();
  }

  void expect_warning_of_footprints() {
    std::string text = kGood;
    const std::string even = "uniform_weight: 1";
    text.replace(text.find(even), even.size(),
                 "gaussians { mean_x_m: 50 mean_y_m: 25 sigma_m: 4 }");
    text.replace(text.find("} }\n", text.find("agents {")), 4,
                 "} kind { name: \"a\" count: 1 footprint_sigma_m: 15 } }\n");
    write("s.textproto", text);
    EXPECT_EQ(ergocast({"check", file_}), 0) << output();
    note(output());
    EXPECT_TRUE(output().starts_with("warning: " + file_.string() + ":5:")) << output();
    EXPECT_NE(output().find("agents.kind: the target is finer than the sensors see"),
              std::string::npos)
        << output();
  }

  void expect_warning_of_hidden_mass() {
    std::string text = kGood;
    text.insert(text.find(kLaw),
                "world { speed_limit_mps: 1000 " + wall("50 -1 51 -1 51 40 50 40") + "}\n");
    write("s.textproto", text);
    EXPECT_EQ(ergocast({"check", file_}), 0) << output();
    note(output());
    EXPECT_TRUE(output().starts_with("warning: " + file_.string() + ":3:")) << output();
    EXPECT_NE(output().find("world.walls: hide the target from itself"), std::string::npos)
        << output();
  }

  /// Of two agents with these stations 2 m apart.
  void expect_warning_of_homes(const std::string& stations, const std::string& what) {
    std::string text = kGood;
    text.replace(text.find("} }\n", text.find("agents {")), 4,
                 "} starts { x_m: 12 y_m: 20 } kind { name: \"a\" count: 2 " + stations +
                     " } }\nworld { speed_limit_mps: 20 } separation { distance_m: 2 }\n");
    write("s.textproto", text);
    EXPECT_EQ(ergocast({"check", file_}), 0) << output();
    note(output());
    EXPECT_NE(output().find("warning: " + file_.string() + ":5:"), std::string::npos) << output();
    EXPECT_NE(output().find(what), std::string::npos) << what << ":\n" << output();
  }

  void plant_warnings() {
    expect_warning_of_homes("station { x_m: 10 y_m: 9 } station { x_m: 20 y_m: 9 } reserve_s: 0.1",
                            "agents.kind[0].reserve_s: 0.1 is little for 2 agents");
    expect_warning_of_homes("station { x_m: 10 y_m: 9 } station { x_m: 13 y_m: 9 } reserve_s: 20",
                            "agents.kind: agents 0 and 1 have stations that nobody passes between");
    expect_warning_of_hidden_mass();
    expect_warning_of_footprints();
    expect_warning("perturbation: CONSTANT", "3", "at most 3: even without noise");
    expect_warning("noise_ceiling: 2.5", "6", "m/s held for 3 steps");
    expect_warning("noise_ceiling: 0.5", "6", "m/s held for 1 step)");
    expect_warning_of_coarse_steps();
    expect_warning_of_rare_modes("modes_x: 8 modes_y: 8", "has no effect: the basis has 64 modes");
    expect_warning_of_rare_modes("modes_x: 9", "makes 600 ticks between two broadcasts");
    expect_warning_of_packing();
    expect_warning_of_late_vehicles("0.02", "separation.response_s: vehicles that follow so late");
    expect_warning_of_late_vehicles("0.011",
                                    "agents.starts[0]: is nearer to an edge than the 11 m");
  }
};

const std::vector<Unsayable> kUnsayable = {
    {"target/csv_map.cc", "changed while it was read", "the map has to change between two reads"},
    {"target/png_map.cc", "cannot be opened any more", "it was opened a moment before"},
    {"target/netcdf_file.cc", "needs libnetcdf", "this machine has it"},
    {"target/netcdf_file.cc", "write the file again",
     "the file has to be cut off amid its numbers"},
    {"target/netcdf_grid.cc", "is stored in parts of more than", "the classic format has no parts"},
};

TEST_F(CheckCanFail, InEachOfItsFindings) {
  write_files();
  plant_in_fields();
  plant_in_the_text();
  plant_outside_the_text();
  plant_warnings();
  // The texts of override_options.cc are those of --help.
  std::vector<std::string> sources =
      sources_in("scenario", {"scenario/assign.cc", "scenario/override_options.cc"});
  for (const std::string& file : sources_in("target")) sources.push_back(file);
  expect_all_said(sources, said_, kUnsayable);
  expect_all_said({"scenario/assign.cc"}, said_of_flags_, {});
}

}  // namespace
}  // namespace ergocast::test
