// SPDX-License-Identifier: BSD-3-Clause
// Projects a step on an intersection of cones, half-spaces, a box and a ball, by Dykstra's
// alternating projections.
#include "core/motion/step_constraints.h"

#include <algorithm>
#include <cmath>

#include "core/base/geometry.h"
#include "core/base/require.h"

namespace ergocast {
namespace {

constexpr int kMaxSweeps = 40;
/// The iteration ends when a sweep moves the step by less than this share of the reach.
constexpr double kConverged = 1e-8;
/// With negative bounds, a greater excess than this share of the reach means that no step is
/// allowed.
constexpr double kNoCommonStep = 1e-9;
constexpr int kLeastExcessSteps = 60;

/// max u·d over the unit vectors u of a cone, and the u of this maximum.
struct Support {
  double height;
  Eigen::Vector3d u;
};

Support support(const Eigen::Vector3d& axis, double sine, double cosine, const Eigen::Vector3d& d) {
  const double along = axis.dot(d);
  if (sine == 0) return {along, axis};
  const Eigen::Vector3d across = d - along * axis;
  const double width = length_of(across);
  if (along > 0 && width * cosine <= along * sine) {  // d is in the cone
    const double length = length_of(d);
    return {length, d / length};
  }
  if (width == 0) return {along * cosine, axis};
  return {along * cosine + width * sine, cosine * axis + sine / width * across};
}

}  // namespace

StepConstraints::StepConstraints(std::size_t capacity) { sets_.reserve(capacity); }

void StepConstraints::begin(const Room& room) {
  sets_.clear();
  added_ = 0;
  room_ = room;
  zero_allowed_ = true;
}

void StepConstraints::add(const Set& set) {
  const int number = added_++;
  if (set.bound_m >= room_.reach_m) return;
  ERGOCAST_REQUIRE(sets_.size() < sets_.capacity());
  if (set.bound_m < 0) zero_allowed_ = false;
  sets_.push_back({set, std::sqrt((1 - set.sine) * (1 + set.sine)), number, {0, 0, 0}});
}

StepConstraints::Excess StepConstraints::excess_of(const Kept& kept,
                                                   const Eigen::Vector3d& step_m) {
  const auto& [axis, sine, bound_m, hard_m] = kept.set;
  if (bound_m >= 0) {
    const Support most = support(axis, sine, kept.cosine, step_m);
    return {most.height - bound_m, most.u};
  }
  const Support most = support(axis, sine, kept.cosine, step_m - bound_m / kept.cosine * axis);
  return {most.height, most.u};
}

/// A quick test without a root: in a crowd most sets are far from the step.
bool StepConstraints::surely_holds(const Kept& kept, const Eigen::Vector3d& step_m) {
  const auto& [axis, sine, bound_m, hard_m] = kept.set;
  if (bound_m < 0) return false;
  const double along = axis.dot(step_m);
  const double square = step_m.squaredNorm(), across = square - along * along;
  const bool in_cone =
      along > 0 && across * kept.cosine * kept.cosine <= along * along * sine * sine;
  if (in_cone) return square <= bound_m * bound_m;
  const double left_m = bound_m - along * kept.cosine;
  return left_m > 0 && sine * sine * across <= left_m * left_m;
}

Eigen::Vector3d StepConstraints::in_box(const Eigen::Vector3d& step_m) const {
  return step_m.cwiseMax(room_.low_m).cwiseMin(room_.high_m);
}

Eigen::Vector3d StepConstraints::within_reach(const Eigen::Vector3d& step_m) const {
  const double length_m = length_of(step_m);
  return length_m <= room_.reach_m ? step_m : Eigen::Vector3d(room_.reach_m / length_m * step_m);
}

double StepConstraints::worst_excess(const Eigen::Vector3d& step_m) const {
  double worst_m = 0;
  for (const Kept& kept : sets_) worst_m = std::max(worst_m, excess_of(kept, step_m).length_m);
  return worst_m;
}

bool StepConstraints::allow(const Eigen::Vector3d& step_m) const {
  const double tolerance_m = kTolerance * room_.reach_m;
  return length_of(step_m) <= room_.reach_m + tolerance_m && in_box(step_m) == step_m &&
         worst_excess(step_m) <= tolerance_m;
}

int StepConstraints::most_exceeded(const Eigen::Vector3d& step_m) const {
  double worst_m = kTolerance * room_.reach_m;
  int number = -1;
  for (const Kept& kept : sets_) {
    const double excess_m = excess_of(kept, step_m).length_m;
    if (excess_m <= worst_m) continue;
    worst_m = excess_m;
    number = kept.number;
  }
  return number;
}

Eigen::Vector3d StepConstraints::nearest(const Eigen::Vector3d& wanted_m) {
  if (allow(wanted_m)) return wanted_m;
  const Eigen::Vector3d step_m = alternate(wanted_m);
  if (zero_allowed_) {
    const double share = allowed_share(step_m);
    return share < 1 ? Eigen::Vector3d(share * step_m) : step_m;
  }
  return within_hard_bounds(
      worst_excess(step_m) <= kNoCommonStep * room_.reach_m ? step_m : least_excess(step_m));
}

/// Hard bounds are at least 0, so each of them allows a share of every step.
Eigen::Vector3d StepConstraints::within_hard_bounds(const Eigen::Vector3d& step_m) const {
  double share = 1;
  for (const Kept& kept : sets_) {
    const auto& [axis, sine, bound_m, hard_m] = kept.set;
    const double height_m = support(axis, sine, kept.cosine, step_m).height;
    if (height_m > hard_m) share = std::min(share, hard_m / height_m);
  }
  return share < 1 ? Eigen::Vector3d(share * step_m) : step_m;
}

/// Dykstra's iteration. Box and ball are the last sets of each sweep. The ball shortens a step
/// towards 0, and the step then stays in a box that contains 0, so the result is in both.
Eigen::Vector3d StepConstraints::alternate(const Eigen::Vector3d& wanted_m) {
  for (Kept& kept : sets_) kept.correction.setZero();
  Eigen::Vector3d step_m = wanted_m, of_box{0, 0, 0}, of_reach{0, 0, 0};
  for (int sweep = 0; sweep < kMaxSweeps; ++sweep) {
    const Eigen::Vector3d before_m = step_m;
    for (Kept& kept : sets_) {
      if (kept.correction.isZero(0) && surely_holds(kept, step_m)) continue;
      step_m += kept.correction;
      const Excess excess = excess_of(kept, step_m);
      kept.correction = std::max(0.0, excess.length_m) * excess.direction;
      step_m -= kept.correction;
    }
    const Eigen::Vector3d boxed_m = in_box(step_m + of_box);
    of_box += step_m - boxed_m;
    step_m = within_reach(boxed_m + of_reach);
    of_reach += boxed_m - step_m;
    if (length_of(step_m - before_m) < kConverged * room_.reach_m) break;
  }
  return within_reach(in_box(step_m));
}

/// Each set contains 0 and is convex, as the box does.
double StepConstraints::allowed_share(const Eigen::Vector3d& step_m) const {
  double share = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const double along_m = step_m[axis];
    if (along_m > room_.high_m[axis]) share = std::min(share, room_.high_m[axis] / along_m);
    if (along_m < room_.low_m[axis]) share = std::min(share, room_.low_m[axis] / along_m);
  }
  for (const Kept& kept : sets_) {
    const double excess_m = excess_of(kept, step_m).length_m;
    if (excess_m <= kTolerance * room_.reach_m) continue;
    share = std::min(share, kept.set.bound_m / (excess_m + kept.set.bound_m));
  }
  return share;
}

/// Gradient steps on ½ Σ excess², each as long as the mean of the single projections.
Eigen::Vector3d StepConstraints::least_excess(const Eigen::Vector3d& step_m) const {
  Eigen::Vector3d least_m = step_m;
  for (int i = 0; i < kLeastExcessSteps; ++i) {
    Eigen::Vector3d sum_m{0, 0, 0};
    for (const Kept& kept : sets_) {
      const Excess excess = excess_of(kept, least_m);
      sum_m += std::max(0.0, excess.length_m) * excess.direction;
    }
    least_m = within_reach(in_box(least_m - sum_m / static_cast<double>(sets_.size())));
  }
  return least_m;
}

}  // namespace ergocast
