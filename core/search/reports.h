// SPDX-License-Identifier: BSD-3-Clause
// What the sensors of the simulated world report, if they have false alarms.
//
// In a tick a sensor reports one place or none. If it detects an object (core/measure/objects.h),
// that is the object's place with an error, which is normal along x and along y. Else it may be a
// false alarm, uniform over what the sensor sees. A place is told as a cell of
// core/search/search_cells.h. Reports are a function of plan, seed, agent, tick and place.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/measure/finds.h"
#include "core/mission/mission.h"
#include "core/search/search_cells.h"

namespace ergocast {

class Reports {
 public:
  /// Nothing is ever reported.
  Reports() = default;
  explicit Reports(const Mission& mission);

  /// The cell that the sensor of an agent at `x_m` reports; kNoCell: none.
  /// @param detected  what it detects
  /// @param places_m  of the objects at this tick, by number
  std::int32_t cell(AgentId id, Tick tick, const Eigen::Vector3d& x_m, ObjectSet detected,
                    const std::vector<Eigen::Vector3d>& places_m) const;

 private:
  std::optional<Cells> cells_;  // nothing: no sensor has false alarms
  Box domain_;
  std::uint64_t seed_ = 0;
  double radius_m_ = 0, error_m_ = 0;
  double probability_ = 0;  // of a false alarm in a tick
};

}  // namespace ergocast
