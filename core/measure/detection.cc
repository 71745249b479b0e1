// SPDX-License-Identifier: BSD-3-Clause
// Multiplies what is missed in each cell near a sensor, and adds up what is found.
#include "core/measure/detection.h"

#include <algorithm>
#include <numeric>

#include "core/base/portable_math.h"
#include "core/base/require.h"

namespace ergocast {
namespace {

constexpr double kDefaultRadiusPerSide = 0.025;
constexpr double kCellsPerRadius = 3;
constexpr double kCellsPerLook = 0.5;
constexpr double kLongestLook_s = 1;
constexpr double kLeastRadiusPerCell = 1.5;
constexpr std::array kShares{0.5, 0.8};

/// The plan's, or the default.
double wanted_radius_m(const Mission& mission) {
  return mission.sensor.radius_m > 0
             ? mission.sensor.radius_m
             : kDefaultRadiusPerSide * mission.domain.size_m.head<2>().minCoeff();
}

/// The longest side of a cell, along the axes that are divided.
double longest_side_m(const Cells& cells) {
  return (cells.count > 1).select(cells.size_m.array(), 0).maxCoeff();
}

}  // namespace

double sensor_radius_m(const Mission& mission) {
  const double side_m = longest_side_m(measure_cells(mission));
  return std::max(wanted_radius_m(mission), kLeastRadiusPerCell * side_m);
}

Cells measure_cells(const Mission& mission) {
  return {mission.domain, wanted_radius_m(mission) / kCellsPerRadius};
}

Tick ticks_per_look(const Mission& mission, const Cells& cells) {
  double u_max_mps = mission.law.u_max_mps;
  for (const AgentKind& kind : mission.kinds) u_max_mps = std::max(u_max_mps, kind.u_max_mps);
  const double side_m =
      mission.domain.planar() ? cells.size_m.head<2>().minCoeff() : cells.size_m.minCoeff();
  const double look_s = std::min(kLongestLook_s, kCellsPerLook * side_m / u_max_mps);
  return std::max<Tick>(1, static_cast<Tick>(look_s / mission.timing.dt_s));
}

Detection::Detection(const Mission& mission)
    : cells_(measure_cells(mission)),
      dt_s_(mission.timing.dt_s),
      radius_m_(sensor_radius_m(mission)),
      ticks_per_look_(ergocast::ticks_per_look(mission, cells_)),
      missed_in_look_(portable::exp(-mission.sensor.detections_per_s * mission.timing.dt_s *
                                    static_cast<double>(ticks_per_look_))),
      mass_(cells_.total(), 0),
      missed_(cells_.total(), 1),
      seen_(cells_.total(), 0),
      longest_(cells_.total(), 0) {}

void Detection::begin_target(std::vector<double> mass, Tick counted) {
  ERGOCAST_REQUIRE(mass.size() == cells_.total());
  mass_ = std::move(mass);
  std::ranges::fill(missed_, 1.0);
  found_ = 0;
  begun_ = counted;
  times_s_ = {};
}

void Detection::look(std::size_t cell, Tick turn) {
  found_ += mass_[cell] * missed_[cell] * (1 - missed_in_look_);
  missed_[cell] *= missed_in_look_;
  longest_[cell] = std::max(longest_[cell], turn - seen_[cell]);
  seen_[cell] = turn + 1;
}

void Detection::see(Tick counted, const Eigen::Vector3d& x_m) {
  if (counted % ticks_per_look_ != ticks_per_look_ / 2) return;
  const Tick turn = counted / ticks_per_look_;
  cells_.for_near(x_m, radius_m_, [&](int i, int j, int l) {
    look(cells_.column(i, l) + static_cast<std::size_t>(j), turn);
  });
}

void Detection::pass(Tick counted) {
  for (std::size_t i = 0; i < kShares.size(); ++i) {
    if (!times_s_[i] && probability() >= kShares[i])
      times_s_[i] = static_cast<double>(counted + 1 - begun_) * dt_s_;
  }
}

double Detection::greatest_age_s(Tick counted, double share) const {
  const Tick now = counted / ticks_per_look_;
  const auto age = [&](std::size_t cell) { return std::max(longest_[cell], now - seen_[cell]); };
  const double look_s = static_cast<double>(ticks_per_look_) * dt_s_;
  std::vector<std::size_t> order(cells_.total());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::erase_if(order, [&](std::size_t cell) { return mass_[cell] <= 0; });
  std::ranges::sort(order, {}, age);
  double mass = 0;
  for (const std::size_t cell : order) {
    mass += mass_[cell];
    if (mass >= share) return static_cast<double>(age(cell)) * look_s;
  }
  return order.empty() ? 0 : static_cast<double>(age(order.back())) * look_s;
}

}  // namespace ergocast
