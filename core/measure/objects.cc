// SPDX-License-Identifier: BSD-3-Clause
// Draws each object's cell by the cells' masses, and then a free place in the cell.
#include "core/measure/objects.h"

#include <algorithm>
#include <numeric>

#include "core/base/noise.h"
#include "core/base/portable_math.h"
#include "core/measure/detection.h"
#include "core/measure/target_mass.h"

namespace ergocast {
namespace {

/// How many places in its cell are tried for an object. After that it is in the middle, which is
/// free.
constexpr std::uint64_t kTries = 64;

/// @param mission  in the basis (2)
std::vector<Eigen::Vector3d> drawn_places_m(const Mission& mission) {
  const Cells cells = measure_cells(mission);
  std::vector<double> below =
      target_mass(mission.basis, mission.walls, mission.target_coefficients, cells);
  std::partial_sum(below.begin(), below.end(), below.begin());
  std::vector<Eigen::Vector3d> places_m;
  for (int object = 0; object < mission.objects.count; ++object) {
    const auto drawn = [&](std::uint64_t step) {
      return uniform_pair(mission.seed, Purpose::kObject, static_cast<std::uint32_t>(object), step);
    };
    // The first cell of which the sum exceeds the number has a mass.
    const auto chosen = std::ranges::upper_bound(below, drawn(0).x() * below.back());
    const auto cell = static_cast<int>(std::min(chosen, below.end() - 1) - below.begin());
    const int i = cell / cells.count.y(), j = cell % cells.count.y();
    const Eigen::Vector3d middle_m(cells.center_m(0, i), cells.center_m(1, j), 0);
    Eigen::Vector3d x_m = middle_m;
    for (std::uint64_t step = 1; step <= kTries; ++step) {
      const Eigen::Vector2d off = drawn(step).array() - 0.5;
      x_m.head<2>() = middle_m.head<2>() + off.cwiseProduct(cells.size_m.head<2>());
      if (!mission.walls.solid_at(x_m.head<2>())) break;
      x_m = middle_m;
    }
    places_m.push_back(x_m);
  }
  return places_m;
}

}  // namespace

Objects::Objects(const Mission& mission)
    : places_m_(mission.objects.count > 0 ? drawn_places_m(in_cosines(mission))
                                          : mission.objects.places_m),
      seed_(mission.seed),
      radius_m_(sensor_radius_m(mission)),
      probability_(-portable::expm1(-mission.sensor.detections_per_s * mission.timing.dt_s)) {
  if (mission.objects.motion.any() && !places_m_.empty()) drift_.emplace(mission, places_m_);
}

void Objects::move_to(Tick tick) {
  for (std::size_t object = 0; drift_ && object < places_m_.size(); ++object)
    places_m_[object] = drift_->place_m(object, tick);
}

ObjectSet Objects::detected(AgentId id, Tick tick, const Eigen::Vector3d& x_m) {
  move_to(tick);
  ObjectSet set = 0;
  for (std::uint32_t object = 0; object < places_m_.size(); ++object) {
    if ((x_m - places_m_[object]).squaredNorm() > radius_m_ * radius_m_) continue;
    const std::uint32_t who = static_cast<std::uint32_t>(id) * kMaxObjects + object;
    const double draw =
        uniform_pair(seed_, Purpose::kDetection, who, static_cast<std::uint64_t>(tick)).x();
    if (draw < probability_) set |= ObjectSet{1} << object;
  }
  return set;
}

}  // namespace ergocast
