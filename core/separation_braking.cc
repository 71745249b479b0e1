// SPDX-License-Identifier: BSD-3-Clause
// Vehicles with inertia keep their distance by their ways to brake.
//
// A body that brakes goes straight from x to x + s(v). All bodies keep these ways D' apart. Let n
// be a unit vector from one way towards the other, and g the gap between the ways along n, less D'.
// Of its next way each takes at most its share of g: for both ends z of the next way
//
//   n·z ≤ max over the present way of n·y + share · g.
//
// So the next ways are D' apart along n. Braking is always allowed: it leads along the present way.
// Both bodies find n from the same places and velocities, so they have the same one. For which n
// there is a gap does not matter to safety; the nearest points of the ways give the widest.
#include <algorithm>
#include <array>

#include "core/geometry.h"
#include "core/separation.h"
#include "core/vehicle.h"

namespace ergocast {
namespace {

/// The way from `from_m` to `from_m + along_m`.
struct Way {
  Eigen::Vector3d from_m, along_m;
};

double share_of(double value, double whole) {
  return whole > 0 ? std::clamp(value / whole, 0.0, 1.0) : 0;
}

/// From the point of `a` to that of `b` that are nearest to each other.
Eigen::Vector3d shortest_between_m(const Way& a, const Way& b) {
  const Eigen::Vector3d apart_m = a.from_m - b.from_m;
  const double aa = a.along_m.squaredNorm(), bb = b.along_m.squaredNorm();
  const double ab = a.along_m.dot(b.along_m);
  const double a_apart = a.along_m.dot(apart_m), b_apart = b.along_m.dot(apart_m);
  double on_a = share_of(ab * b_apart - a_apart * bb, aa * bb - ab * ab);
  const double on_b = share_of(b_apart + on_a * ab, bb);
  on_a = share_of(on_b * ab - a_apart, aa);
  return b.from_m + on_b * b.along_m - a.from_m - on_a * a.along_m;
}

/// A turn in the plane x, y: cosine and sine of its angle.
struct Turn {
  double cosine, sine;
};
constexpr double kRootThreeHalves = 0.86602540378443865;
/// Ways around, each at full and at half speed: 0°, 30° … 180° off the wanted velocity.
constexpr std::array<Turn, 7> kTurns = {{{1, 0},
                                         {kRootThreeHalves, 0.5},
                                         {0.5, kRootThreeHalves},
                                         {0, 1},
                                         {-0.5, kRootThreeHalves},
                                         {-kRootThreeHalves, 0.5},
                                         {-1, 0}}};

Eigen::Vector3d turned(const Eigen::Vector3d& v, const Turn& turn, double hand) {
  const double sine = hand * turn.sine;
  return {turn.cosine * v.x() - sine * v.y(), sine * v.x() + turn.cosine * v.y(), v.z()};
}

}  // namespace

/// False if the two ways touch: then nobody knows a way apart.
bool SeparationFilter::take_way(const Mover& self, const Neighbour& other, double reach_m) {
  const double kept_m = contact_m(std::max(self.max_speed_mps, other.max_speed_mps));
  const Eigen::Vector3d y_m = other.position_m - self.position_m;
  const double far_m = kept_m + 4 * reach_m;
  if (y_m.squaredNorm() >= far_m * far_m) return true;
  const Way own = {self.position_m, braking_path_m(mission_, self.velocity_mps)};
  const Way theirs = {other.position_m, braking_path_m(mission_, other.velocity_mps)};
  const bool first = self.id < other.id;
  Eigen::Vector3d n = first ? shortest_between_m(own, theirs) : shortest_between_m(theirs, own);
  const double length_m = length_of(n);
  if (length_m == 0) return false;
  n /= first ? length_m : -length_m;
  const double own_end_m = std::max(0.0, n.dot(own.along_m));
  const double their_end_m = n.dot(y_m) + std::min(0.0, n.dot(theirs.along_m));
  const double share = self.max_speed_mps / (self.max_speed_mps + other.max_speed_mps);
  const double gap_m = std::max(0.0, their_end_m - own_end_m - kept_m);
  take(other, {n, 0, own_end_m + share * gap_m});
  return true;
}

/// Whether both ends of the next way are allowed, if the vehicle now goes over to `v_mps`.
bool SeparationFilter::allows(const Mover& self, const Eigen::Vector3d& v_mps) const {
  const Eigen::Vector3d step_m =
      mean_velocity(mission_, self.velocity_mps, v_mps) * mission_.timing.dt_s;
  return constraints_.allow(step_m) && constraints_.allow(step_m + braking_path_m(mission_, v_mps));
}

SafeVelocity SeparationFilter::safe_change(const Mover& self, const Eigen::Vector3d& wanted_mps,
                                           std::span<const Neighbour> others) {
  const double dt_s = mission_.timing.dt_s;
  const double reach_m = self.max_speed_mps * dt_s + longest_braking_path_m(mission_);
  begin(self, reach_m);
  for (const Neighbour& other : others) {
    if (other.id != self.id && !take_way(self, other, reach_m)) return stopped(self, other);
  }
  const Eigen::Vector3d direct_mps = executed(mission_, self.velocity_mps, wanted_mps);
  if (allows(self, direct_mps)) return {direct_mps};

  const AgentId by = blocker(mean_velocity(mission_, self.velocity_mps, direct_mps) * dt_s +
                             braking_path_m(mission_, direct_mps));
  const Eigen::Vector3d aim_mps = within_speed_limit(mission_, wanted_mps);
  for (const double share : {1.0, 0.5}) {
    for (const Turn& turn : kTurns) {
      for (const double hand : {side(self), -side(self)}) {
        const Eigen::Vector3d v_mps =
            executed(mission_, self.velocity_mps, share * turned(aim_mps, turn, hand));
        if (allows(self, v_mps)) return {v_mps, false, by};
      }
    }
  }
  return {executed(mission_, self.velocity_mps, {0, 0, 0}), true, by};
}

}  // namespace ergocast
