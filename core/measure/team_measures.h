// SPDX-License-Identifier: BSD-3-Clause
// What a team has achieved, in figures that users ask for: what it would have found, how long it
// has left places alone, how far its time is from the target, how far it has moved.
//
// Only ticks that count, and agents that cover, count for the first three. If the target changes,
// they are of the newest target alone, except ages.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "core/base/ids.h"
#include "core/measure/detection.h"
#include "core/mission/mission.h"

namespace ergocast {

/// The share of the target's mass of which the greatest age is reported.
inline constexpr double kWatchedShare = 0.95;

struct TeamFigures {
  double detection_probability = 0;  ///< P of core/measure/detection.h
  /// From the newest target on until P was ½ and ⅘ [s].
  std::optional<double> half_time_s, four_fifths_time_s;
  double greatest_age_s = 0;  ///< over kWatchedShare of the mass
  double wasserstein_m = 0;   ///< between the time spent and the target; nan: none was spent
  double path_m = 0;          ///< of all bodies together, also in pauses and at rest
};

class TeamMeasures {
 public:
  TeamMeasures() = default;
  /// @pre mission is in the basis (2), core/mission/mission.h in_cosines()
  explicit TeamMeasures(const Mission& mission);

  /// The team covers `target`, in the basis (2), from tick `counted` on.
  void begin_target(const Mission& mission, const Coefficients& target, Tick counted);
  /// Body `id` was at `x_m` at tick `counted`; ticks ascend.
  /// @param covers  whether its time there counts
  void see(AgentId id, Tick counted, const Eigen::Vector3d& x_m, bool covers);
  /// Tick `counted` is over.
  void pass(Tick counted);

  /// All figures; costs a pass over all cells.
  TeamFigures figures() const;
  const Detection& detection() const { return detection_; }

 private:
  Box domain_;
  Detection detection_;
  std::vector<double> time_;  // ticks in each cell since the newest target
  std::map<AgentId, Eigen::Vector3d> places_m_;
  double path_m_ = 0;
  Tick ticks_ = 0;  // that are over
};

}  // namespace ergocast
