// SPDX-License-Identifier: BSD-3-Clause
// Adds legs to an object's course until they reach the tick, and interpolates within a leg.
#include "core/measure/drift.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/base/noise.h"
#include "core/base/portable_math.h"

namespace ergocast {
namespace {

constexpr double kLegsPerPersistence = 8, kLegsPerSide = 8;
constexpr std::uint64_t kHeadings = 16;
/// Numbers of random draws that belong to a leg: its turn, kHeadings headings, and the first one.
constexpr std::uint64_t kDrawsPerLeg = 32;

Eigen::Vector2d towards(double heading) { return {portable::cos(heading), portable::sin(heading)}; }

}  // namespace

Tick leg_ticks(const Mission& mission) {
  const ObjectMotion& motion = mission.objects.motion;
  const double side_s = mission.domain.shortest_side_m() / kLegsPerSide / motion.speed_mps;
  const double leg_s = std::min(motion.persistence_s / kLegsPerPersistence, side_s);
  return std::max<Tick>(1, static_cast<Tick>(std::min(leg_s / mission.timing.dt_s, 1e9)));
}

std::int64_t drift_legs(const Mission& mission) {
  return mission.objects.total() * (mission.timing.tick_count / leg_ticks(mission) + 1);
}

double max_drift_mps(const Box& domain, double dt_s) {
  return domain.shortest_side_m() / kLegsPerSide / dt_s;
}

double mean_square_m2(const ObjectMotion& motion, double t_s) {
  const double share = t_s / motion.persistence_s;
  const double length_m = motion.speed_mps * motion.persistence_s;
  return 2 * length_m * length_m * (share + portable::expm1(-share));
}

double time_to_drift_s(const ObjectMotion& motion, double distance_m) {
  // It is never faster than straight, and doubling a time that is too short reaches the distance.
  double low_s = distance_m / motion.speed_mps, high_s = low_s;
  const double square_m2 = distance_m * distance_m;
  for (int i = 0; i < 200 && mean_square_m2(motion, high_s) < square_m2; ++i) high_s *= 2;
  for (int i = 0; i < 60; ++i) {
    const double middle_s = (low_s + high_s) / 2;
    (mean_square_m2(motion, middle_s) < square_m2 ? low_s : high_s) = middle_s;
  }
  return high_s;
}

Drift::Drift(const Mission& mission, std::vector<Eigen::Vector3d> places_m)
    : domain_(mission.domain),
      walls_(mission.walls),
      seed_(mission.seed),
      leg_ticks_(leg_ticks(mission)),
      last_leg_(kMaxLegs / std::max<std::int64_t>(1, std::ssize(places_m))) {
  const double leg_s = static_cast<double>(leg_ticks_) * mission.timing.dt_s;
  leg_m_ = leg_s * mission.objects.motion.speed_mps;
  turn_ = std::sqrt(2 * leg_s / mission.objects.motion.persistence_s);
  for (const Eigen::Vector3d& x_m : places_m) {
    const auto object = static_cast<std::uint32_t>(courses_.size());
    const double draw = uniform_pair(seed_, Purpose::kDrift, object, kDrawsPerLeg - 1).x();
    courses_.push_back({{x_m.head<2>()}, 2 * std::numbers::pi * draw});
  }
}

bool Drift::is_free(const Eigen::Vector2d& from_m, const Eigen::Vector2d& to_m) const {
  if (!domain_.contains({to_m.x(), to_m.y(), domain_.origin_m.z()})) return false;
  const Segment way{from_m, to_m};
  return !walls_.find_near(way, 0, [&](const auto& edge) { return touch(edge.segment, way); });
}

void Drift::add_leg(std::size_t object) {
  Course& course = courses_[object];
  const Eigen::Vector2d from_m = course.corners_m.back();
  const auto who = static_cast<std::uint32_t>(object);
  const std::uint64_t first = (course.corners_m.size() - 1) * kDrawsPerLeg;
  course.heading += turn_ * normal_pair(seed_, Purpose::kDrift, who, first).x();
  Eigen::Vector2d to_m = from_m + leg_m_ * towards(course.heading);
  for (std::uint64_t i = 1; i <= kHeadings && !is_free(from_m, to_m); ++i) {
    const double draw = uniform_pair(seed_, Purpose::kDrift, who, first + i).x();
    course.heading = 2 * std::numbers::pi * draw;
    to_m = from_m + leg_m_ * towards(course.heading);
  }
  course.corners_m.push_back(is_free(from_m, to_m) ? to_m : from_m);
}

Eigen::Vector3d Drift::place_m(std::size_t object, Tick tick) {
  const Tick at = std::clamp<Tick>(tick, 0, last_leg_ * leg_ticks_);
  const auto leg = static_cast<std::size_t>(at / leg_ticks_);
  std::vector<Eigen::Vector2d>& corners_m = courses_[object].corners_m;
  while (corners_m.size() < leg + 2) add_leg(object);
  const double share = static_cast<double>(at % leg_ticks_) / static_cast<double>(leg_ticks_);
  Eigen::Vector3d x_m(0, 0, 0);
  x_m.head<2>() = corners_m[leg] + share * (corners_m[leg + 1] - corners_m[leg]);
  return domain_.nearest(x_m);
}

}  // namespace ergocast
