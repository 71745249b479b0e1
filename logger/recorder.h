// SPDX-License-Identifier: BSD-3-Clause
// The run record: trajectory.csv and metrics.csv from the world's states, as an outside observer.
//
// If each robot has a driver of its own, each driver sends one part of a state, and the recorder
// joins the parts. The rows of a part that does not arrive in time are missing.
//
// Tick n's row needs two states. State n has the position, and state n+1 has the velocity that the
// world applied in between. Rows are written in order and acknowledged to the world, which in
// lockstep repeats every missing state. Acknowledged rows are in the file, so a killed recorder
// receives all lost rows again. While its streams are bad, as on a full disk, no row is written and
// none acknowledged.
//
// In lockstep a row is missing only if no process can repeat its states. Such states precede the
// first one that a resumed recorder received, or the first one of a restarted world. Others are
// those of a time in which the recorder could not write, or in which the world had given up a
// disconnected recorder.
#pragma once

#include <limits>
#include <map>
#include <optional>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "core/base/ids.h"
#include "logger/observer.h"
#include "logger/run_data.h"
#include "team/messages.h"
#include "team/participant.h"

namespace ergocast {

/// The results of the whole run.
struct RunFacts {
  Tick ticks = 0;         ///< recorded
  Tick held_ticks = 0;    ///< of these, ticks that do not count because of a pause
  Tick former_ticks = 0;  ///< of these, recorded before this recorder resumed
  double ergodic_metric_first = 0, ergodic_metric_last = 0;
  std::vector<double> t_s, ergodic_metric;  ///< the rows of metrics.csv
  /// With basis.free_domain: φ² in cosines at the last row of the metrics; NaN: there is none.
  double cosine_metric_last = std::numeric_limits<double>::quiet_NaN();
  /// The tick of the first row whose φ² is not a number: from there on the record has no coverage.
  std::optional<Tick> no_metric_from;
  Tick gaps = 0;        ///< ticks without rows before the last row
  bool halted = false;  ///< by an emergency stop: the last row stands still
  /// Real time, as the world counts them; with several drivers, the largest count.
  std::int64_t missed_deadlines = 0, skipped_ticks = 0;
  std::int64_t clamped_commands = 0;  ///< by the speed limit, likewise
  /// Where a distance is kept: the least distance of any two bodies at any recorded tick [m]. The
  /// greatest number if there is none.
  double nearest_m = std::numeric_limits<double>::max();
  /// For each agent with a station (core/mission/station.h): the greatest distance of its vehicle
  /// from there [m]. Recorded ticks of its rest and the end of the mission count.
  std::map<AgentId, double> from_home_m;
};

/// The cost of the distance that bodies keep, from the newest status of each incarnation.
struct Blocks {
  double share = 0;        ///< the blocked part of all agents' answered ticks
  Tick longest_ticks = 0;  ///< in a row
};

class Recorder {
 public:
  static constexpr Role kRole = Role::kLogger;

  /// Writes to streams that outlive it; the caller repairs bad streams and calls go_on().
  /// @param run  the run to record; 0: the run of the first mission received
  /// @pre both streams are good: a stream that is bad from the beginning would never be written. To
  /// discard the tables, pass a NullBuffer (logger/null_buffer.h).
  Recorder(RunId run, Incarnation incarnation, std::ostream& trajectory, std::ostream& metrics);

  /// Continues the record of a former process with all its segments; the record may be empty. Its
  /// rows are added to the observer's sums again in their order, with the present roster. So φ²
  /// continues bit for bit. Metrics rows that are due and missing are written.
  /// @param plan  the record's: any other mission received is a plan_problem(); empty: any is
  /// accepted
  /// @pre nothing has been received
  void resume(RunData past, std::vector<std::byte> plan = {});

  /// The streams are good again: their buffered data is written. A world that has given this
  /// recorder up accepts it again under its new incarnation.
  void go_on(Instant now);

  void receive(const Message& message, Bus bus, AgentId transmitter, Instant now);
  void advance(Instant now, Outbox& out);
  /// Ends the record with the rows so far.
  void stop(std::string reason);
  Instant next_wakeup() const;

  /// True once the last tick is recorded or the mission is over, and nothing more can arrive.
  /// Nothing can arrive once world and agents have reported that they leave, or 1 s has passed.
  bool finished() const { return ending_.finished; }
  RunId run() const { return me_.run(); }
  const MissionFollower& follower() const { return me_.follower(); }
  /// "done" (its last tick is recorded), "failed" (also if φ² is not a number) or "stopped" (an
  /// operator ended it); reason() has the cause.
  const char* result() const;
  const std::string& reason() const { return ending_.reason; }
  const RunFacts& facts() const { return facts_; }
  /// The newest status of each incarnation that Liveness holds, with the worst loop lag of all its
  /// statuses.
  const std::map<Author, AgentStatus>& statuses() const { return statuses_; }
  Blocks blocks() const;
  Tick next_row() const { return next_row_; }
  /// The newest tick with a received state.
  Tick newest() const { return received_.newest; }

