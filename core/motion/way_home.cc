// SPDX-License-Identifier: BSD-3-Clause
// Compares the time left with the time that the way takes, and brakes at its end.
#include "core/motion/way_home.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <utility>

#include "core/base/geometry.h"
#include "core/base/portable_math.h"
#include "core/mission/station.h"
#include "core/motion/home.h"
#include "core/motion/walls.h"
#include "core/motion/zones.h"

namespace ergocast {
namespace {

/// Multiple of v/A that it takes to turn round, and to brake at half of A.
constexpr double kTurnsRound = 3;
/// Circles of a fixed wing, which turns to one side only near its station.
constexpr double kCircles = 3;
/// The factor for turns among walls, where there are corners.
constexpr double kCorners = 3;
/// Standard deviations of a way that is disturbed.
constexpr double kWayDeviations = 4;
/// The cosine of the angle beyond which a vehicle turns before it goes on.
constexpr double kAhead = 0.99;
/// The same for a fixed wing, if it does not turn farther in a tick.
constexpr double kAheadOfWings = 0.9;
/// How long a body that needs no time to turn or brake may get hardly further on a detour.
constexpr double kPatience_s = 2;
/// The speed of a command that only turns a unicycle, as a share of its own speed.
constexpr double kLookingShare = 1e-6;

/// How long a body that follows late takes to close up to an edge: 4 T for each factor of e, down
/// to a tick.
double closing_s(double response_s, double dt_s) {
  if (response_s <= 0) return 0;
  int folds = 0;
  while (std::ldexp(dt_s, folds) < 2 * response_s) ++folds;
  return 4 * response_s * (1 + folds);
}

}  // namespace

double slack_on_way_s(const Mission& mission, AgentId id) {
  const Motion motion = motion_of(mission, id);
  const double speed_mps = home_speed_mps(mission, id);
  const double dt_s = motion.dt_s, corners = mission.walls.empty() ? 1 : kCorners;
  const VehicleLimits& vehicle = motion.vehicle;
  double slack = 2 * dt_s + closing_s(mission.separation.response_s, dt_s);
  if (mission.timing.pace == Pace::kRealtime) slack += 2 * dt_s + mission.timing.command_hold_s;
  if (motion.has_inertia())
    slack += corners * kTurnsRound * speed_mps / vehicle.max_acceleration_mps2;
  const bool turns = vehicle.max_turn_radps > 0, circles = vehicle.kind == VehicleKind::kFixedWing;
  if (turns)
    slack += corners * (circles ? 2 * kCircles : 1) * std::numbers::pi / vehicle.max_turn_radps;
  return slack;
}

double drift_on_way_s(const Mission& mission, AgentId id, double travel_s) {
  const double drift = kWayDeviations * mission.disturbance_intensity / home_speed_mps(mission, id);
  return drift * std::sqrt(travel_s);
}

WayHome::WayHome(const Mission& mission, AgentId id)
    : motion_(motion_of(mission, id)),
      home_m_(home_of(mission, id).value()),
      rest_from_(rest_from(mission, id)),
      speed_mps_(home_speed_mps(mission, id)),
      slack_s_(slack_on_way_s(mission, id)),
      ahead_(motion_.vehicle.min_speed_mps == 0
                 ? kAhead
                 : std::min(kAheadOfWings,
                            portable::cos(std::min(motion_.vehicle.max_turn_radps * motion_.dt_s,
                                                   std::numbers::pi / 2)))),
      drift_(kWayDeviations * mission.disturbance_intensity / speed_mps_),
      way_(mission, motion_),
      detour_(static_cast<std::int64_t>(std::ceil((kPatience_s + slack_s_) / motion_.dt_s)),
              speed_mps_ * motion_.dt_s) {
  way_.lead_to(home_m_);
}

void WayHome::note_zones(const Mission& mission, std::vector<Zone> zones) {
  if (way_.note_zones(mission, std::move(zones))) begun_ = false;  // a way may be open again
}

double WayHome::needed_s(const Eigen::Vector3d& x_m) const {
  const double travel_s = way_.length_m(x_m) / speed_mps_;
  if (std::isinf(travel_s)) return travel_s;  // 0 · ∞ is not a number
  return travel_s + drift_ * std::sqrt(travel_s) + slack_s_;
}

void WayHome::set_rest(Tick counted) {
  if (counted == rest_from_) return;
  rest_from_ = counted;
  begun_ = false;
}

bool WayHome::begun(Tick counted, const Eigen::Vector3d& x_m) {
  const double left_s = static_cast<double>(rest_from_ - counted) * motion_.dt_s;
  begun_ = begun_ || left_s <= needed_s(x_m);
  return begun_;
}

/// The speed at which it still stops at the end of the way: with inertia it brakes at half of A.
double WayHome::speed_mps(double way_m) const {
  const double dt_s = motion_.dt_s;
  if (!motion_.has_inertia()) return std::min(speed_mps_, way_m / dt_s);
  const double a_mps2 = motion_.vehicle.max_acceleration_mps2;
  return std::min({speed_mps_, std::sqrt(a_mps2 * way_m), way_m / (2 * dt_s)});
}

Eigen::Vector3d WayHome::velocity_mps(const Eigen::Vector3d& x_m, const Eigen::Vector3d& v_mps) {
  const Eigen::Vector3d at_m = anchor_m(motion_, x_m, v_mps);
  Eigen::Vector3d to_m = way_.next_place_m(at_m) - at_m;
  if (motion_.domain.planar()) to_m.head<2>() = detour_.round(at_m.head<2>(), to_m.head<2>());
  const double apart_m = length_of(to_m), way_m = length_of(home_m_ - at_m);
  if (apart_m == 0) return {0, 0, 0};
  if (motion_.vehicle.max_turn_radps > 0) return turning_mps(to_m, way_m, v_mps);
  return to_m * (speed_mps(way_m) / apart_m);
}

/// A vehicle that looks elsewhere turns first: on the spot, or on its loiter circle, whose centre
/// stays.
Eigen::Vector3d WayHome::turning_mps(const Eigen::Vector3d& to_m, double way_m,
                                     const Eigen::Vector3d& v_mps) const {
  const double slowest_mps = motion_.vehicle.min_speed_mps, apart_m = length_of(to_m);
  const double near_m = std::max(slowest_mps, speed_mps_ / 2) * motion_.dt_s;
  if (way_m <= near_m) return {0, 0, 0};
  const double now_mps = length_of(v_mps);
  const Eigen::Vector3d looks =
      now_mps > 0 ? Eigen::Vector3d(v_mps / now_mps) : Eigen::Vector3d(1, 0, 0);
  const double speed = std::max(slowest_mps, speed_mps(way_m));
  if (looks.dot(to_m) >= ahead_ * apart_m) return to_m * (speed / apart_m);
  if (slowest_mps > 0) return {0, 0, 0};
  return to_m * (kLookingShare * speed_mps_ / apart_m);
}

}  // namespace ergocast
