// SPDX-License-Identifier: BSD-3-Clause
// Times the last step of a command if bodies keep distances, for comparison with the control step
// of control_step.cc. All or none of the teammates are near enough to matter.
#include "core/motion/separation.h"

#include <benchmark/benchmark.h>

#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include "core/motion/wall_following.h"

namespace ergocast::bench {
namespace {

constexpr double kSpeed_mps = 40;

Mission mission_with(double error_m) {
  Mission mission;
  mission.domain.size_m = {2000, 2000, 0};
  mission.speed_limit_mps = kSpeed_mps;
  mission.separation.distance_m = 30;
  mission.separation.position_error_m = error_m;
  return mission;
}

/// Teammates within the 8 m in which two bodies must slow down; many situations, because their
/// costs differ.
void KeepApart(benchmark::State& state) {
  constexpr std::size_t kSituations = 997;
  const auto teammates = static_cast<int>(state.range(0));
  const auto error_m = static_cast<double>(state.range(1));
  SeparationFilter filter(mission_with(error_m), 0);
  std::mt19937 draw(1);
  std::uniform_real_distribution<double> share(0, 1);
  std::vector<std::vector<Neighbour>> situations(kSituations);
  for (auto& others : situations) {
    for (AgentId id = 1; id <= teammates; ++id) {
      const double angle = 2 * M_PI * share(draw);
      const double rho_m = filter.contact_m(0, id) + 2 * error_m + 8 * share(draw);
      const Eigen::Vector3d away(std::cos(angle), std::sin(angle), 0);
      others.push_back({id, Eigen::Vector3d(1000, 1000, 0) + rho_m * away, kSpeed_mps});
    }
  }
  Mover self{0, 0, {1000, 1000, 0}, kSpeed_mps};
  for (auto _ : state) {
    const auto angle = static_cast<double>(++self.tick);
    const auto& others = situations[static_cast<std::size_t>(self.tick) % kSituations];
    benchmark::DoNotOptimize(
        filter.safe(self, {30 * std::cos(angle), 30 * std::sin(angle), 0}, others));
  }
}
BENCHMARK(KeepApart)->ArgNames({"near", "error_m"})->ArgsProduct({{0, 6, 63}, {0, 2}});

/// Vehicles of up to 20 m/s. Their braking paths, up to 40 m, are near each other, or they are
/// within 4 m of contact.
void KeepWaysApart(benchmark::State& state, const VehicleLimits& vehicle) {
  Mission mission = mission_with(0);
  mission.speed_limit_mps = 20;
  mission.vehicle = vehicle;
  SeparationFilter filter(mission, 0);
  std::mt19937 draw(1);
  std::uniform_real_distribution<double> share(-1, 1);
  const bool brakes = vehicle.kind == VehicleKind::kAcceleration;
  const double middle_m = brakes ? 70 : filter.contact_m(0, 1) + 2, spread_m = brakes ? 20 : 2;
  std::vector<Neighbour> others;
  for (AgentId id = 1; id <= state.range(0); ++id) {
    const double angle = M_PI * share(draw);
    const Eigen::Vector3d away(std::cos(angle), std::sin(angle), 0);
    others.push_back({id,
                      Eigen::Vector3d(1000, 1000, 0) + (middle_m + spread_m * share(draw)) * away,
                      20,
                      0,
                      true,
                      {14 * share(draw), 14 * share(draw), 0}});
  }
  Mover self{0, 0, {1000, 1000, 0}, 20, {10, 0, 0}};
  for (auto _ : state) {
    const auto angle = static_cast<double>(++self.tick);
    benchmark::DoNotOptimize(
        filter.safe(self, {20 * std::cos(angle), 20 * std::sin(angle), 0}, others));
  }
}
BENCHMARK_CAPTURE(KeepWaysApart, Inertia, {VehicleKind::kAcceleration, 5})->Arg(6)->Arg(63);
BENCHMARK_CAPTURE(KeepWaysApart, Unicycles, {VehicleKind::kUnicycle, 0, 1})->Arg(6)->Arg(63);
BENCHMARK_CAPTURE(KeepWaysApart, Wings, {VehicleKind::kFixedWing, 0, 0.35, 8})->Arg(6)->Arg(63);

/// Teammates that are all far away.
void NobodyNear(benchmark::State& state) {
  SeparationFilter filter(mission_with(0), 0);
  std::vector<Neighbour> others;
  for (AgentId id = 1; id < 64; ++id) others.push_back({id, {20.0 * id, 100, 0}, kSpeed_mps});
  const Mover self{0, 0, {1000, 1000, 0}, kSpeed_mps};
  for (auto _ : state) benchmark::DoNotOptimize(filter.safe(self, {30, 20, 0}, others));
}
BENCHMARK(NobodyNear);

/// A field of square pillars with so many vertices in all, and a body that goes between them along
/// a line from place to place.
void AmongWalls(benchmark::State& state) {
  const auto side = static_cast<int>(std::lround(std::sqrt(state.range(0) / 4.0)));
  constexpr double kSpacing_m = 4, kPillar_m = 1;
  Mission mission;
  mission.domain.size_m = {kSpacing_m * side, kSpacing_m * side, 0};
  mission.speed_limit_mps = 5;
  mission.wall_clearance_m = 0.5;
  Rings pillars;
  for (int i = 0; i < side * side; ++i) {
    const double x_m = kSpacing_m * (i % side) + 1, y_m = kSpacing_m * (i / side) + 1;
    pillars.push_back({{x_m, y_m},
                       {x_m + kPillar_m, y_m},
                       {x_m + kPillar_m, y_m + kPillar_m},
                       {x_m, y_m + kPillar_m}});
  }
  mission.walls = IndexedRings(std::move(pillars));
  SeparationFilter filter(mission, 0);
  Mover self{0, 0, {0, 0, 0}, 5};
  for (auto _ : state) {
    const auto angle = static_cast<double>(++self.tick);
    const double at = 0.618 * angle;
    self.position_m.x() = kSpacing_m * side * (at - std::floor(at));
    self.position_m.y() = kSpacing_m * (static_cast<int>(self.tick) % side) + 0.45;
    benchmark::DoNotOptimize(filter.safe(self, {5 * std::cos(angle), 5 * std::sin(angle), 0}, {}));
  }
}
BENCHMARK(AmongWalls)->ArgName("vertices")->Arg(1024)->Arg(4096)->Arg(16384);

/// The worst plan for an agent that follows walls: a round room with so many corners, all at hand.
void FollowRoundWall(benchmark::State& state) {
  const auto corners = static_cast<int>(state.range(0)) - 4;
  Mission mission;
  mission.domain.size_m = {100, 100, 0};
  mission.speed_limit_mps = 10;
  mission.wall_clearance_m = 10;
  Ring room;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2 * M_PI * i / corners;
    room.emplace_back(50 + 11 * std::cos(angle), 50 + 11 * std::sin(angle));
  }
  mission.walls = IndexedRings({{{30, 30}, {70, 30}, {70, 70}, {30, 70}}, std::move(room)});
  SeparationFilter filter(mission, 0);
  WallFollower follower(mission, 0);
  Tick tick = 0;
  const Eigen::Vector3d at_m(50.1, 50, 0);
  for (auto _ : state) {
    const auto aim_mps = follower.aim(++tick, at_m, {10, 0, 0});
    const SafeVelocity safe = filter.safe({0, tick, at_m, 10}, aim_mps, {});
    follower.note(true);
    benchmark::DoNotOptimize(safe);
  }
}
BENCHMARK(FollowRoundWall)->ArgName("vertices")->Arg(1024)->Arg(4096)->Arg(16384);

}  // namespace
}  // namespace ergocast::bench

BENCHMARK_MAIN();
