// SPDX-License-Identifier: BSD-3-Clause
// Lays lanes into the agent's share of the target, and goes from corner to corner.
#include "core/law/mower.h"

#include <algorithm>
#include <cmath>

#include "core/measure/detection.h"
#include "core/measure/target_mass.h"
#include "core/mission/kinds.h"

namespace ergocast {
namespace {

/// The least density of a lane's ends, as a share of the uniform one.
constexpr double kWorthMowing = 0.05;
/// How often the time that a corner should take passes before it is left out, and ticks besides.
constexpr double kPatience = 3;
constexpr Tick kMorePatience_ticks = 100;
/// How near a vehicle comes to a corner, in radii of its tightest turn.
constexpr double kTurnsToCorner = 1.5;

/// The radius in which an agent turns at full speed [m]; 0 for those that turn at once.
double turn_radius_m(const Mission& mission, int kind, double u_max_mps) {
  const auto index = static_cast<std::size_t>(kind);
  const bool own = index < mission.kinds.size() && mission.kinds[index].vehicle;
  const VehicleLimits& vehicle = own ? *mission.kinds[index].vehicle : mission.vehicle;
  if (vehicle.max_turn_radps > 0) return u_max_mps / vehicle.max_turn_radps;
  if (vehicle.max_acceleration_mps2 > 0)
    return u_max_mps * u_max_mps / vehicle.max_acceleration_mps2;
  return 0;
}

}  // namespace

Mower::Mower(const Mission& mission, int kind)
    : mission_(in_cosines(mission)),
      cells_(measure_cells(mission)),
      u_max_mps_(law_of(mission, kind).u_max_mps),
      radius_m_(sensor_radius_m(mission)),
      reach_m_(std::max(u_max_mps_ * mission.timing.dt_s / 2,
                        kTurnsToCorner * turn_radius_m(mission, kind, u_max_mps_))) {
  set_target(mission_.target_coefficients);
}

void Mower::set_target(const Coefficients& target) {
  mass_ = RangeSums(cells_, target_mass(mission_, target, cells_));
  team_.clear();
}

Eigen::Vector3d Mower::wanted_mps(const LawInput& input) {
  if (!std::ranges::equal(team_, input.team)) share_out(input);
  Eigen::Vector3d way_m = corners_m_[next_] - input.x_m;
  if (length_of(way_m) <= reach_m_ || input.tick >= give_up_) {
    aim((next_ + 1) % corners_m_.size(), input);
    way_m = corners_m_[next_] - input.x_m;
  }
  way_m.z() = 0;
  const double distance_m = length_of(way_m), step_m = u_max_mps_ * mission_.timing.dt_s;
  if (distance_m <= step_m) return way_m / mission_.timing.dt_s;
  return way_m * (u_max_mps_ / distance_m);
}

void Mower::share_out(const LawInput& input) {
  team_.assign(input.team.begin(), input.team.end());
  const auto own = std::ranges::lower_bound(team_, input.agent);
  const auto rank = static_cast<int>(own - team_.begin());
  const int count = std::max(rank + 1, static_cast<int>(team_.size()));
  const CellRange share = equal_share(cells_, mass_, rank, count);
  const double width_m = (share.last_i - share.first_i) * cells_.size_m.x();
  const double height_m = (share.last_j - share.first_j) * cells_.size_m.y();
  const bool along_x = width_m >= height_m;
  const int first = along_x ? share.first_j : share.first_i;
  const int across = (along_x ? share.last_j : share.last_i) - first;
  const double across_m = along_x ? height_m : width_m;
  const int lanes = std::clamp(static_cast<int>(std::ceil(across_m / (2 * radius_m_))), 1, across);
  corners_m_.clear();
  for (int lane = 0; lane < lanes; ++lane) {
    CellRange cells = share;
    (along_x ? cells.first_j : cells.first_i) = first + across * lane / lanes;
    (along_x ? cells.last_j : cells.last_i) = first + across * (lane + 1) / lanes;
    add_lane(cells, along_x);
  }
  if (corners_m_.empty()) corners_m_.push_back(input.x_m);  // nothing is worth mowing
  // Back through the same corners, without the last and the first one.
  for (std::size_t i = corners_m_.size() - 1; i-- > 1;) corners_m_.push_back(corners_m_[i]);
  const auto nearest = std::ranges::min_element(
      corners_m_, {},
      [&](const Eigen::Vector3d& corner_m) { return (corner_m - input.x_m).squaredNorm(); });
  aim(static_cast<std::size_t>(nearest - corners_m_.begin()), input);
}

/// Adds both ends of a lane, the one first that is nearer to the corner before. A lane without any
/// cell that is worth mowing has none.
void Mower::add_lane(const CellRange& lane, bool along_x) {
  const int first = along_x ? lane.first_i : lane.first_j;
  const int last = along_x ? lane.last_i : lane.last_j;
  const int across = along_x ? lane.last_j - lane.first_j : lane.last_i - lane.first_i;
  const double least = kWorthMowing * across / static_cast<double>(cells_.total());
  const auto is_worth = [&](int index) {
    CellRange line = lane;
    (along_x ? line.first_i : line.first_j) = index;
    (along_x ? line.last_i : line.last_j) = index + 1;
    return mass_.of(line) >= least;
  };
  int low = first, high = last;
  while (low < high && !is_worth(low)) ++low;
  while (low < high && !is_worth(high - 1)) --high;
  if (low == high) return;
  const int axis = along_x ? 0 : 1;
  const double cell_m = cells_.size_m[axis], length_m = (high - low) * cell_m;
  const double inset_m = std::min(radius_m_ / 2, length_m / 2);
  const double origin_m = cells_.domain.origin_m[axis];
  const double middle = (along_x ? lane.first_j + lane.last_j : lane.first_i + lane.last_i) / 2.0;
  const double across_m = cells_.domain.origin_m[1 - axis] + middle * cells_.size_m[1 - axis];
  const auto place = [&](double along_m) {
    return along_x ? Eigen::Vector3d(along_m, across_m, 0) : Eigen::Vector3d(across_m, along_m, 0);
  };
  Eigen::Vector3d from_m = place(origin_m + low * cell_m + inset_m);
  Eigen::Vector3d to_m = place(origin_m + high * cell_m - inset_m);
  if (!corners_m_.empty() &&
      (corners_m_.back() - to_m).squaredNorm() < (corners_m_.back() - from_m).squaredNorm())
    std::swap(from_m, to_m);
  corners_m_.push_back(from_m);
  corners_m_.push_back(to_m);
}

void Mower::aim(std::size_t corner, const LawInput& input) {
  next_ = corner;
  const double distance_m = length_of(corners_m_[corner] - input.x_m);
  const double ticks = distance_m / (u_max_mps_ * mission_.timing.dt_s);
  give_up_ = input.tick + static_cast<Tick>(kPatience * ticks) + kMorePatience_ticks;
}

}  // namespace ergocast
