// SPDX-License-Identifier: BSD-3-Clause
// The two tables of a run record, and the results that follow from them: the rows of each tick in
// trajectory.csv, the due rows of metrics.csv, and the facts of the summary.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <ostream>
#include <utility>
#include <vector>

#include "core/base/ids.h"
#include "core/measure/finds.h"
#include "core/measure/team_measures.h"
#include "core/mission/end_schedule.h"
#include "core/search/confirmations.h"
#include "logger/agent_reports.h"
#include "logger/observer.h"
#include "logger/received_amendments.h"
#include "logger/run_data.h"
#include "logger/waiting_states.h"
#include "team/mission_follower.h"

namespace ergocast {

/// How well the team covered a target.
struct TargetFacts {
  std::optional<Amendment> amendment;  ///< nothing: the plan's target
  Tick from = 0, until = 0;            ///< the world's ticks; `until` is the first one after it
  /// φ² against this target, of what was covered while it held. In the mission's basis, and with
  /// basis.free_domain also in cosines. NaN: nothing was covered in that time.
  double ergodic_metric = std::numeric_limits<double>::quiet_NaN(), cosine_metric = ergodic_metric;
};

/// The results of the whole run.
struct RunFacts {
  Tick ticks = 0;         ///< recorded
  Tick held_ticks = 0;    ///< of these, ticks that do not count because of a pause
  Tick former_ticks = 0;  ///< of these, recorded before this recorder resumed
  double ergodic_metric_first = 0, ergodic_metric_last = 0;
  std::vector<double> t_s, ergodic_metric;  ///< the rows of metrics.csv
  /// With basis.free_domain: φ² in cosines at the last row of the metrics; NaN: there is none.
  double cosine_metric_last = std::numeric_limits<double>::quiet_NaN();
  /// All targets in the order in which they held, if the target has changed; else empty.
  std::vector<TargetFacts> targets;
  /// The tick of the first row whose φ² is not a number: from there on the record has no coverage.
  std::optional<Tick> no_metric_from;
  Tick gaps = 0;                       ///< ticks without rows before the last row
  std::int64_t lost_positions = 0;     ///< of single vehicles, recorded on the line between others
  std::int64_t missing_positions = 0;  ///< of single vehicles, without which there is no row
  bool halted = false;                 ///< by an emergency stop: the last row stands still
  /// Real time, as the world counts them; with several drivers, the largest count.
  std::int64_t missed_deadlines = 0, skipped_ticks = 0;
  std::int64_t clamped_commands = 0;  ///< by the speed limit, likewise
  /// Where a distance is kept: the least distance of any two bodies at any recorded tick [m]. The
  /// greatest number if there is none.
  double nearest_m = std::numeric_limits<double>::max();
  /// For each agent with a station (core/mission/station.h): the greatest distance of its vehicle
  /// from there [m]. Recorded ticks of its rest and the end of the mission count.
  std::map<AgentId, double> from_home_m;
  /// What the team has found, of the mission's objects.
  Finds finds;
  /// With false alarms: contacts that were confirmed and are no objects.
  std::optional<int> wrong_confirmations;
  /// For each agent that was recalled: the first row in which it rests for that reason.
  std::map<AgentId, Tick> recalls;
};

/// Which tick a row is of.
struct RowTick {
  Tick tick = 0;
  Tick uncounted = 0;  ///< ticks before it that do not count, by the world
  bool counts = true;  ///< whether it counts itself, by the world

