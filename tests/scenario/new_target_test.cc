// SPDX-License-Identifier: BSD-3-Clause
// Targets for a running mission: from scenarios and from files that are a target by themselves, and
// what is refused.
#include <gtest/gtest.h>

#include <fstream>

#include "logger/mission_text.h"
#include "tests/scenario/scenarios.h"
#include "tests/support/temp_folder.h"

namespace ergocast {
namespace {

using namespace test;

class NewTarget : public ::testing::Test {
 protected:
  std::filesystem::path write(const std::string& name, const std::string& text) {
    std::ofstream(folder_.path() / name, std::ios::binary) << text;
    return folder_.path() / name;
  }
  Loaded load(const std::string& name, const std::string& text, const Overrides& overrides = {}) {
    return Scenario::load_target(write(name, text), overrides, running_);
  }
  std::string problem_of(const std::string& name, const std::string& text,
                         const Overrides& overrides = {}) {
    const Loaded loaded = load(name, text, overrides);
    return loaded ? "" : joined(loaded.error());
  }
  /// μ of a scenario that has this target from the beginning.
  Coefficients mu_of(const std::string& target) {
    const auto file = write("whole.textproto", small_with("uniform_weight: 1", target));
    return good(Scenario::load(file)).mission().target_coefficients;
  }

