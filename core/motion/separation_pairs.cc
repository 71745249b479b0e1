// SPDX-License-Identifier: BSD-3-Clause
// The constraints between two bodies of any kinds of vehicles.
//
// Q is the set that a body keeps under commands of 0: the place of a point or a unicycle, the
// loiter centre of a fixed wing, the path from x to x + s(v) of a vehicle that brakes. All bodies
// keep their Q at least D' apart. Let n be a unit vector from one Q towards the other, and g the
// gap between them along n, less D'. Each body moves its Q by at most its share of g:
//
//   n·z ≤ max over the present Q of n·y + share · g  for each z of the next Q.
//
// So the next Q are D' apart along n. A command of 0 is always allowed: then the next Q is part of
// the present one. Both bodies compute n from the same places and velocities, so they find the same
// n. Any n with a gap is safe; the nearest points give the widest gap.
#include <algorithm>
#include <cmath>

#include "core/base/geometry.h"
#include "core/motion/separation.h"

namespace ergocast {
namespace {

double share_of(double value, double whole) {
  return whole > 0 ? std::clamp(value / whole, 0.0, 1.0) : 0;
}

/// The share of `self` in V_i + V_j; the two shares add up to 1.
double share_of(const Mover& self, const Neighbour& other) {
  return self.max_speed_mps / (self.max_speed_mps + other.max_speed_mps);
}

/// The vector between the nearest points of `a` and `b`, from `a` to `b`.
Eigen::Vector3d shortest_between_m(const StraightWay& a, const StraightWay& b) {
  const Eigen::Vector3d apart_m = a.from_m - b.from_m;
  const double aa = a.along_m.squaredNorm(), bb = b.along_m.squaredNorm();
  const double ab = a.along_m.dot(b.along_m);
  const double a_apart = a.along_m.dot(apart_m), b_apart = b.along_m.dot(apart_m);
  double on_a = share_of(ab * b_apart - a_apart * bb, aa * bb - ab * ab);
  const double on_b = share_of(b_apart + on_a * ab, bb);
  on_a = share_of(on_b * ab - a_apart, aa);
  return b.from_m + on_b * b.along_m - a.from_m - on_a * a.along_m;
}

}  // namespace

/// The first neighbour that may be anywhere around. Null if there is none; then the constraints of
/// all are set.
const Neighbour* SeparationFilter::keep_from_all(const Mover& self,
                                                 std::span<const Neighbour> others) {
  const StraightWay own = holding_way(motion_of(self.id), self.position_m, self.velocity_mps);
  keep_from_walls(self, own);
  for (const Neighbour& other : others) {
    if (other.id != self.id && !keep_from(self, own, other)) return &other;
  }
  return nullptr;
}

/// False if the neighbour may be anywhere around.
bool SeparationFilter::keep_from(const Mover& self, const StraightWay& own,
                                 const Neighbour& other) {
  const Pair& pair = pair_of(self.id, other.id);
  const double share = share_of(self, other);
  const double far_m =
      uncertainty_m(self, other) + pair.kept_m + pair.around_m + pair.reach_m / (gain_ * share);
  Eigen::Vector3d y_m = other.position_m - self.position_m;
  if (mission_.domain.planar()) y_m.z() = 0;
  if (y_m.squaredNorm() >= far_m * far_m) return true;
  const Motion &mine = motion_of(self.id), &its = motion_of(other.id);
  if (mine.is_point() && its.is_point()) return keep_places_apart(self, other, y_m);
  const StraightWay theirs = holding_way(its, other.position_m, other.velocity_mps);
  if (mine.has_inertia() || its.has_inertia()) return keep_ways_apart(self, other, own, theirs);
  return keep_places_apart(self, other, theirs.from_m - own.from_m);
}

/// For two bodies that can stay in one place. The other one is at `y_m`, up to the uncertainty.
bool SeparationFilter::keep_places_apart(const Mover& self, const Neighbour& other,
                                         const Eigen::Vector3d& y_m) {
  const Separation& rule = mission_.separation;
  const double near_m = uncertainty_m(self, other), rho_m = std::sqrt(y_m.squaredNorm());
  if (rho_m <= near_m) return false;
  double gap_m = rho_m - near_m - contact_m(self.id, other.id);
  if (rule.disturbance_m == 0 && rule.response_s == 0) gap_m = std::max(0.0, gap_m);
  take(other.id, {y_m / rho_m, near_m / rho_m, gain_ * share_of(self, other) * gap_m});
  return true;
}

/// For two bodies of which at least one has to brake. The state of both is known exactly:
/// sure_of_bodies().
bool SeparationFilter::keep_ways_apart(const Mover& self, const Neighbour& other,
                                       const StraightWay& own, const StraightWay& theirs) {
  const bool first = self.id < other.id;
  Eigen::Vector3d n = first ? shortest_between_m(own, theirs) : shortest_between_m(theirs, own);
  const double length_m = length_of(n);
  if (length_m == 0) return false;
  n /= first ? length_m : -length_m;
  const double own_end_m = std::max(0.0, n.dot(own.along_m));
  const double their_end_m =
      n.dot(theirs.from_m - own.from_m) + std::min(0.0, n.dot(theirs.along_m));
  const double gap_m = std::max(0.0, their_end_m - own_end_m - contact_m(self.id, other.id));
  take(other.id, {n, 0, own_end_m + share_of(self, other) * gap_m});
  return true;
}

}  // namespace ergocast
