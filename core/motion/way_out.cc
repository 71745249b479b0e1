// SPDX-License-Identifier: BSD-3-Clause
// Compares the straight ways to all cells outside, and searches the grid only where none is seen.
#include "core/motion/way_out.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/base/geometry.h"
#include "core/mission/kinds.h"
#include "core/mission/station.h"
#include "core/motion/home.h"
#include "core/motion/walls.h"
#include "core/motion/way_home.h"

namespace ergocast {
namespace {

constexpr double kNoWay_m = std::numeric_limits<double>::infinity();
/// Cells along the longer side.
constexpr int kGridCells = 128;
/// The share of a clearance that rounding may take.
constexpr double kSpareShare = 1e-9;

Box flat(Box box) {
  box.origin_m.z() = box.size_m.z() = 0;
  return box;
}

/// What walls keep free. Above 0, as FreeRegion needs it.
double kept_in_region_m(const Mission& mission, const Motion& motion) {
  return mission.walls.empty() ? kept_from_zones_m(mission, motion)
                               : kept_from_walls_m(mission, motion);
}

std::vector<Zone> joined(const Zone& zone, std::span<const Zone> others) {
  std::vector<Zone> all = {zone};
  all.insert(all.end(), others.begin(), others.end());
  return all;
}

}  // namespace

WayOut::WayOut(const Mission& mission, AgentId id, std::span<const Zone> zones)
    : id_(id),
      motion_(motion_of(mission, id)),
      room_(room_to_begin(motion_)),
      walls_(mission.walls),
      zones_(zones.begin(), zones.end()),
      speed_mps_(home_speed_mps(mission, id)),
      kept_m_(kept_from_zones_m(mission, motion_)),
      bound_m_(bound_from_zones_m(mission, motion_)),
      seen_m_(kept_from_walls_m(mission, motion_) * (1 - kSpareShare)),
      region_(walls_, flat(mission.domain), kept_in_region_m(mission, motion_), kGridCells) {
  for (int cell = 0; cell < region_.cells(); ++cell) {
    const Eigen::Vector3d center_m = on_ground(region_.center_m(cell));
    const bool in_room = flat(room_).contains(center_m);
    if (in_room && region_.is_free(cell) && beside_all(center_m)) outside_.push_back(cell);
  }
}

WayOut::WayOut(const Mission& mission, AgentId id, const Zone& zone, std::span<const Zone> others)
    : WayOut(mission, id, joined(zone, others)) {
  find_ways(1);
}

/// Whether a place keeps its distance from all zones, at any height.
bool WayOut::beside_all(const Eigen::Vector3d& x_m) const {
  return std::ranges::all_of(zones_, [&](const Zone& zone) {
    return beside_m(zone, {x_m, {0, 0, 0}}) >= kept_m_;
  });
}

/// Computes the ways from all cells through those that are in none but the zones `left`.
void WayOut::find_ways(unsigned left) {
  if (left == left_ && !ways_m_.empty()) return;
  left_ = left;
  std::vector<bool> crossed(static_cast<std::size_t>(region_.cells()), true);
  for (int cell = 0; cell < region_.cells(); ++cell) {
    for (std::size_t i = 0; i < zones_.size(); ++i) {
      if ((left >> i & 1) != 0) continue;
      const StraightWay place{on_ground(region_.center_m(cell)), {0, 0, 0}};
      if (beside_m(zones_[i], place) < kept_m_) crossed[static_cast<std::size_t>(cell)] = false;
    }
  }
  ways_m_ = region_.ways_m(outside_, crossed);
}

double WayOut::longest_m() const {
  double longest_m = 0;
  for (int cell = 0; cell < region_.cells(); ++cell) {
    const Eigen::Vector3d center_m = on_ground(region_.center_m(cell));
    const StraightWay place{center_m, {0, 0, 0}};
    const bool in_it = region_.is_free(cell) && beside_m(zones_.front(), place) < kept_m_;
    const bool elsewhere = std::any_of(zones_.begin() + 1, zones_.end(), [&](const Zone& other) {
      return beside_m(other, place) < kept_m_;
    });
    if (in_it && !elsewhere)
      longest_m = std::max(longest_m, ways_m_[static_cast<std::size_t>(cell)]);
  }
  // From the place to the centre of its cell, and from that of the last cell to outside.
  return longest_m + 2 * region_.cell_size_m();
}

double WayOut::needed_s(const Mission& mission, AgentId id, double way_m) {
  const double travel_s = way_m / home_speed_mps(mission, id);
  return travel_s + drift_on_way_s(mission, id, travel_s) + slack_on_way_s(mission, id);
}

std::optional<AgentId> WayOut::station_cut_off(const Mission& mission) const {
  std::vector<bool> open(static_cast<std::size_t>(region_.cells()), false);
  for (const int cell : outside_) open[static_cast<std::size_t>(cell)] = true;
  // The largest part: the one that most cells outside belong to.
  std::vector<bool> seen(open.size(), false);
  std::vector<double> largest;
  std::size_t most = 0;
  for (const int cell : outside_) {
    if (seen[static_cast<std::size_t>(cell)]) continue;
    auto ways = region_.ways_m({cell}, open);
    std::size_t count = 0;
    for (std::size_t i = 0; i < ways.size(); ++i) {
      if (std::isinf(ways[i])) continue;
      seen[i] = true;
      ++count;
    }
    if (count <= most) continue;
    most = count;
    largest = std::move(ways);
  }
  for (AgentId id = 0; id < std::ssize(mission.starts_m); ++id) {
    const auto home_m = station_of(mission, id);
    if (!home_m || planned_kind(mission, id) != planned_kind(mission, id_)) continue;
    bool reached = false;
    region_.for_cells_near(home_m->head<2>(), [&](int cell) {
      reached = reached || !std::isinf(largest[static_cast<std::size_t>(cell)]);
    });
    if (!reached) return id;
  }
  return std::nullopt;
}

/// Whether neither a wall nor a zone that binds is in the straight way.
bool WayOut::clear(const Eigen::Vector2d& from_m, const Eigen::Vector2d& to_m) const {
  const Segment way{from_m, to_m};
  bool clear = is_clear(walls_, way, seen_m_);
  const StraightWay seen{on_ground(from_m), on_ground(to_m - from_m)};
  for (std::size_t i = 0; i < zones_.size() && clear; ++i)
    clear = (left_ >> i & 1) != 0 || beside_m(zones_[i], seen) >= bound_m_;
  return clear;
}

std::optional<Eigen::Vector2d> WayOut::nearest_seen_m(const Eigen::Vector2d& x_m) const {
  std::optional<Eigen::Vector2d> best;
  double best_m2 = kNoWay_m;
  for (const int cell : outside_) {
    const Eigen::Vector2d center_m = region_.center_m(cell);
    const double apart_m2 = (center_m - x_m).squaredNorm();
    if (apart_m2 >= best_m2 || !clear(x_m, center_m)) continue;
    best_m2 = apart_m2;
    best = center_m;
  }
  return best;
}

/// The farthest cell that can be seen on the shortest way; nothing if no way leads out.
std::optional<Eigen::Vector2d> WayOut::along_cells_m(const Eigen::Vector2d& x_m) const {
  std::optional<int> first;
  double best_m = kNoWay_m;
  for (const bool seen : {true, false}) {
    region_.for_cells_near(x_m, [&](int cell) {
      const Eigen::Vector2d center_m = region_.center_m(cell);
      const double way_m =
          length_of(on_ground(center_m - x_m)) + ways_m_[static_cast<std::size_t>(cell)];
      if (way_m >= best_m || (seen && !clear(x_m, center_m))) return;
      best_m = way_m;
      first = cell;
    });
    if (first) break;
  }
  if (!first) return std::nullopt;
  for (int next = region_.nearer(ways_m_, *first);
       next != *first && clear(x_m, region_.center_m(next)); next = region_.nearer(ways_m_, *first))
    first = next;
  return region_.center_m(*first);
}

/// The nearest height above or below at which the place is outside, if no zone that binds is in
/// between.
std::optional<double> WayOut::height_outside_m(const Eigen::Vector3d& x_m) const {
  std::optional<double> best;
  const auto consider = [&](double z_m) {
    const StraightWay way{x_m, {0, 0, z_m - x_m.z()}};
    const StraightWay end{{x_m.x(), x_m.y(), z_m}, {0, 0, 0}};
    const bool nearer = !best || std::abs(z_m - x_m.z()) < std::abs(*best - x_m.z());
    if (!nearer || !room_.contains(end.from_m)) return;
    for (std::size_t i = 0; i < zones_.size(); ++i) {
      if (!lies_outside(zones_[i], end, kept_m_)) return;
      if ((left_ >> i & 1) == 0 && !lies_outside(zones_[i], way, bound_m_)) return;
    }
    best = z_m;
  };
  for (const Zone& zone : zones_) {
    const double spare_m = kept_m_ * (1 + kSpareShare) + kSpareShare * room_.size_m.maxCoeff();
    consider(zone.high_m + spare_m);
    consider(zone.low_m - spare_m);
  }
  return best;
}

Eigen::Vector3d WayOut::velocity_mps(Tick tick, const Eigen::Vector3d& x_m,
                                     const Eigen::Vector3d& v_mps) {
  const StraightWay holding = holding_way(motion_, x_m, v_mps);
  unsigned left = 0;
  for (std::size_t i = 0; i < zones_.size(); ++i) {
    const bool binds = !zones_[i].closed_at(tick) || lies_outside(zones_[i], holding, bound_m_);
    left |= binds ? 0 : 1U << i;
  }
  find_ways(left);
  const Eigen::Vector3d& at_m = holding.from_m;
  auto to_m = nearest_seen_m(at_m.head<2>());
  if (!to_m) to_m = along_cells_m(at_m.head<2>());
  Eigen::Vector3d way_m = to_m ? on_ground(*to_m - at_m.head<2>()) : Eigen::Vector3d(0, 0, 0);
  const auto height_m =
      motion_.domain.planar() ? std::nullopt : height_outside_m({at_m.x(), at_m.y(), at_m.z()});
  if (height_m && (!to_m || std::abs(*height_m - at_m.z()) < length_of(way_m)))
    way_m = {0, 0, *height_m - at_m.z()};
  const double apart_m = length_of(way_m);
  return apart_m > 0 ? Eigen::Vector3d(way_m * (speed_mps_ / apart_m)) : way_m;
}

}  // namespace ergocast