  /// Its number among the ticks that count.
  Tick counted() const { return tick - uncounted; }
  /// Whether it is the mission's last.
  bool is_last(Tick tick_count) const { return counts && counted() + 1 == tick_count; }
  /// Goes on to the next tick.
  void pass() {
    ++tick;
    uncounted += counts ? 0 : 1;
  }
};

/// What is known of the mission besides the world's states.
struct MissionKnowledge {
  const MissionFollower& follower;
  const AgentReports& reports;
  const ReceivedAmendments& amendments;
};

/// The header lines of the two files.
inline constexpr const char* kTrajectoryHeader = "tick,t_s,agent,x_m,y_m,vx_mps,vy_mps";
/// With objects to find, which only planes have: bit j of the last number is object j.
inline constexpr const char* kTrajectoryHeaderWithObjects =
    "tick,t_s,agent,x_m,y_m,vx_mps,vy_mps,detected";
/// With false alarms, which only planes have: the last number is the cell of a report, or -1.
inline constexpr const char* kTrajectoryHeaderWithReports =
    "tick,t_s,agent,x_m,y_m,vx_mps,vy_mps,detected,reported";
inline constexpr const char* kTrajectoryHeaderInSpace =
    "tick,t_s,agent,x_m,y_m,z_m,vx_mps,vy_mps,vz_mps";
/// The header of a mission's trajectory.csv.
const char* trajectory_header(const Mission& mission);
inline constexpr const char* kMetricsHeader =
    "tick,t_s,ergodic_metric,detection_probability,metric_spread,max_staleness_s,"
    "contributions_received,contributions_lost,blocked_share";

class RecordTables {
 public:
  /// Writes to streams that outlive it, and begins the metrics. @pre both are good
  RecordTables(std::ostream& trajectory, std::ostream& metrics);

  bool good() const { return trajectory_.good() && metrics_.good(); }
  void flush();

  /// Begins the trajectory of a mission.
  void begin(const Mission& mission);
  /// The same without a mission, if none has begun.
  void begin_without_mission();
  bool begun() const { return observer_.begun(); }
  /// Adds a former process's rows to the sums again. Returns which row is next. That is the last of
  /// those rows again if it may lack agents. @pre begun(), and no row has been written
  RowTick replay(const RunData& past, const MissionKnowledge& known);

  /// Writes the row of a tick whose state is `now`; `next` is the state after it.
  void write(const RowTick& row, const TickState& now, const TickState& next,
             const MissionKnowledge& known);
  /// The rows from `row` on will be missing, up to the one before `tick`.
  void skip(const RowTick& row, Tick tick);

  const RunFacts& facts() const { return facts_; }
  RunFacts& facts() { return facts_; }
  /// How likely the rows so far have found an object of the newest target.
  double detection_probability() const { return measures_.detection().probability(); }
  std::vector<Contact> contacts() const { return confirmations_.contacts(); }
  /// What the team has achieved so far; costs a pass over all cells. @pre begun()
  TeamFigures team_figures() const { return measures_.figures(); }

 private:
  /// What a row is computed from, besides the states.
  struct Context {
    const RowTick& row;
    const MissionKnowledge& known;
    EndSchedule ends;
    std::int64_t roster_revision = -1;  // the world's; −1: not known
    const Mission& mission() const { return *known.follower.mission(); }
  };

  void write_trajectory(const Context& context, const TickState& now, const TickState& next);
  void note_home(const Mission& mission, AgentId id, const Eigen::Vector3d& x_m);
  bool is_recalled(const Context& context, AgentId id);
  /// Where a vehicle is, and the velocity with which it came there.
  struct Pose {
    Eigen::Vector3d x_m, v_mps;
  };
  /// What a sensor saw in a row.
  struct Seen {
    ObjectSet detected;
    std::int32_t cell;  // kNoCell: it reported nothing
  };
  Seen observe(const Context& context, AgentId id, const Pose& at, Seen seen);
  void begin_row(const Context& context);
  void begin_target(const Context& context, const ReceivedAmendment* change);
  void note_target(const Mission& mission, Tick until);
  void end_row(const Context& context);
  void write_due_metrics(const Context& context);
  void write_metrics(const Context& context, double metric);
  void note_metric(const Context& context, double metric);

  std::ostream& trajectory_;
  std::ostream& metrics_;
  Observer observer_;
  std::optional<Mission> in_cosines_;  // with basis.free_domain
  Observer cosines_;                   // observes in_cosines_, if there is one
  TeamMeasures measures_;
  Confirmations confirmations_;
  std::vector<Eigen::Vector3d> row_places_m_;    // of all bodies whose places were reported
  std::pair<Tick, AgentId> former_end_{-1, -1};  // a former process's last row, …
  MetricsRow former_metrics_{.tick = -1};        // … also of the metrics
  RunFacts facts_;
};

}  // namespace ergocast
