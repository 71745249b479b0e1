// SPDX-License-Identifier: BSD-3-Clause
// Each finding of `ergocast check` for a scenario that has it. The scenarios are small edits to a
// good one, and every field outside its limits, which come from the program's own table of fields.
#include <google/protobuf/text_format.h>

#include <cmath>
#include <functional>
#include <set>
#include <sstream>

#include "scenario/compile/defaults.h"
#include "scenario/parse/fields.h"
#include "scenario/scenario.pb.h"
#include "tests/checks_can_fail/expect_said.h"
#include "tests/checks_can_fail/mistaken_files.h"
#include "tests/checks_can_fail/scenario_mistakes.h"
#include "tests/process/support/programs.h"

namespace ergocast::test {
namespace {

namespace fs = std::filesystem;
using google::protobuf::FieldDescriptor;
using Block = google::protobuf::Message;

class Scenarios : public OwnHost {
 protected:
  void write(const std::string& name, const std::string& text) { write_file(folder_ / name, text); }

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
    EXPECT_TRUE(found) << mistake.said << " is not reported for " << mistake.to.substr(0, 200)
                       << ":\n"
                       << output().substr(0, 2000);
  }

  /// Stores the output line by line.
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

// ---- fields by themselves ----

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
  anticipation: 2 memory_half_life_s: 30
}
time {
  dt_s: 0.1 duration_s: 60 broadcast_period_ticks: 1 high_mode_period_factor: 4 contribution_encoding: FIXED16 pace: REALTIME
}
agents {
  starts { x_m: 10 y_m: 20 z_m: 20 } random_count: 1 quorum: 1 footprint_sigma_m: 2 quality: 3
  kind {
    name: "all" count: 2 u_max_mps: 5 noise_intensity: 0.1 noise_ceiling: 2 footprint_sigma_m: 1 quality: 1
    band { from: 0 to: 9 } vehicle { kind: ACCELERATION max_acceleration_mps2: 900 }
    speed_limit_mps: 90
    station { x_m: 20 y_m: 20 z_m: 20 } station { x_m: 60 y_m: 20 z_m: 20 } reserve_s: 20
    battery { capacity_wh: 50 power_w: 100 charge_w: 90 reserve: 0.3 }
  }
}
world { speed_limit_mps: 100 }
vehicle { kind: ACCELERATION max_acceleration_mps2: 1000 }
separation { distance_m: 2 lease_s: 0 }
sensor { radius_m: 5 detections_per_s: 0.5 false_alarms_per_s: 0 position_error_m: 0.5 confirm_at: 0.9 }
)";

