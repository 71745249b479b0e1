// SPDX-License-Identifier: BSD-3-Clause
// Looks the way's length up in a table made once for each end, and follows it from one visible cell
// to the next.
#include "core/motion/way_around.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "core/base/geometry.h"
#include "core/motion/walls.h"
#include "core/motion/zones.h"

namespace ergocast {
namespace {

/// The share of a clearance that rounding may take.
constexpr double kRounded = 1e-9;

}  // namespace

WayAround::WayAround(const Mission& mission, const Motion& motion)
    : walls_(mission.walls), motion_(motion) {
  if (walls_.empty()) return;
  const double kept_m = kept_from_walls_m(mission, motion_);
  region_.emplace(walls_, mission.domain, kept_m);
  seen_m_ = kept_m * (1 - kRounded);
}

bool WayAround::note_zones(const Mission& mission, std::vector<Zone> zones) {
  if (!mission.domain.planar() || zones == zones_) return false;
  zones_ = std::move(zones);
  const double kept_m = kept_from_zones_m(mission, motion_);
  seen_zones_m_ = kept_m * (1 - kRounded);
  if (walls_.empty()) region_.reset();
  if (!region_ && !zones_.empty()) region_.emplace(walls_, mission.domain, kept_m);
  open_.clear();
  for (int cell = 0; region_ && cell < region_->cells() && !zones_.empty(); ++cell) {
    const StraightWay place{on_ground(region_->center_m(cell)), {0, 0, 0}};
    open_.push_back(std::ranges::all_of(
        zones_, [&](const Zone& zone) { return beside_m(zone, place) >= kept_m; }));
  }
  find_ways();
  return true;
}

void WayAround::lead_to(const Eigen::Vector3d& to_m) {
  to_m_ = to_m;
  find_ways();
}

void WayAround::find_ways() {
  cell_.reset();
  ways_m_.clear();
  if (!region_) return;
  if (const auto cell = open_cell_near(to_m_.head<2>())) ways_m_ = region_->ways_m({*cell}, open_);
}

/// The nearest cell that is free and outside of zones; nothing if none is near.
std::optional<int> WayAround::open_cell_near(const Eigen::Vector2d& x_m) const {
  if (open_.empty()) return region_->free_cell_near(x_m);
  std::optional<int> best;
  double best_m2 = std::numeric_limits<double>::infinity();
  region_->for_cells_near(x_m, [&](int cell) {
    const double apart_m2 = (region_->center_m(cell) - x_m).squaredNorm();
    if (!open_[static_cast<std::size_t>(cell)] || apart_m2 >= best_m2) return;
    best_m2 = apart_m2;
    best = cell;
  });
  return best;
}

std::optional<Eigen::Vector3d> WayAround::free_place_near(const Eigen::Vector3d& x_m) const {
  if (!region_) return x_m;
  const auto cell = open_cell_near(x_m.head<2>());
  return cell ? std::optional(on_ground(region_->center_m(*cell))) : std::nullopt;
}

double WayAround::length_m(const Eigen::Vector3d& x_m) const {
  if (!region_) return length_of(to_m_ - x_m);
  const Eigen::Vector2d here_m = x_m.head<2>(), there_m = to_m_.head<2>();
  const auto from = open_cell_near(here_m), to = open_cell_near(there_m);
  if (!from || !to || ways_m_.empty()) return std::numeric_limits<double>::infinity();
  return length_of(on_ground(region_->center_m(*from) - here_m)) +
         ways_m_[static_cast<std::size_t>(*from)] +
         length_of(on_ground(region_->center_m(*to) - there_m));
}

bool WayAround::is_clear(const Eigen::Vector3d& from_m, const Eigen::Vector3d& to_m) const {
  const Segment way{from_m.head<2>(), to_m.head<2>()};
  const StraightWay seen{from_m, on_ground(way.to_m - way.from_m)};
  return ergocast::is_clear(walls_, way, seen_m_) &&
         std::ranges::all_of(
             zones_, [&](const Zone& zone) { return beside_m(zone, seen) >= seen_zones_m_; });
}

/// The visible cell around `x_m` through which the way is shortest.
std::optional<int> WayAround::first_cell(const Eigen::Vector3d& x_m) const {
  std::optional<int> best;
  double best_m = std::numeric_limits<double>::infinity();
  region_->for_cells_near(x_m.head<2>(), [&](int cell) {
    const Eigen::Vector3d center_m = on_ground(region_->center_m(cell));
    const double way_m = length_of(center_m - x_m) + ways_m_[static_cast<std::size_t>(cell)];
    if (way_m >= best_m || !is_clear(x_m, center_m)) return;
    best_m = way_m;
    best = cell;
  });
  return best ? best : open_cell_near(x_m.head<2>());
}

Eigen::Vector3d WayAround::next_place_m(const Eigen::Vector3d& x_m) {
  if (!region_ || ways_m_.empty() || is_clear(x_m, to_m_)) return to_m_;
  const auto center_m = [&](int cell) { return on_ground(region_->center_m(cell)); };
  if (!cell_ || !is_clear(x_m, center_m(*cell_))) cell_ = first_cell(x_m);
  if (!cell_) return to_m_;
  for (int next = region_->nearer(ways_m_, *cell_); next != *cell_ && is_clear(x_m, center_m(next));
       next = region_->nearer(ways_m_, *cell_))
    cell_ = next;
  return center_m(*cell_);
}

}  // namespace ergocast