 private:
  struct State {
    Incarnation world = 0;
    std::vector<bool> parts;
    std::map<AgentId, Vehicle> vehicles;
    Tick uncounted = 0;  // ticks before it that do not count
    bool complete() const;
  };

  /// The messages received of the world.
  struct Received {
    Incarnation world = 0;    // the last one received
    Tick newest = 0;          // of the states received
    Tick lost_before = 0;     // states of earlier ticks may be gone for good
    bool world_left = false;  // its last message was received
  };
  struct Acknowledged {
    Tick tick = -2;
    Instant next{};
  };
  struct Ending {
    std::optional<Instant> since;  // from then on nothing more is expected
    bool finished = false, failed = false;
    std::string reason;
  };
  /// The record of a former process.
  struct Former {
    std::optional<RunData> rows;  // until the mission is known
    bool resumed = false;
    std::pair<Tick, AgentId> end{-1, -1};  // tick and agent of the last row
    MetricsRow metrics{.tick = -1};        // the last row
  };

  template <class M>
  void on(const M&, const Arrival&) {}  // the other types need no action
  void on(const WorldState& world, const Arrival& arrival);
  void on(const AgentStatus& status, const Arrival& arrival);
  void on(const MissionPart& part, const Arrival& arrival);
  void on(const Stop& stop, const Arrival& arrival);
  const Mission& mission() const { return me_.mission(); }
  void meet(const Header& world, Instant now);
  void begin();
  void replay(const RunData& past);
  void pass_row();
  bool writing() const { return trajectory_.good() && metrics_.good(); }
  void write_rows(Instant now);
  void acknowledge(Instant now, Outbox& out);
  bool write_next_row();
  bool holds(Tick tick) const;
  bool has_drivers() const;
  /// The number of the next row's tick among those that count.
  Tick counted() const { return next_row_ - uncounted_; }
  /// Whether the next row is the mission's last.
  bool ends_after_row() const {
    return row_counts_ && counted() + 1 == mission().timing.tick_count;
  }
  bool all_rows_written() const {
    return me_.knows_mission() && counted() >= mission().timing.tick_count;
  }
  bool gap_ahead() const;
  bool gap_is_final(Instant now) const;
  bool given_up(Instant now) const;
  std::map<Tick, State>::const_iterator next_pair() const;
  void skip_gap();
  void fail(std::string reason);
  bool abandoned(Instant now) const;
  bool everybody_left(Instant now) const;
  void close();
  bool is_lockstep() const;
  void write_trajectory(const State& now, const State& next);
  /// Whether a member drives that vehicle at the row's tick: others stand still and cover nothing.
  const RosterEntry* member(AgentId id) const;
  void note_home(AgentId id, const Eigen::Vector3d& x_m);
  void observe(AgentId id, const Eigen::Vector3d& x_m);
  void end_row();
  void write_due_metrics();
  void write_metrics(double metric);

  Participant me_;
  std::ostream& trajectory_;
  std::ostream& metrics_;
  std::map<Tick, State> states_;
  Tick next_row_ = 0;
  Tick uncounted_ = 0;      // ticks before it that do not count, …
  bool row_counts_ = true;  // … and whether the row itself counts, both from the world
  Instant progress_{};      // last row, or first message of a new world
  Received received_;
  Acknowledged acked_;
  Ending ending_;
  Former former_;
  Observer observer_;
  std::optional<Mission> in_cosines_;  // with basis.free_domain
  Observer cosines_;                   // observes in_cosines_, if there is one
  std::map<Author, AgentStatus> statuses_;
  RunFacts facts_;
  std::vector<Eigen::Vector3d> row_places_m_;  // of all bodies, where a distance is kept
};

/// The header lines of the two files.
inline constexpr const char* kTrajectoryHeader = "tick,t_s,agent,x_m,y_m,vx_mps,vy_mps";
inline constexpr const char* kTrajectoryHeaderInSpace =
    "tick,t_s,agent,x_m,y_m,z_m,vx_mps,vy_mps,vz_mps";
inline constexpr const char* kMetricsHeader =
    "tick,t_s,ergodic_metric,metric_spread,max_staleness_s,contributions_received,"
    "contributions_lost,blocked_share";

}  // namespace ergocast
