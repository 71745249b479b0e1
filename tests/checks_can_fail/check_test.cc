// SPDX-License-Identifier: BSD-3-Clause
// Each finding of `ergocast check` for a scenario that has it. The scenarios are small edits to a
// good one, and those of planted_fields.h.
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "tests/checks_can_fail/expect_said.h"
#include "tests/checks_can_fail/mistaken_files.h"
#include "tests/checks_can_fail/planted_fields.h"
#include "tests/checks_can_fail/scenario_mistakes.h"

namespace ergocast::test {
namespace {

namespace fs = std::filesystem;

class CheckCanFail : public PlantedFields {
 protected:
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
