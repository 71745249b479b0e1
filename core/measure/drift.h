// SPDX-License-Identifier: BSD-3-Clause
// Where drifting objects of the simulated world are: a persistent random walk.
//
// An object moves at the speed v in legs of the length T. From leg to leg its heading turns by a
// normal angle with the variance 2 T / τ, where τ is the persistence. So cos of what it turns by in
// a time t has the mean exp(−t/τ), and far from walls the mean square distance after it is
//
//   2 v² τ (t − τ (1 − exp(−t/τ)))   [m²]
//
// T is an eighth of τ, or the time for an eighth of the domain's shorter side if that is less. A
// leg that would leave the domain or touch a wall is replaced by one with another heading, which is
// uniform. If kHeadings of them fail, the object stands still for that leg.
//
// A place is a function of (mission, seed, object, tick of the world). It needs all legs before it,
// which are computed once. After kMaxLegs legs of all objects together they stand still.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/ids.h"
#include "core/mission/mission.h"

namespace ergocast {

/// Limit (Scenario): legs of all drifting objects together. A leg takes an eighth of
/// `Motion.persistence_s`, or less. Beyond it: the scenario is refused.
inline constexpr std::int64_t kMaxLegs = 1 << 18;

/// T in steps, at least one.
Tick leg_ticks(const Mission& mission);

/// How many legs all objects have up to the mission's end.
std::int64_t drift_legs(const Mission& mission);

/// The greatest speed at which an object moves by an eighth of the domain's shorter side in a step.
double max_drift_mps(const Box& domain, double dt_s);

/// The mean square distance after a time [m²].
double mean_square_m2(const ObjectMotion& motion, double t_s);

/// After how long the root of mean_square_m2() is a distance [s]. @pre motion.any()
double time_to_drift_s(const ObjectMotion& motion, double distance_m);

class Drift {
 public:
  Drift() = default;
  /// @param places_m  where the objects begin, by number
  /// @pre a plane
  Drift(const Mission& mission, std::vector<Eigen::Vector3d> places_m);

  /// Where an object is at a tick. Ticks may come in any order; it is soonest if they ascend.
  Eigen::Vector3d place_m(std::size_t object, Tick tick);

 private:
  /// An object's legs so far: where each begins, and where the last one ends.
  struct Course {
    std::vector<Eigen::Vector2d> corners_m;
    double heading = 0;
  };
  void add_leg(std::size_t object);
  bool is_free(const Eigen::Vector2d& from_m, const Eigen::Vector2d& to_m) const;

  Box domain_;
  IndexedRings walls_;
  std::uint64_t seed_ = 0;
  Tick leg_ticks_ = 1, last_leg_ = 0;
  double leg_m_ = 0, turn_ = 0;  // of a leg: its length, the standard deviation of its turn
  std::vector<Course> courses_;
};

}  // namespace ergocast
