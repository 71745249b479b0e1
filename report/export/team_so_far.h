// SPDX-License-Identifier: BSD-3-Clause
// What a display of a running team had shown by a tick of its record.
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <vector>

#include "core/measure/detection.h"
#include "core/measure/finds.h"
#include "core/measure/occupancy.h"
#include "core/measure/thinned_path.h"
#include "core/mission/kinds.h"
#include "core/search/confirmations.h"
#include "report/export/record.h"

namespace ergocast {

class TeamSoFar {
 public:
  /// @param record  outlives this object
  explicit TeamSoFar(const ExportRecord& record);

  /// The next row, as for_each_row() visits them.
  void add(AgentId agent, const TrackPoint& point);

  /// Where the team has been, whatever its targets were. Empty before the first sample.
  OccupancyGrid coverage() const;
  OccupancyGrid left() const { return occupancy_left(detection_, target_, mission_); }
  const std::map<AgentId, ThinnedPath>& paths() const { return paths_; }
  /// By the agents' places when they found them.
  const std::vector<Find>& finds() const { return finds_.list(); }
  /// The middles of the cells with reports.
  std::vector<Eigen::Vector3d> contacts_m() const;

 private:
  void follow_target(Tick tick);

  const ExportRecord& record_;
  const Mission& mission_;
  Sensors sensors_;
  RecordedRests rests_;
  Detection detection_;
  Confirmations confirmations_;
  Finds finds_;
  Coefficients target_;
  const ReceivedAmendment* change_ = nullptr;  // the one of `target_`; null: the plan's
  Coefficients sums_;
  double samples_ = 0;  // each weighted by its quality
  std::map<AgentId, ThinnedPath> paths_;
  std::set<std::int32_t> reported_cells_;
};

}  // namespace ergocast
