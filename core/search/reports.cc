// SPDX-License-Identifier: BSD-3-Clause
// Draws each report from numbers of its own.
#include "core/search/reports.h"

#include <bit>
#include <cmath>
#include <numbers>

#include "core/base/noise.h"
#include "core/base/portable_math.h"
#include "core/measure/detection.h"

namespace ergocast {

Reports::Reports(const Mission& mission)
    : domain_(mission.domain),
      seed_(mission.seed),
      radius_m_(sensor_radius_m(mission)),
      error_m_(mission.sensor.position_error_m),
      probability_(-portable::expm1(-mission.sensor.false_alarms_per_s * mission.timing.dt_s)) {
  if (mission.sensor.has_false_alarms()) cells_ = SearchCells(mission).cells;
}

std::int32_t Reports::cell(AgentId id, Tick tick, const Eigen::Vector3d& x_m, ObjectSet detected,
                           const std::vector<Eigen::Vector3d>& places_m) const {
  if (!cells_) return kNoCell;
  const auto who = static_cast<std::uint32_t>(id);
  const auto step = static_cast<std::uint64_t>(tick);
  Eigen::Vector3d place_m;
  if (detected != 0) {
    const auto object = static_cast<std::size_t>(std::countr_zero(detected));
    place_m = places_m[object];
    place_m.head<2>() += error_m_ * normal_pair(seed_, Purpose::kReport, who, step);
    place_m = domain_.nearest(place_m);
  } else {
    if (uniform_pair(seed_, Purpose::kFalseAlarm, who, 2 * step).x() >= probability_)
      return kNoCell;
    const Eigen::Vector2d draw = uniform_pair(seed_, Purpose::kFalseAlarm, who, 2 * step + 1);
    const double off_m = radius_m_ * std::sqrt(draw.x());
    const double angle = 2 * std::numbers::pi * draw.y();
    place_m = x_m + off_m * Eigen::Vector3d(portable::cos(angle), portable::sin(angle), 0);
    if (!domain_.contains(place_m)) return kNoCell;
  }
  return static_cast<std::int32_t>(cells_->cell_of(place_m));
}

}  // namespace ergocast
