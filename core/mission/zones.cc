// SPDX-License-Identifier: BSD-3-Clause
// Checks zones that have arrived: a forged one must not cost more than a look.
#include "core/mission/zones.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>

namespace ergocast {
namespace {

/// How far outside the domain a corner may be, and the least area, as of walls
/// (core/motion/walls.h): multiples of the longer side and of its square.
constexpr double kFarthest = 10, kLeastArea = 1e-8;

bool ticks_follow(const Zone& zone) {
  return zone.number >= 0 && zone.closed >= 0 && zone.closed <= zone.from &&
         zone.from < zone.until && zone.until - zone.from <= kMaxZoneTicks &&
         (zone.cancelled == -1 || zone.cancelled >= zone.closed);
}

bool heights_fit(const Zone& zone, const Box& domain) {
  if (domain.planar()) return zone.low_m == 0 && zone.high_m == 0;
  const double floor_m = domain.origin_m.z(), top_m = floor_m + domain.size_m.z();
  return zone.low_m < zone.high_m && zone.low_m < top_m && zone.high_m > floor_m &&
         std::isfinite(zone.low_m) && std::isfinite(zone.high_m);
}

bool near_domain(const Eigen::Vector2d& corner_m, const Box& domain) {
  const double far_m = kFarthest * domain.size_m.maxCoeff();
  const Eigen::Array2d low_m = domain.origin_m.head<2>().array() - far_m;
  const Eigen::Array2d high_m = (domain.origin_m + domain.size_m).head<2>().array() + far_m;
  return (corner_m.array() >= low_m).all() && (corner_m.array() <= high_m).all();
}

}  // namespace

bool is_zone(const Zone& zone, const Box& domain) {
  const Ring& ring = zone.corners_m;
  if (!ticks_follow(zone) || !heights_fit(zone, domain)) return false;
  if (ring.size() < 3 || ring.size() > kMaxZoneCorners) return false;
  for (std::size_t i = 0; i < ring.size(); ++i)
    if (!near_domain(ring[i], domain) || ring[i] == ring[(i + 1) % ring.size()]) return false;
  const double side_m = domain.size_m.maxCoeff();
  return !touching_edges({ring}) && area_m2(ring) >= kLeastArea * side_m * side_m;
}

bool are_zones(std::span<const Zone> zones, const Box& domain) {
  if (zones.size() > kMaxZones) return false;
  for (std::size_t i = 1; i < zones.size(); ++i)
    if (zones[i].number <= zones[i - 1].number) return false;
  return std::ranges::all_of(zones, [&](const Zone& zone) { return is_zone(zone, domain); });
}

std::vector<Zone> not_ended(std::span<const Zone> zones, Tick tick) {
  std::vector<Zone> left;
  std::ranges::copy_if(zones, std::back_inserter(left),
                       [tick](const Zone& zone) { return zone.end() > tick; });
  return left;
}

std::uint64_t zone_hash(const Zone& zone) {
  std::uint64_t hash = 1;
  const auto add = [&hash](std::uint64_t bits) {
    hash = (hash ^ bits) * 0x9e3779b97f4a7c15;
    hash ^= hash >> 29;
  };
  for (const Eigen::Vector2d& corner_m : zone.corners_m) {
    add(std::bit_cast<std::uint64_t>(corner_m.x()));
    add(std::bit_cast<std::uint64_t>(corner_m.y()));
  }
  add(std::bit_cast<std::uint64_t>(zone.low_m));
  add(std::bit_cast<std::uint64_t>(zone.high_m));
  add(static_cast<std::uint64_t>(zone.until - zone.from));
  return hash;
}

}  // namespace ergocast
