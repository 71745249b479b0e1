// SPDX-License-Identifier: BSD-3-Clause
// Small edits to a good scenario: its text, relations between fields, kinds, walls and stations.
#include "tests/checks_can_fail/scenario_mistakes.h"

namespace ergocast::test {
namespace {

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

/// A distance among vehicles of 20 m/s; then the law, unless the text has its own.
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
      {"size_x_m: 100", "size_x_m: 100 size_z_m: 40 origin_z_m: 10000001", "domain.origin_z_m: "},
      {kLaw, "basis { modes_x: 1 modes_y: 1 } law {", "basis: a single mode"},
      {"u_max_mps: 5", "u_max_mps: 501", "law.u_max_mps: 501 makes u_max_mps"},
      {kLaw, "law { noise_intensity: 159", "law.noise_intensity: 159 makes"},
      {kLaw, "law { noise_ceiling: 159", "law.noise_ceiling: 159 makes"},
      {kLaw, "law { noise_intensity: 3 noise_ceiling: 2", "law.noise_ceiling: 2 is below"},
      {kLaw, "law { perturbation: CONSTANT noise_ceiling: 2", "law.noise_ceiling: has no effect"},
      {kLaw, "law { contraction_gain_per_s: 0.1", "law.u_max_mps: 5 is too weak"},
      {"u_max_mps: 5", "", "law.u_max_mps: is missing, and agents need a speed"},
      {kLaw, "law { memory_half_life_s: 0.99", "law.memory_half_life_s: 0.99 is below 10 steps"},
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
      {kTime,
       "duration_s:\xc2\xa0"
       "60",
       "a character outside of quotes is not ASCII"},
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
       "separation.lease_s: means that no process knows all places"},
      {kLaw, keeping("distance_m: 5 lease_s: 2", "radio_range_m: 50"),
       "separation.lease_s: needs the beacons of all agents to reach all others"},
      {kLaw, keeping("distance_m: 5 lease_s: 2 disturbance_m: 0.1", ""),
       "separation.lease_s: relies on bodies that stay where they stand"},
      {"agents {", keeping("distance_m: 12", "", "agents { random_count: 22 "),
       "separation.distance_m: 23 agents 12 m apart take up"},
      {"agents {", keeping("distance_m: 12", "", "agents { starts { x_m: 19 y_m: 20 } "),
       "agents.starts[1]: is 9 m from starts[0]"},
  };
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

