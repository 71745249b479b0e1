// SPDX-License-Identifier: BSD-3-Clause
// The measures of a team against closed forms, and against objects that are drawn and sought.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "core/measure/cells.h"
#include "core/measure/detection.h"
#include "core/measure/target_mass.h"
#include "core/measure/team_measures.h"
#include "core/measure/transport.h"

namespace ergocast {
namespace {

using Eigen::Vector3d;

/// A mission in a square of 100 m with a uniform target.
Mission square() {
  Mission mission;
  mission.domain = {{0, 0, 0}, {100, 100, 0}};
  mission.basis.modes_x = mission.basis.modes_y = 8;
  mission.target_coefficients = Coefficients::Zero(mission.basis.mode_count());
  mission.target_coefficients[0] = 1;
  mission.timing.dt_s = 0.1;
  mission.timing.tick_count = 1000;
  mission.law.u_max_mps = 1e4;  // sensors look at each tick
  mission.sensor = {.radius_m = 10, .detections_per_s = 0.5};
  return mission;
}

double sum(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum;
}

TEST(Cells, AreLimitedInNumberInAnyDomain) {
  for (const Vector3d& size_m :
       {Vector3d(100, 100, 0), Vector3d(1e6, 1, 0), Vector3d(3, 2, 1), Vector3d(1e5, 1, 1e-2)}) {
    const Cells cells({{-5, 3, 0}, size_m}, 1e-4);
    EXPECT_LE(cells.total(), kMaxMeasureCells);
    EXPECT_GT(cells.total(), kMaxMeasureCells / 8);
    EXPECT_EQ(cells.cell_of({-5, 3, 0}), 0u);
    EXPECT_EQ(cells.cell_of(cells.domain.origin_m + size_m), cells.total() - 1);
  }
}

TEST(TargetMass, IsTheDensityOfTheModes) {
  Mission mission = square();
  mission.target_coefficients[mission.basis.modes_y] = 0.25;  // p V = 1 + ½ cos(πx/100)
  const Cells cells = measure_cells(mission);
  const auto mass = target_mass(mission.basis, mission.walls, mission.target_coefficients, cells);
  EXPECT_NEAR(sum(mass), 1, 1e-12);
  const auto each = 1 / static_cast<double>(cells.total());
  EXPECT_NEAR(mass[cells.cell_of({0.1, 50, 0})] / each, 1.5, 1e-3);
  EXPECT_NEAR(mass[cells.cell_of({99.9, 50, 0})] / each, 0.5, 1e-3);
}

TEST(TargetMass, IsNotInWallsButInTheirRooms) {
  Mission mission = square();
  mission.walls = {{{20, 20}, {80, 20}, {80, 80}, {20, 80}},
                   {{40, 40}, {60, 40}, {60, 60}, {40, 60}}};
  const Cells cells = measure_cells(mission);
  const auto mass = target_mass(mission.basis, mission.walls, mission.target_coefficients, cells);
  EXPECT_NEAR(sum(mass), 1, 1e-12);
  EXPECT_EQ(mass[cells.cell_of({30, 50, 0})], 0);
  EXPECT_EQ(mass[cells.cell_of({50, 30, 0})], 0);
  EXPECT_GT(mass[cells.cell_of({50, 50, 0})], 0);
  EXPECT_GT(mass[cells.cell_of({10, 50, 0})], 0);
}

TEST(Detection, OfASensorThatStandsStillIsTheShareOfItsCircle) {
  const Mission mission = square();
  const double share = std::numbers::pi * 10 * 10 / 1e4,
               expected = share * (1 - std::exp(-0.5 * 10));
  constexpr int kPlaces = 40;
  double mean = 0;  // over places in their cells: a cell counts if its middle is near
  for (int place = 0; place < kPlaces; ++place) {
    TeamMeasures team(mission);
    for (Tick tick = 0; tick < 100; ++tick) {
      team.see(0, tick, {45 + 0.37 * place, 35 + 0.61 * place, 0}, true);
      team.pass(tick);
    }
    const TeamFigures figures = team.figures();
    EXPECT_NEAR(figures.detection_probability, expected, 0.2 * expected);
    EXPECT_FALSE(figures.half_time_s);
    EXPECT_EQ(figures.greatest_age_s, 10);  // most places were never seen
    EXPECT_EQ(figures.path_m, 0);
    mean += figures.detection_probability / kPlaces;
  }
  EXPECT_NEAR(mean, expected, 0.01 * expected);
}

TEST(Detection, OfASensorInABoxIsTheShareOfItsSphere) {
  Mission mission = square();
  mission.domain.size_m.z() = 100;
  mission.basis.modes_z = 2;
  mission.target_coefficients = Coefficients::Zero(mission.basis.mode_count());
  mission.target_coefficients[0] = 1;
  mission.sensor.radius_m = 30;
  const double share = 4 * std::numbers::pi / 3 * 0.3 * 0.3 * 0.3;
  constexpr int kPlaces = 40;
  double mean = 0;  // over places in their cells
  for (int place = 0; place < kPlaces; ++place) {
    TeamMeasures team(mission);
    for (Tick tick = 0; tick < 50; ++tick) {
      team.see(0, tick, {45 + 0.37 * place, 35 + 0.61 * place, 40 + 0.53 * place}, true);
      team.pass(tick);
    }
    mean += team.figures().detection_probability / kPlaces;
  }
  EXPECT_NEAR(mean, share * (1 - std::exp(-0.5 * 5)), 0.02 * share);
}

// An elongated box has one layer of long cells.
TEST(Detection, ReachesACellFromEachPlace) {
  for (const Vector3d& size_m : {Vector3d(1e5, 1, 1e-2), Vector3d(1e6, 1, 0), Vector3d(900, 7, 2),
                                 Vector3d(1000, 1000, 2), Vector3d(30, 20, 10)}) {
    Mission mission = square();
    mission.domain.size_m = size_m;
    mission.basis.modes_z = mission.domain.planar() ? 1 : 2;
    mission.target_coefficients = Coefficients::Zero(mission.basis.mode_count());
    mission.target_coefficients[0] = 1;
    mission.sensor.radius_m = 1e-3;
    const Detection fresh(mission);
    constexpr int kPlaces = 23;
    for (int place = 0; place < kPlaces; ++place) {
      Detection detection = fresh;
      detection.begin_target(std::vector<double>(fresh.cells().total(), 1e-6), 0);
      for (Tick tick = 0; tick < ticks_per_look(mission, fresh.cells()); ++tick)
        detection.see(tick, (place + 0.5) / kPlaces * size_m);
      EXPECT_GT(detection.probability(), 0) << size_m.transpose() << ", place " << place;
    }
  }
}

TEST(Detection, IsCertainAtMost) {
  Mission mission = square();
  for (int i = 1; i < 8; ++i) mission.target_coefficients[i] = 0.1;
  for (const double radius_m : {2.0, 3.0, 5.0, 8.0}) {
    mission.sensor = {.radius_m = radius_m, .detections_per_s = 1e6};
    TeamMeasures team(mission);
    Tick tick = 0;
    for (double x_m = 0.5; x_m < 100; ++x_m)
      for (double y_m = 0.5; y_m < 100; ++y_m) team.see(0, tick++, {x_m, y_m, 0}, true);
    EXPECT_LE(team.figures().detection_probability, 1);
    EXPECT_NEAR(team.figures().detection_probability, 1, 1e-12);
  }
}

TEST(Detection, AddsUpOverSensorsAndNamesTheTimesOfShares) {
  Mission mission = square();
  mission.sensor = {.radius_m = 200, .detections_per_s = 0.25};  // sees everything
  TeamMeasures team(mission);
  for (Tick tick = 0; tick < 60; ++tick) {
    team.see(0, tick, {50, 50, 0}, true);
    team.see(1, tick, {10, 50, 0}, true);
    team.see(2, tick, {10, 10, 0}, false);  // does not cover
    team.pass(tick);
  }
  const TeamFigures figures = team.figures();
  EXPECT_NEAR(figures.detection_probability, 1 - std::exp(-0.5 * 6), 1e-9);
  ASSERT_TRUE(figures.half_time_s && figures.four_fifths_time_s);
  EXPECT_NEAR(*figures.half_time_s, std::ceil(10 * std::log(2) / 0.5) / 10, 1e-9);
  EXPECT_NEAR(*figures.four_fifths_time_s, std::ceil(10 * std::log(5) / 0.5) / 10, 1e-9);
  EXPECT_EQ(figures.greatest_age_s, 0);
}

TEST(Detection, BeginsAgainWithANewTarget) {
  Mission mission = square();
  mission.sensor.radius_m = 200;
  TeamMeasures team(mission);
  const auto look = [&](Tick first, Tick last) {
    for (Tick tick = first; tick < last; ++tick) {
      team.see(0, tick, {50, 50, 0}, true);
      team.pass(tick);
    }
  };
  look(0, 40);
  team.begin_target(mission, mission.target_coefficients, 40);
  EXPECT_EQ(team.figures().detection_probability, 0);
  EXPECT_TRUE(std::isnan(team.figures().wasserstein_m));
  look(40, 60);
  EXPECT_NEAR(team.figures().detection_probability, 1 - std::exp(-0.5 * 2), 1e-9);
  EXPECT_NEAR(*team.figures().half_time_s, 1.4, 1e-9);
}

TEST(Detection, HasTheLongestTimeForWhichAPlaceWasLeftAlone) {
  Mission mission = square();
  mission.sensor.radius_m = 200;
  TeamMeasures team(mission);
  const auto at = [&](Tick tick) {
    team.see(0, tick, {50, 50, 0}, true);
    team.pass(tick);
  };
  at(3);
  at(10);
  for (Tick tick = 11; tick < 15; ++tick) team.pass(tick);
  EXPECT_NEAR(team.figures().greatest_age_s, 0.6, 1e-9);  // ticks 4 to 9
}

TEST(Detection, LooksSeldomForSlowAgents) {
  Mission mission = square();
  mission.law.u_max_mps = 1;
  mission.timing.dt_s = 0.125;
  TeamMeasures team(mission);
  for (Tick tick = 0; tick < 80; ++tick) {
    team.see(0, tick, {50, 50, 0}, true);
    team.pass(tick);
  }
  const double share = std::numbers::pi * 10 * 10 / 1e4, missed = std::exp(-0.5 * 80 * 0.125);
  EXPECT_NEAR(team.figures().detection_probability, share * (1 - missed), 0.15 * share);
  EXPECT_EQ(team.figures().greatest_age_s, 10);
}

/// A walk like that of a searching robot: straight ahead, with turns at random.
std::vector<Vector3d> walk(std::uint64_t seed, int ticks) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> turn(0, 0.3);
  Vector3d x_m(20, 70, 0);
  double course = 0;
  std::vector<Vector3d> places_m;
  for (int i = 0; i < ticks; ++i) {
    course += turn(random);
    x_m = reflect(x_m + Vector3d(std::cos(course), std::sin(course), 0), square().domain);
    places_m.push_back(x_m);
  }
  return places_m;
}

TEST(Detection, AgreesWithObjectsThatAreDrawnAndSought) {
  const Mission mission = square();
  TeamMeasures team(mission);
  const auto places_m = walk(4711, 900);
  for (std::size_t i = 0; i < places_m.size(); ++i) {
    team.see(0, static_cast<Tick>(i), places_m[i], true);
    team.pass(static_cast<Tick>(i));
  }
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> anywhere(0, 100), chance(0, 1);
  constexpr int kObjects = 20'000;
  int found = 0;
  for (int object = 0; object < kObjects; ++object) {
    const Vector3d at_m(anywhere(random), anywhere(random), 0);
    found += std::ranges::any_of(places_m, [&](const Vector3d& x_m) {
      return (x_m - at_m).norm() <= 10 && chance(random) < 1 - std::exp(-0.5 * 0.1);
    });
  }
  const double drawn = static_cast<double>(found) / kObjects;
  // Four standard deviations of the draw, and half a percent for the cells.
  const double tolerance = 4 * std::sqrt(drawn * (1 - drawn) / kObjects) + 0.005;
  EXPECT_NEAR(team.figures().detection_probability, drawn, tolerance);
  EXPECT_GT(drawn, 0.1);
  EXPECT_LT(drawn, 0.9);
}

TEST(Transport, OfADistributionThatIsMovedIsItsDistanceOverTheRootOfTheAxes) {
  for (const double height_m : {0.0, 100.0}) {
    const Cells cells({{0, 0, 0}, {100, 100, height_m}}, height_m > 0 ? 4 : 1);
    std::vector<double> one(cells.total(), 0), other = one;
    for (int i = 0; i < 30; i += 5) {
      one[cells.cell_of({20.0 + i, 30.5, height_m / 2})] = 1;
      other[cells.cell_of({50.0 + i, 70.5, height_m / 2})] = 2;  // of another sum
    }
    EXPECT_NEAR(sliced_wasserstein_m(cells, one, other), 50 / std::sqrt(height_m > 0 ? 3.0 : 2.0),
                0.8);
    EXPECT_EQ(sliced_wasserstein_m(cells, one, one), 0);
    EXPECT_TRUE(std::isnan(sliced_wasserstein_m(cells, one, std::vector<double>(one.size(), 0))));
  }
}

TEST(Transport, OfTwoSpreadsIsTheDifferenceOfTheirQuantiles) {
  // Uniform over the square, and all in its middle: E of the squared distance, over the axes.
  const Cells cells({{0, 0, 0}, {100, 100, 0}}, 1);
  std::vector<double> one(cells.total(), 1), other(cells.total(), 0);
  other[cells.cell_of({50, 50, 0})] = 1;
  EXPECT_NEAR(sliced_wasserstein_m(cells, one, other), std::sqrt(2 * 1e4 / 12 / 2), 0.3);
}

TEST(TeamMeasures, AddUpThePathsOfAllBodies) {
  TeamMeasures team(square());
  for (Tick tick = 0; tick < 5; ++tick) {
    team.see(0, tick, {10.0 + 3 * static_cast<double>(tick), 10, 0}, true);
    team.see(1, tick, {10, 10 + 4 * static_cast<double>(tick), 0}, false);
  }
  EXPECT_NEAR(team.figures().path_m, 4 * 3 + 4 * 4, 1e-9);
}

}  // namespace
}  // namespace ergocast
