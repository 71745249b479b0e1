// SPDX-License-Identifier: BSD-3-Clause
// The steps that a body may take in one tick, and the one that is nearest to what it wants.
//
// The set is an intersection of a ball ‖d‖ ≤ reach, of a box low ≤ d ≤ high that contains 0, and of
// sets  S = {d : u·d ≤ b for every unit vector u within the angle α of a}.
// The polar cone C of all these u has a projection in closed form, in any dimension. For b ≥ 0,
// S is C plus a ball of radius b; for b < 0, S is C with its apex at a·b/cos α. For α = 0, S is a
// half-space.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <limits>
#include <vector>

namespace ergocast {

class StepConstraints {
 public:
  static constexpr double kNoHardBound = std::numeric_limits<double>::max();

  /// One set S.
  struct Set {
    Eigen::Vector3d toward{1, 0, 0};  ///< a, a unit vector
    double sine = 0;                  ///< of α; 0 ≤ sine < 1
    double bound_m = 0;               ///< b; below 0 the step 0 is not allowed either
    /// The b of a wall, at least 0, that holds even where the sets have no step in common.
    double hard_bound_m = kNoHardBound;
  };
  /// What begin() takes: the length of the longest step, and the box.
  struct Room {
    double reach_m = 1;                                  ///< above 0
    Eigen::Vector3d low_m{-1, -1, -1}, high_m{1, 1, 1};  ///< low ≤ 0 ≤ high
  };

  /// How far above a bound a step counts as within it, as a share of the reach.
  static constexpr double kTolerance = 1e-12;

  /// @param capacity  how many sets it can hold. No later call allocates memory.
  explicit StepConstraints(std::size_t capacity);

  /// Forgets all sets.
  void begin(const Room& room);
  /// Adds a set. One that contains every step within reach costs nothing later.
  void add(const Set& set);

  double reach_m() const { return room_.reach_m; }

  /// Whether `step_m` is within reach, in the box and in every set, up to the tolerance.
  bool allow(const Eigen::Vector3d& step_m) const;
  /// The greatest share of `step_m`, at most all of it, that is in the box and in every set.
  /// @pre every bound is ≥ 0
  double allowed_share(const Eigen::Vector3d& step_m) const;
  /// The number of the set that `step_m` exceeds most, counted from 0 in the order of add();
  /// −1: it exceeds none.
  int most_exceeded(const Eigen::Vector3d& step_m) const;

  /// `wanted_m` bit for bit if it is allowed, else a step close to the nearest allowed one.
  ///
  /// Where every bound is ≥ 0, allow() holds for the result, whether or not the iteration has
  /// converged: every set contains 0, so a step that is too long is shortened. If a bound is
  /// negative and the sets have no step in common, the sum of the squared excesses of the result is
  /// small. The result is within reach, in the box and within every hard bound in each case.
  /// Only + − × ÷ √: the same bits on every machine.
  Eigen::Vector3d nearest(const Eigen::Vector3d& wanted_m);

 private:
  struct Kept {
    Set set;
    double cosine;  // of α
    int number;
    Eigen::Vector3d correction;  // of Dykstra's iteration
  };
  /// By how much a step exceeds a set [m], and the unit vector away from the set.
  struct Excess {
    double length_m;
    Eigen::Vector3d direction;
  };

  static bool surely_holds(const Kept& kept, const Eigen::Vector3d& step_m);
  static Excess excess_of(const Kept& kept, const Eigen::Vector3d& step_m);
  Eigen::Vector3d in_box(const Eigen::Vector3d& step_m) const;
  Eigen::Vector3d within_reach(const Eigen::Vector3d& step_m) const;
  double worst_excess(const Eigen::Vector3d& step_m) const;
  Eigen::Vector3d alternate(const Eigen::Vector3d& wanted_m);
  Eigen::Vector3d within_hard_bounds(const Eigen::Vector3d& step_m) const;
  Eigen::Vector3d least_excess(const Eigen::Vector3d& step_m) const;

  std::vector<Kept> sets_;
  int added_ = 0;
  Room room_;
  bool zero_allowed_ = true;
};

}  // namespace ergocast