std::vector<Mistake> mistakes_of_walls() {
  const std::string block = "60 10 80 10 80 30 60 30", limit = "speed_limit_mps: 1000 ";
  const auto world = [](const std::string& fields, const std::string& said, bool has_line = true) {
    return Mistake{kLaw, "world { " + fields + " } law {", said, has_line};
  };
  const std::string block_and_limit = limit + wall(block);
  std::string many, grating;
  for (int i = 0; i < 5000; ++i) {
    const std::string x = std::to_string(20 + i / 100.0);
    grating += wall(x + " 1 " + std::to_string(20.002 + i / 100.0) + " 1 " + x + " 40");
  }
  for (int i = 0; i < 5462; ++i) {
    const std::string x = std::to_string(20 + i / 100.0);
    many += wall(x + " 1 " + std::to_string(20.005 + i / 100.0) + " 1 " + x + " 2");
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
      world(limit + many, "world: 16386 vertices of walls are above the limit 16384", false),
      world(limit + grating, "world: thousands of long edges of walls lie side by side", false),
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

std::vector<Mistake> mistakes_of_objects() {
  const auto objects = [](const std::string& fields, const std::string& said,
                          const std::string& more = "") {
    return Mistake{kLaw, "world { objects { " + fields + " } " + more + " } law {", said};
  };
  const std::string place = "places { x_m: 70 y_m: 20 } ";
  return {
      objects("", "world.objects: there are none"),
      objects("count: 2 " + place, "world.objects.count: has no effect with places"),
      objects(repeated(33, place), "world.objects: 33 objects are above the limit 32"),
      objects("places { x_m: 101 y_m: 20 }", "world.objects.places[0]: is outside the domain"),
      objects(place, "world.objects.places[0]: is in a wall",
              "speed_limit_mps: 1000 " + wall("60 10 80 10 80 30 60 30")),
      in_space(kLaw, "world { objects { count: 2 } } law {",
               "world.objects: objects belong to a plane"),
      objects("count: 2 end_when_found: 3",
              "world.objects.end_when_found: 3 is above the number of objects, 2"),
      objects("count: 2 motion { }", "world.objects.motion.speed_mps: is missing"),
      objects("count: 2 motion { speed_mps: 63 }",
              "world.objects.motion.speed_mps: objects would move by more than an eighth"),
      {kTime,
       "dt_s: 0.001 duration_s: 60 } world { objects { count: 32 motion { speed_mps: 1 "
       "persistence_s: 0.001 } }",
       "world.objects.motion: 1920032 legs of all objects are above the limit 262144"},
      objects(place + "end_when_found: 2", "2 is above the number of objects, 1"),
      objects("count: 2 end_when_found: 1",
              "world.objects.end_when_found: with false alarms no agent knows at once",
              "} sensor { false_alarms_per_s: 0.1"),
      {kLaw, "sensor { radius_m: 5 position_error_m: 2.6 } law {",
       "sensor.position_error_m: 2.6 m is above half of the sensor's radius"},
      in_space(kLaw, "sensor { false_alarms_per_s: 0.1 } law {",
               "sensor.false_alarms_per_s: reports belong to a plane"),
      {"agents {",
       "world { objects { count: 2 end_when_found: 1 } } agents { kind { name: \"a\" count: 1 "
       "station { x_m: 10 y_m: 20 } }",
       "world.objects.end_when_found: the agents would have no time to go"},
  };
}

std::vector<Mistake> mistakes_of_sites() {
  const std::string one = "team { sites: 1 } ";
  const auto excludes = [](const std::string& at, const std::string& text,
                           const std::string& field) {
    return Mistake{at, text, field + ": cannot be with team.sites: "};
  };
  const auto of_time = [&](const std::string& field, const std::string& value) {
    return excludes(kTime, "duration_s: 60 " + field + ": " + value + " } team { sites: 1",
                    "time." + field);
  };
  return {
      {kLaw, "team { sites: 2 } law {", "team.sites: 2 is above the limit, the team's size 1"},
      {"agents {", one + "agents { random_count: 1024",
       "team.sites: 1025 agents of a site are above the limit 1024"},
      {kLaw, "team { site_row_period_ticks: 3 } law {",
       "team.site_row_period_ticks: has no effect without sites"},
      excludes(kLaw, one + "law { kind: MOW", "law.kind"),
      excludes(kLaw, one + "law { anticipation: 0", "law.anticipation"),
      excludes(kLaw, one + "law { memory_half_life_s: 30", "law.memory_half_life_s"),
      excludes("agents {", one + "agents { dead_reckoning: false", "agents.dead_reckoning"),
      of_time("pace", "REALTIME"),
      of_time("contribution_encoding", "FIXED16"),
      excludes(kLaw, one + "world { radio_range_m: 50 } law {", "world.radio_range_m"),
      excludes(kLaw,
               one + "world { speed_limit_mps: 1000 " + wall("60 10 80 10 80 30 60 30") + "} law {",
               "world.walls"),
      excludes(kLaw, one + keeping("distance_m: 5", ""), "separation"),
      excludes(kLaw, one + "world { objects { count: 2 end_when_found: 1 } } law {",
               "world.objects.end_when_found"),
      excludes("agents {",
               one + "agents { kind { name: \"a\" count: 1 station { x_m: 10 y_m: 20 } }",
               "agents.kind"),
  };
}

std::vector<Mistake> mistakes_of_room_maps() {
  const auto map = [](const std::string& file) { return "file: \"" + file + ".yaml\" "; };
  std::vector<Mistake> mistakes = {
      {kLaw, "world { speed_limit_mps: 1000 walls { unknown_free: true } } law {",
       "world.walls[0].unknown_free: is for occupancy maps"},
      {kUniform, kUniform + " keep_outs { " + map("room") + "}",
       "target.keep_outs[0].file: names an occupancy map"},
      {kUniform, "maps { " + map("turned") + "weight: 1 }", "turned.yaml lies turned by its yaw"},
      {kLaw, "world { speed_limit_mps: 1000 walls { " + map("dark") + "} } law {",
       "agents.starts[0]: is in unknown space of ", false},
      {kLaw,
       "world { speed_limit_mps: 1000 wall_clearance_m: 3 walls { " + map("nook") + "} } law {",
       "agents.starts[0]: is in free space of ", false},
  };
  for (const char* name :
       {"wrong",    "percent", "fancy", "other", "again",  "grey",    "bare",  "lacks", "indented",
        "nameless", "gone",    "point", "words", "pair",   "apart",   "solid", "white", "cut",
        "more",     "colour",  "shape", "bits",  "bright", "letters", "lace",  "dots",  "noise"}) {
    mistakes.push_back({kLaw, "world { speed_limit_mps: 1000 walls { " + map(name) + "} } law {",
                        "world.walls[0].file: "});
  }
  return mistakes;
}

/// Stations where no agent can stay, or which it cannot reach in time.
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
  // A slot in which a body just fits; it is too narrow for a path over a table of cells.
  const std::string slot = "world { speed_limit_mps: 1000 wall_clearance_m: 2 " +
                           wall("60 10 80 10 80 40 72.3 40 72.3 15 68.2 15 68.2 40 60 40") + "}";
  const std::string one = start + second + " kind { name: \"a\" count: 2 ";
  return {
      {start, start + " random_count: 2 kind { name: \"a\" count: 3 " + near + near + "}",
       "agents.kind[0].station[1]: the kind has 3 agents and 2 stations"},
      home("reserve_s: 5", "agents.kind[0].reserve_s: has no effect without a station"),
      home("battery { capacity_wh: 1 power_w: 1 }",
           "agents.kind[0].battery: has no effect without a station"),
      home(near + "battery { capacity_wh: 1 power_w: 36000 }",
           "agents.kind[0].battery: lasts for "),
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

/// Fields that exclude the modes of a free domain.
std::vector<Mistake> mistakes_of_free_domains() {
  const std::string few = "basis { modes_x: 5 modes_y: 4 free_domain: true";
  const std::string start = "starts { x_m: 10 y_m: 20 }";
  const auto kind = [&](const std::string& sees, const std::string& said) {
    return Mistake{start, start + " kind { name: \"a\" count: 1 " + sees + " } } " + few, said};
  };
  return {
      {kLaw, "basis { modes_x: 21 modes_y: 20 free_domain: true } law {",
       "basis.free_domain: 420 modes are above the limit of a free domain"},
      {kLaw,
       "world { speed_limit_mps: 100 " + wall("20 -5 105 -5 105 55 20 55") +
           "} basis { modes_x: 20 modes_y: 20 free_domain: true } law {",
       "basis.free_domain: the free domain has no modes"},
      in_space(kLaw, few + " } law {", "basis.free_domain: needs a plane"),
      in_space(kLaw, "law { kind: SEARCH", "law.kind: SEARCH needs a plane"),
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
  };
}

}  // namespace

std::vector<Mistake> scenario_mistakes() {
  std::vector<Mistake> all;
  for (const auto& mistakes :
       {mistakes_of_the_text(), mistakes_between_fields(), target_mistakes(), mistakes_of_kinds(),
        mistakes_of_free_domains(), mistakes_of_walls(), mistakes_of_stations(),
        mistakes_of_objects(), mistakes_of_sites(), mistakes_of_room_maps(), mistakes_in_space()}) {
    all.insert(all.end(), mistakes.begin(), mistakes.end());
  }
  return all;
}

}  // namespace ergocast::test