/// The fields that its kind of vehicles does not have.
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
  speed_limit_mps: 100 wall_clearance_m: 1 objects { count: 3 end_when_found: 2 motion { speed_mps: 1 persistence_s: 60 } }
  walls { vertices { x_m: 80 y_m: 10 } vertices { x_m: 90 y_m: 10 } vertices { x_m: 90 y_m: 20 } }
  walls { file: "room.yaml" unknown_free: true }
  walls { file: "dot.svg" solid_white: true }
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

  /// rich_ with the defaults of omitted fields.
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
    // The domain's origin is not inside the domain.
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
    for (const Mistake& mistake : scenario_mistakes()) expect_mistake(mistake);
  }

  void expect_refused(std::vector<std::string> arguments, const std::string& what) {
    EXPECT_EQ(ergocast(std::move(arguments)), 2) << what << ":\n" << output();
    note(output());
    EXPECT_NE(output().find(what), std::string::npos) << what << ":\n" << output();
  }

  /// Invalid files, and flags.
  /// `ergocast new` refuses maps, and its scenario is a text, too.
  void plant_in_maps_of_new_scenarios() {
    const auto make = [&](const std::string& map, const std::string& robots,
                          const std::string& radius_m) {
      const fs::path made = folder_ / "new.textproto";
      fs::remove(made);
      const int code = ergocast(
          {"new", "--map", folder_ / map, "--robots", robots, "--radius", radius_m, "--out", made});
      note(output());
      return code;
    };
    EXPECT_EQ(make("room.pgm", "2", "1"), 2) << output();
    EXPECT_EQ(make("hall.yaml", "2", "40"), 2) << output();
    EXPECT_EQ(make("hall.yaml", "1000", "2"), 2) << output();
    EXPECT_EQ(make("hall.yaml", "2", "15"), 2) << output();
    ASSERT_EQ(make("rooms.yaml", "2", "1"), 0) << output();
    said_.push_back(text_of(folder_ / "new.textproto"));
  }
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
                   "--set law.epsilon=1 sets it too");
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

  void expect_warning_of_flat_weights() {
    write("s.textproto", kGood + "basis { sobolev_form: NORM sobolev_exponent: 0.6 }\n");
    EXPECT_EQ(ergocast({"check", file_}), 0) << output();
    note(output());
    EXPECT_NE(output().find("basis.sobolev_exponent: 0.6 lets short waves"), std::string::npos)
        << output();
  }

  void expect_warning_of_short_memory() {
    std::string text = kGood;
    write("s.textproto", text.insert(text.find("u_max_mps"), "memory_half_life_s: 5 "));
    EXPECT_EQ(ergocast({"check", file_}), 0) << output();
    note(output());
    EXPECT_NE(output().find("law.memory_half_life_s: 5 is shorter than the 20 s"),
              std::string::npos)
        << output();
  }

  void expect_warning_of_law(const std::string& kind, const std::string& target,
                             const std::string& what) {
    std::string text = kGood;
    text.insert(text.find("u_max_mps"), "kind: " + kind + " ");
    text.replace(text.find("uniform_weight: 1"), 17, target);
    write("s.textproto", text);
    EXPECT_EQ(ergocast({"check", file_}), 0) << output();
    note(output());
    EXPECT_NE(output().find("law.kind: " + kind + what), std::string::npos) << output();
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
    EXPECT_NE(output().find("world.walls: separate parts of the target"), std::string::npos)
        << output();
  }

  void expect_warning_of_features_without_a_place() {
    std::string text = kGood;
    text.replace(text.find(kUniform), kUniform.size(),
                 "regions { polygon { file: \"nowhere.geojson\" } }");
    write("s.textproto", text + "origin { latitude_deg: 47.5 longitude_deg: 9.2 }\n");
    EXPECT_EQ(ergocast({"check", file_}), 0) << output();
    note(output());
    EXPECT_NE(output().find("features[0]: has no place, and is left out, with 1 more"),
              std::string::npos)
        << output();
  }

  /// The warning for two agents with these stations, 2 m apart.
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
    expect_warning_of_features_without_a_place();
    expect_warning_of_homes("station { x_m: 10 y_m: 9 } station { x_m: 20 y_m: 9 } reserve_s: 0.1",
                            "agents.kind[0].reserve_s: 0.1 is little for 2 agents");
    expect_warning_of_homes(
        "station { x_m: 10 y_m: 9 } station { x_m: 13 y_m: 9 } reserve_s: 20",
        "agents.kind: agents 0 and 1 have stations that no agent can pass between");
    expect_warning_of_hidden_mass();
    expect_warning_of_footprints();
    expect_warning("perturbation: CONSTANT", "3", "at most 3: even without noise");
    expect_warning("noise_ceiling: 2.5", "6", "m/s held for 3 steps");
    expect_warning("noise_ceiling: 0.5", "6", "m/s held for 1 step)");
    expect_warning_of_coarse_steps();
    expect_warning_of_flat_weights();
    expect_warning_of_short_memory();
    expect_warning_of_law("SEARCH", "uniform_weight: 1", " goes from peak to peak");
    expect_warning_of_law("MOW", "gaussians { mean_x_m: 50 mean_y_m: 25 sigma_m: 8 }",
                          " gives all places equal time");
    expect_warning_of_rare_modes("modes_x: 8 modes_y: 8", "has no effect: the basis has 64 modes");
    expect_warning_of_rare_modes("modes_x: 9", "makes 600 ticks between two broadcasts");
    expect_warning_of_packing();
    expect_warning_of_late_vehicles("0.02", "separation.response_s: vehicles that follow so late");
    expect_warning_of_late_vehicles("0.011",
                                    "agents.starts[0]: is nearer to an edge than the 11 m");
  }
};

const std::vector<Unsayable> kUnsayable = {
    {"target/maps/csv_map.cc", "changed while it was read",
     "the map has to change between two reads"},
    {"target/maps/png_reader.cc", "cannot be opened any more", "it was opened a moment before"},
    {"scenario/compile/map_walls.cc", "the wall at x", "no polygon around cells has a flaw"},
    {"scenario/compile/drawn_polygons.cc", "is full of specks",
     "no page of 2 : 1 has as many cells"},
    {"scenario/compile/drawn_polygons.cc", "the shape at x", "no polygon around cells has a flaw"},
    {"target/maps/picture.cc", "is gone, though it was there", "it was opened a moment before"},
    {"target/maps/netcdf_file.cc", "needs libnetcdf", "this machine has it"},
    {"target/maps/netcdf_file.cc", "write the file again",
     "the file has to be cut off amid its numbers"},
    {"target/maps/netcdf_file.cc", "is stored in parts of more than",
     "the classic format has no parts"},
    {"target/maps/netcdf_file.cc", "are in another file", "the classic format names no other file"},
    {"scenario/scenario.cc", "the running mission",
     "the mission is one that a program has written"},
    {"scenario/parse/text.cc", "is longer than the limit", "a file is bounded before it is read"},
};

TEST_F(CheckCanFail, InEachOfItsFindings) {
  write_mistaken_files(folder_);
  plant_in_fields();
  plant_in_the_text();
  plant_outside_the_text();
  plant_in_maps_of_new_scenarios();
  plant_warnings();
  // The texts of scenario/parse/override_options.cc are those of --help. `check` reads no targets
  // for running missions, and no zones; tests/scenario/new_target_test.cc and zone_files_test.cc
  // have their texts.
  std::vector<std::string> sources;
  for (const char* folder : {"scenario", "scenario/parse", "scenario/rules", "scenario/compile",
                             "target", "target/contour", "target/maps"}) {
    for (const std::string& file :
         sources_in(folder, {"scenario/parse/assign.cc", "scenario/parse/override_options.cc",
                             "scenario/compile/new_target.cc", "scenario/zone_file.cc"}))
      sources.push_back(file);
  }
  expect_all_said(sources, said_, kUnsayable);
  expect_all_said({"scenario/parse/assign.cc"}, said_of_flags_, {});
}

}  // namespace
}  // namespace ergocast::test
