// SPDX-License-Identifier: BSD-3-Clause
// Lays lanes into the agent's share of the target, and goes from corner to corner.
#include "core/law/mower.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/measure/detection.h"
#include "core/measure/target_mass.h"
#include "core/mission/kinds.h"

namespace ergocast {
namespace {

/// The least density that is worth mowing, as a share of the uniform one.
constexpr double kWorthMowing = 0.05;
/// How often the time that a corner should take passes before it is left out, and ticks besides.
constexpr double kPatience = 3, kMostPatience_ticks = 1e9;
constexpr Tick kMorePatience_ticks = 100;
/// How near a vehicle comes to a corner, in radii of its tightest turn.
constexpr double kTurnsToCorner = 1.5;
/// Standard deviations of what a disturbance may add to a step.
constexpr double kPushDeviations = 3;

/// The radius in which an agent turns at a speed [m]; 0 for those that turn at once.
double turn_radius_m(const VehicleLimits& vehicle, double speed_mps) {
  if (vehicle.max_turn_radps > 0) return speed_mps / vehicle.max_turn_radps;
  if (vehicle.max_acceleration_mps2 > 0)
    return speed_mps * speed_mps / vehicle.max_acceleration_mps2;
  return 0;
}

/// The middle of a range of cells [m].
Eigen::Vector3d middle_m(const Cells& cells, const CellRange& range) {
  const Eigen::Array3d middle = (range.first + range.last).cast<double>() / 2;
  return cells.domain.origin_m + (middle * cells.size_m.array()).matrix();
}

/// Cell `index` of a lane along `axis`, with all cells beside it.
CellRange slice(CellRange lane, int axis, int index) {
  lane.first[axis] = index;
  lane.last[axis] = index + 1;
  return lane;
}

}  // namespace

Mower::Mower(const Mission& mission, int kind)
    : basis_(in_cosines(mission).basis),
      walls_(mission.walls),
      motion_(motion_of_kind(mission, kind)),
      push_m_(kPushDeviations * mission.disturbance_intensity * std::sqrt(motion_.dt_s)),
      cells_(measure_cells(mission)),
      radius_m_(sensor_radius_m(mission)),
      way_(mission, motion_) {
  set_speed(law_of(mission, kind).u_max_mps);
  set_target(in_cosines(mission).target_coefficients);
}

void Mower::set_target(const Coefficients& target) {
  mass_ = RangeSums(cells_, target_mass(basis_, walls_, target, cells_));
  team_.clear();
}

void Mower::set_law(const LawNumbers& numbers) {
  const double before_mps = speed_mps_;
  set_speed(numbers.u_max_mps);
  is_aimed_ = is_aimed_ && speed_mps_ == before_mps;
}

void Mower::set_speed(double u_max_mps) {
  const double limit_mps = motion_.speed_limit_mps;
  speed_mps_ = limit_mps > 0 ? std::min(u_max_mps, limit_mps) : u_max_mps;
  const double turn_m = kTurnsToCorner * turn_radius_m(motion_.vehicle, speed_mps_);
  reach_m_ = std::max(speed_mps_ * motion_.dt_s / 2, turn_m) + push_m_;
}

Eigen::Vector3d Mower::wanted_mps(const LawInput& input) {
  if (!std::ranges::equal(team_, input.team)) share_out(input);
  if (!is_aimed_) aim(next_, input);
  bool sees = sees_corner(input.x_m);
  const bool is_there = sees && length_of(corners_m_[next_] - input.x_m) <= reach_m_;
  if (is_there || input.tick >= give_up_) {
    aim((next_ + 1) % corners_m_.size(), input);
    sees = sees_corner(input.x_m);
  }
  const Eigen::Vector3d to_m = sees ? corners_m_[next_] : way_.next_place_m(input.x_m);
  Eigen::Vector3d way_m = to_m - input.x_m;
  if (cells_.domain.planar()) way_m.z() = 0;
  const double distance_m = length_of(way_m);
  if (distance_m <= speed_mps_ * motion_.dt_s) return way_m / motion_.dt_s;
  return way_m * (speed_mps_ / distance_m);
}

void Mower::share_out(const LawInput& input) {
  team_.assign(input.team.begin(), input.team.end());
  const auto own = std::ranges::lower_bound(team_, input.agent);
  const auto rank = static_cast<int>(own - team_.begin());
  const int count = std::max(rank + 1, static_cast<int>(team_.size()));
  const CellRange share = equal_share(cells_, mass_, rank, count);
  lanes_.clear();
  lay_lanes(share);
  if (!walls_.empty()) add_unseen(share);
  put_in_order(input.x_m);
  if (corners_m_.empty()) corners_m_.push_back(input.x_m);  // nothing is worth mowing
  // Back through the same corners, without the last and the first one.
  for (std::size_t i = corners_m_.size() - 1; i-- > 1;) corners_m_.push_back(corners_m_[i]);
  aim(0, input);
}

void Mower::lay_lanes(const CellRange& share) {
  const int axis = longest_axis(cells_, share);
  const double apart_m = radius_m_ * (cells_.domain.planar() ? 2 : std::numbers::sqrt2);
  const int one = (axis + 1) % 3, other = (axis + 2) % 3;
  const auto lanes = [&](int across) {
    const double side_m = share.counts()[across] * cells_.size_m[across];
    return std::clamp(static_cast<int>(std::ceil(side_m / apart_m)), 1, share.counts()[across]);
  };
  const auto cut = [&](int across, int lane) {
    return share.first[across] + share.counts()[across] * lane / lanes(across);
  };
  for (int i = 0; i < lanes(one); ++i) {
    for (int j = 0; j < lanes(other); ++j) {
      CellRange lane = share;
      lane.first[one] = cut(one, i);
      lane.last[one] = cut(one, i + 1);
      lane.first[other] = cut(other, j);
      lane.last[other] = cut(other, j + 1);
      lay_lane(lane, axis);
    }
  }
}

/// Adds the parts of a lane between walls.
void Mower::lay_lane(const CellRange& lane, int axis) {
  CellRange part = lane;
  part.last[axis] = part.first[axis];
  Eigen::Vector3d before_m = middle_m(cells_, slice(lane, axis, lane.first[axis]));
  for (int index = lane.first[axis]; index < lane.last[axis]; ++index) {
    const Eigen::Vector3d here_m = middle_m(cells_, slice(lane, axis, index));
    if (!way_.is_clear(before_m, here_m)) {
      add_part(part, lane, axis);
      part.first[axis] = way_.is_clear(here_m, here_m) ? index : index + 1;
    }
    part.last[axis] = index + 1;
    before_m = here_m;
  }
  add_part(part, lane, axis);
}

/// Adds a part of a lane, from its first to its last slice that is worth mowing, if any is. It ends
/// half a radius before them, but not where a wall ends it.
void Mower::add_part(CellRange part, const CellRange& lane, int axis) {
  int &first = part.first[axis], &last = part.last[axis];
  const bool before_wall = first > lane.first[axis], after_wall = last < lane.last[axis];
  const int whole_first = first, whole_last = last;
  while (first < last && !is_worth(slice(part, axis, first))) ++first;
  while (first < last && !is_worth(slice(part, axis, last - 1))) --last;
  if (first >= last) return;
  const double cell_m = cells_.size_m[axis], length_m = (last - first) * cell_m;
  const auto inset_m = [&](bool at_wall) {
    return std::min(at_wall ? cell_m / 2 : radius_m_ / 2, length_m / 2);
  };
  Lane added{middle_m(cells_, part), middle_m(cells_, part)};
  added.from_m[axis] += inset_m(before_wall && first == whole_first) - length_m / 2;
  added.to_m[axis] += length_m / 2 - inset_m(after_wall && last == whole_last);
  lanes_.push_back(added);
}

bool Mower::is_worth(const CellRange& cells) const {
  const double share = cells.counts().prod() / static_cast<double>(cells_.total());
  return mass_.of(cells) >= kWorthMowing * share;
}

/// Adds a place near each cell that no lane sees.
void Mower::add_unseen(const CellRange& share) {
  for (int i = share.first.x(); i < share.last.x(); ++i) {
    for (int j = share.first.y(); j < share.last.y(); ++j) {
      const CellRange cell{{i, j, 0}, {i + 1, j + 1, 1}};
      const Eigen::Vector3d x_m = middle_m(cells_, cell);
      if (!is_worth(cell) || is_seen(x_m)) continue;
      const auto place_m = way_.free_place_near(x_m);
      if (place_m && length_of(*place_m - x_m) <= radius_m_) lanes_.push_back({*place_m, *place_m});
    }
  }
}

/// Whether a place of the plane is within the sensor's radius of a lane.
bool Mower::is_seen(const Eigen::Vector3d& x_m) const {
  const Eigen::Vector2d at_m = x_m.head<2>();
  return std::ranges::any_of(lanes_, [&](const Lane& lane) {
    const Segment way{lane.from_m.head<2>(), lane.to_m.head<2>()};
    return (way.nearest_m(at_m) - at_m).squaredNorm() <= radius_m_ * radius_m_;
  });
}

/// Makes corners of the lanes to which a way leads from `x_m`.
void Mower::put_in_order(const Eigen::Vector3d& x_m) {
  corners_m_.clear();
  Eigen::Vector3d at_m = x_m;
  while (const auto nearest = nearest_lane(at_m)) {
    const auto [lane, turned] = *nearest;
    const Eigen::Vector3d &from_m = lanes_[lane].from_m, &to_m = lanes_[lane].to_m;
    corners_m_.push_back(turned ? to_m : from_m);
    at_m = turned ? from_m : to_m;
    if (from_m != to_m) corners_m_.push_back(at_m);
    lanes_.erase(lanes_.begin() + static_cast<std::ptrdiff_t>(lane));
  }
}

/// The lane whose end is the nearest one in sight, or that to which the way is shortest, and
/// whether that is its last end. Nothing if no way leads to any lane.
std::optional<std::pair<std::size_t, bool>> Mower::nearest_lane(const Eigen::Vector3d& x_m) {
  using End = std::pair<std::size_t, bool>;
  std::vector<std::pair<double, End>> ends;  // how far away each is
  for (std::size_t i = 0; i < lanes_.size(); ++i) {
    ends.push_back({length_of(lanes_[i].from_m - x_m), {i, false}});
    ends.push_back({length_of(lanes_[i].to_m - x_m), {i, true}});
  }
  std::ranges::sort(ends);
  const auto place_m = [&](const End& end) {
    return end.second ? lanes_[end.first].to_m : lanes_[end.first].from_m;
  };
  for (const auto& [away_m, end] : ends)
    if (way_.is_clear(x_m, place_m(end))) return end;
  if (ends.empty()) return std::nullopt;
  way_.lead_to(x_m);
  for (auto& [away_m, end] : ends) away_m = way_.length_m(place_m(end));
  const auto& [away_m, end] = *std::ranges::min_element(ends, {}, &std::pair<double, End>::first);
  return std::isfinite(away_m) ? std::optional(end) : std::nullopt;
}

void Mower::aim(std::size_t corner, const LawInput& input) {
  next_ = corner;
  knows_way_ = false;
  is_aimed_ = true;
  double way_m = length_of(corners_m_[corner] - input.x_m);
  if (!sees_corner(input.x_m)) way_m = way_.length_m(input.x_m);
  if (!std::isfinite(way_m)) way_m = 0;  // no way leads there
  const double ticks = kPatience * way_m / (speed_mps_ * motion_.dt_s);
  give_up_ =
      input.tick + static_cast<Tick>(std::min(ticks, kMostPatience_ticks)) + kMorePatience_ticks;
}

bool Mower::sees_corner(const Eigen::Vector3d& x_m) {
  if (way_.is_clear(x_m, corners_m_[next_])) return true;
  if (!knows_way_) way_.lead_to(corners_m_[next_]);
  knows_way_ = true;
  return false;
}

}  // namespace ergocast
