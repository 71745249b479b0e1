// SPDX-License-Identifier: BSD-3-Clause
// Reads a run directory: the two tables, and the coverage that follows from them.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/base/ids.h"
#include "core/base/result.h"
#include "core/basis/basis.h"
#include "core/measure/finds.h"
#include "core/mission/end_schedule.h"
#include "core/mission/hold.h"
#include "core/mission/mission.h"
#include "core/search/search_cells.h"
#include "logger/received_amendments.h"
#include "logger/slope.h"

namespace ergocast {

/// One row of trajectory.csv.
struct TrackPoint {
  Tick tick = 0;
  double t_s = 0;
  Eigen::Vector3d x_m{0, 0, 0};
  Eigen::Vector3d v_mps{0, 0, 0};        ///< the command computed at x_m
  ObjectSet detected = 0;                ///< of the mission's objects
  std::int32_t reported_cell = kNoCell;  ///< by its sensor
};
using Track = std::vector<TrackPoint>;  ///< ascending by tick

/// One row of metrics.csv.
struct MetricsRow {
  Tick tick = 0;
  double t_s = 0;
  double ergodic_metric = 0;
  double detection_probability = 0;  ///< core/measure/detection.h
  double spread = 0;                 ///< largest minus smallest φ² among the agents' own views
  double max_staleness_s = 0;
  double received = 0, lost = 0;  ///< contributions, since the start
  double blocked_share = 0;       ///< of agents' ticks, since the start
};

struct RunData {
  std::map<AgentId, Track> tracks;  ///< without empty ones
  std::vector<MetricsRow> metrics;
  /// What has changed since the plan, from amendments.json; pauses also from summary.json.
  ReceivedAmendments amendments;
  /// From which tick on a recalled agent rests, from recalls.json or summary.json.
  std::map<AgentId, Tick> recalls;

  /// Ticks that do not count.
  const std::vector<Hold>& holds() const { return amendments.holds(); }
  bool empty() const { return tracks.empty(); }
  double end_s() const;  ///< time of the last row, 0 if there is none
};

/// The velocity with which the vehicle of a track came to its place at a tick: that of the row
/// before. Infinite if there is no such row. @pre the track ascends
Eigen::Vector3d came_with_mps(const Track& track, Tick tick);

/// Which agents of a record rest at which tick: by the plan and its other ends, because they were
/// recalled, or because their batteries are charged.
class RecordedRests {
 public:
  /// @param run      outlives this object, as `mission` does
  RecordedRests(const RunData& run, const Mission& mission)
      : run_(run), mission_(mission), ends_(mission, run.holds(), run.amendments.ends()) {}

  bool rests(AgentId id, Tick tick) const;

 private:
  bool charges(AgentId id, Tick tick) const;

  const RunData& run_;
  const Mission& mission_;
  EndSchedule ends_;
};

/// The mission of the record's plan.binpb, or an error that names the file.
Result<Mission> read_mission(const std::filesystem::path& run_dir);

/// Reads trajectory.csv and metrics.csv with all their segments, and what changed in flight.
/// Otherwise returns the file and line of an error, with the remedy. A file's last line without its
/// line break comes from a killed process and is ignored.
/// @param mission  read_mission() of the same folder
Result<RunData> read_run(const std::filesystem::path& run_dir, const Mission& mission);

/// Reads only trajectory.csv in the same way.
Result<RunData> read_tracks(const std::filesystem::path& run_dir);

/// Reads the same into `run`, but of each file only the rows before its first bad line. Returns the
/// problem of the first such line of all files, or nothing if there is none.
std::optional<std::string> read_up_to_damage(const std::filesystem::path& run_dir, RunData& run);

/// Visits trajectory.csv's rows in their order: ascending by tick, then by agent.
void for_each_row(const RunData& run, const std::function<void(AgentId, const TrackPoint&)>& visit);

/// φ² over the last decade of time, as slope.h fits it.
std::optional<PowerLaw> fit_last_decade(const RunData& run);

/// c_k of (4) over every recorded position inside the domain: where the team has been, whatever its
/// targets were. All zero for an empty run.
Coefficients coverage_of(const RunData& run, const Mission& mission);

}  // namespace ergocast
