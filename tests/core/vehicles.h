// SPDX-License-Identifier: BSD-3-Clause
// Missions of one kind of vehicle, drawn vectors, and where a vehicle is within a tick.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "core/motion/vehicle.h"
#include "tests/support/team.h"

namespace ergocast::test {

inline VehicleLimits inertia(double max_acceleration_mps2) {
  return {VehicleKind::kAcceleration, max_acceleration_mps2};
}
inline VehicleLimits unicycle(double max_turn_radps) {
  return {VehicleKind::kUnicycle, 0, max_turn_radps};
}
inline VehicleLimits wings(double max_turn_radps, double min_speed_mps = 8) {
  return {VehicleKind::kFixedWing, 0, max_turn_radps, min_speed_mps};
}

inline Mission mission_of(const VehicleLimits& vehicle, double side_m = 2000) {
  Mission mission = test::small_mission(4);
  mission.domain.size_m = {side_m, side_m, 0};
  mission.speed_limit_mps = 20;
  mission.vehicle = vehicle;
  for (Eigen::Vector3d& start_m : mission.starts_m) start_m *= side_m / 2000;
  return mission;
}

inline Motion motion_in(const VehicleLimits& vehicle) { return motion_of(mission_of(vehicle), 0); }

class Drawn {
 public:
  double between(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(draw_);
  }
  Eigen::Vector3d vector(double longest) {
    return {between(-longest, longest), between(-longest, longest), 0};
  }

 private:
  std::mt19937 draw_{1};
};

inline double angle_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b));
}

/// Where a vehicle is within a tick, after a share of it.
inline Eigen::Vector3d place_within_m(const Motion& motion, const Eigen::Vector3d& x_m,
                                      const Eigen::Vector3d& v_mps, const Eigen::Vector3d& next_mps,
                                      double share) {
  const double t_s = share * motion.dt_s;
  if (motion.has_inertia())
    return x_m + v_mps * t_s + 0.5 * t_s * t_s * (next_mps - v_mps) / motion.dt_s;
  const double turn = motion.is_point() ? 0 : angle_between(v_mps, next_mps);
  const Eigen::Vector3d whole_m = mean_velocity(motion, v_mps, next_mps) * motion.dt_s;
  if (std::abs(turn) < 1e-9) return x_m + share * whole_m;
  const Eigen::Vector3d part_m = std::sin(share * turn / 2) / std::sin(turn / 2) * whole_m;
  const double back = (share - 1) * turn / 2;
  return x_m + Eigen::AngleAxisd(back, Eigen::Vector3d::UnitZ()) * part_m;
}

}  // namespace ergocast::test