  const TempFolder folder_;
  const Mission mission_ = good(kSmall).mission();
  std::string running_ = mission_text(mission_);
};

constexpr const char* kEast =
    "regions { polygon { vertices { x_m: 50 y_m: 0 } vertices { x_m: 100 y_m: 0 } vertices { x_m: "
    "100 y_m: 50 } vertices { x_m: 50 y_m: 50 } } }";

TEST_F(NewTarget, OfAScenarioIsCompiledForTheRunningMission) {
  const std::string target = std::string("target { ") + kEast + " }";
  const Scenario alone = good(load("alone.textproto", target));
  EXPECT_EQ(alone.mission().target_coefficients, mu_of(kEast));
  Mission rest = alone.mission();
  rest.target_coefficients = mission_.target_coefficients;
  EXPECT_EQ(encode_plan(rest), encode_plan(mission_)) << "the rest is the running mission's";
  // Other fields of the scenario do not count.
  const Scenario whole =
      good(load("other.textproto", target + "domain { size_x_m: 100 size_y_m: 50 } "
                                            "basis { modes_x: 3 modes_y: 3 } seed: 9"));
  EXPECT_EQ(whole.mission().target_coefficients, mu_of(kEast));
  EXPECT_EQ(whole.mission().seed, mission_.seed);
}

TEST_F(NewTarget, OfAFileCoversTheDomain) {
  const Coefficients east = mu_of(kEast);
  const auto distance = [&](const std::string& name, const std::string& text) {
    return (good(load(name, text)).mission().target_coefficients - east).cwiseAbs().maxCoeff();
  };
  EXPECT_LT(distance("map.csv", "0,1\n0,1\n"), 1e-12);
  EXPECT_LT(distance("MAP.CSV", "0,1\n"), 1e-12);
  EXPECT_LT(distance("map.asc", "ncols 2\nnrows 1\nxllcorner 0\nyllcorner 0\ncellsize 50\n0 1\n"),
            1e-12);
  EXPECT_LT(distance("map.svg",
                     "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 100 50'>"
                     "<rect x='50' y='0' width='50' height='50'/></svg>"),
            1e-12);
}

TEST_F(NewTarget, OfGeoJsonNeedsThePlaceOnTheEarth) {
  const std::string square =
      R"({"type":"Polygon","coordinates":[[[10,50],[10.001,50],[10.001,50.001],[10,50.001],[10,50]]]})";
  EXPECT_TRUE(has(problem_of("place.geojson", square), "needs to know where on the earth"));
  running_ += "origin { latitude_deg: 50 longitude_deg: 10 }";
  EXPECT_EQ(problem_of("place.geojson", square), "");
  EXPECT_TRUE(has(problem_of("elsewhere.textproto",
                             "target { uniform_weight: 1 } origin { latitude_deg: 51 "
                             "longitude_deg: 10 }"),
                  "elsewhere.textproto:1:30: origin: is not that of the running mission"));
}

TEST_F(NewTarget, ChangesOnlyFieldsOfTheTarget) {
  Overrides overrides;
  overrides.fields = {{"target.uniform_weight", "2", "--set target.uniform_weight=2"}};
  const std::string both = "target { uniform_weight: 1 " + std::string(kEast) + " }";
  EXPECT_EQ(good(load("a.textproto", both, overrides)).mission().target_coefficients,
            mu_of("uniform_weight: 2 " + std::string(kEast)));
  overrides.fields.push_back({"law.u_max_mps", "2", "--set law.u_max_mps=2"});
  EXPECT_TRUE(has(problem_of("a.textproto", both, overrides),
                  "--set law.u_max_mps=2: only the target of a running mission can change"));
}

TEST_F(NewTarget, IsRefusedWithItsPlaceAndARemedy) {
  EXPECT_TRUE(has(problem_of("a.textproto",
                             "target { uniform_weight: 1 }\n"
                             "domain { size_x_m: 10 size_y_m: 50 }"),
                  "a.textproto:2:1: domain: has 10, 50 m from (0, 0); that of the running mission "
                  "has 100, 50 m from (0, 0)"));
  EXPECT_TRUE(has(problem_of("a.textproto",
                             "target {\n gaussians { mean_x_m: 5000 mean_y_m: 5 "
                             "sigma_m: 1 } }"),
                  "a.textproto:1:1: target: only "));
  EXPECT_TRUE(has(problem_of("a.textproto", "target {\n uniform_wait: 1 }"), "a.textproto:2:"));
  EXPECT_TRUE(has(problem_of("a.textproto", "seed: 1"), "target"));
  EXPECT_TRUE(has(problem_of("a.tif", ""), "needs to know where on the earth"));
  EXPECT_TRUE(has(problem_of("a.nc", ""), "a NetCDF file may have several variables"));
  EXPECT_TRUE(has(problem_of("a.csv", "0,0\n"), "has no number above 0"));
  const Loaded missing = Scenario::load_target(folder_.path() / "none.csv", {}, running_);
  ASSERT_FALSE(missing);
  EXPECT_TRUE(has(joined(missing.error()), "there is no such file"));
}

constexpr const char* kBlock =
    "{ vertices { x_m: 60 y_m: 20 } vertices { x_m: 70 y_m: 20 } vertices { x_m: 70 y_m: 30 } "
    "vertices { x_m: 60 y_m: 30 } solid: true }";

TEST_F(NewTarget, KeepsTheWallsOfTheMission) {
  const std::string target = "target { uniform_weight: 1 keep_outs " + std::string(kBlock) + " }";
  EXPECT_TRUE(
      has(problem_of("walls.textproto", target),
          "target.keep_outs[0].solid: makes a wall, and it is none of the running mission"));
  std::string walled = small_with("target { uniform_weight: 1 }", target);
  walled += "world { speed_limit_mps: 10 }";
  const Scenario scenario = good(walled);
  running_ = mission_text(scenario.mission());
  const auto same = [&](const std::string& text) {
    return (good(load("walls.textproto", text)).mission().target_coefficients -
            scenario.mission().target_coefficients)
               .cwiseAbs()
               .maxCoeff() < 1e-12;
  };
  EXPECT_TRUE(same(target));
  EXPECT_TRUE(same("target { uniform_weight: 1 }")) << "walls have no mass";
  EXPECT_TRUE(same(walled));
  EXPECT_TRUE(same(scenario.print())) << "as it is in a run's directory";
  EXPECT_TRUE(has(problem_of("inside.textproto",
                             "target { gaussians { mean_x_m: 65 mean_y_m: 25 sigma_m: 0.1 } }"),
                  "of its weight is inside the domain and outside the keep-outs"));
}

}  // namespace
}  // namespace ergocast
