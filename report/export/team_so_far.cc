// SPDX-License-Identifier: BSD-3-Clause
// Counts what the recorder counts: no pauses, no agents at rest, no places outside of the domain.
#include "report/export/team_so_far.h"

#include "core/measure/target_mass.h"
#include "core/search/search_cells.h"

namespace ergocast {

TeamSoFar::TeamSoFar(const ExportRecord& record)
    : record_(record),
      mission_(record.mission),
      sensors_(mission_),
      rests_(record.run, mission_),
      detection_(mission_),
      confirmations_(mission_),
      finds_(mission_.objects.total()),
      target_(mission_.target_coefficients),
      sums_(Coefficients::Zero(mission_.basis.mode_count())) {
  detection_.begin_target(target_mass(mission_.basis, mission_.walls, target_, detection_.cells()),
                          0);
  confirmations_.begin_target(target_);
}

void TeamSoFar::follow_target(Tick tick) {
  const ReceivedAmendment* const change = record_.run.amendments.target_at(tick);
  if (change == change_) return;
  change_ = change;
  target_ = change != nullptr && change->target ? change->target->in_cosines()
                                                : mission_.target_coefficients;
  detection_.begin_target(target_mass(mission_.basis, mission_.walls, target_, detection_.cells()),
                          counted_ticks(record_.run.holds(), tick));
  confirmations_.begin_target(target_);
}

void TeamSoFar::add(AgentId agent, const TrackPoint& point) {
  follow_target(point.tick);
  paths_[agent].add(point.x_m);
  const std::vector<Hold>& holds = record_.run.holds();
  if (!mission_.domain.contains(point.x_m) || rests_.rests(agent, point.tick) ||
      is_held(holds, point.tick))
    return;
  const Tick counted = counted_ticks(holds, point.tick);
  detection_.see(counted, point.x_m);
  samples_ += sensors_.of(planned_kind(mission_, agent))
                  .sample(BasisAt(point.x_m, mission_.domain, mission_.basis), mission_.basis, 1,
                          sums_.data());
  if (point.reported_cell != kNoCell) reported_cells_.insert(point.reported_cell);
  finds_.note(confirmations_.see(agent, counted, point.x_m, finds_.known(point.detected),
                                 point.reported_cell),
              {.agent = agent, .tick = point.tick, .t_s = point.t_s, .x_m = point.x_m});
}

OccupancyGrid TeamSoFar::coverage() const {
  return samples_ > 0 ? occupancy_of(sums_ / samples_, target_, mission_) : OccupancyGrid();
}

std::vector<Eigen::Vector3d> TeamSoFar::contacts_m() const {
  std::vector<Eigen::Vector3d> middles_m;
  if (reported_cells_.empty() || !mission_.domain.planar()) return middles_m;
  const Cells cells = SearchCells(mission_).cells;
  const int rows = cells.count.y();
  for (const std::int32_t cell : reported_cells_) {
    if (static_cast<std::size_t>(cell) >= cells.total()) continue;
    middles_m.emplace_back(cells.center_m(0, cell / rows), cells.center_m(1, cell % rows), 0);
  }
  return middles_m;
}

}  // namespace ergocast
