// The run record: trajectory.csv and metrics.csv from what the world says, as an outside observer.
//
// Tick n's row needs two states: n, which has the position, and n+1, which has the velocity that
// the world applied in between. Rows are written in order and acknowledged to the world, which in
// lockstep repeats whatever state is still missing.
#pragma once

#include <map>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "core/basis.h"
#include "core/ids.h"
#include "core/messages.h"
#include "core/mission_follower.h"

namespace ergocast {

/// What the record says about the whole run.
struct RunFacts {
  Tick ticks = 0;  ///< recorded
  double ergodic_metric_first = 0, ergodic_metric_last = 0;
  std::vector<double> t_s, ergodic_metric;  ///< the rows of metrics.csv
  Tick gaps = 0;                            ///< ticks of which a state never came (real time)
  std::int64_t missed_deadlines = 0, skipped_ticks = 0;  ///< real time, as the world counts them
};

class Recorder {
 public:
  /// Writes to streams that outlive it; the caller checks them for errors.
  /// @param run  the run to record; 0: the run of the first mission heard
  Recorder(RunId run, Incarnation incarnation, PlanDecoder decode_plan, std::ostream& trajectory,
           std::ostream& metrics);

  void receive(const Message& message, Instant now);
  void advance(Instant now, Outbox& out);
  /// Ends the record with what has come so far.
  void stop(std::string reason);
  Instant next_wakeup() const;

  /// True once the last tick is recorded or the mission is over, and no more can come.
  bool finished() const { return finished_; }
  RunId run() const { return run_; }
  const MissionFollower& follower() const { return follower_; }
  /// "done" (its last tick is recorded), "failed" or "stopped" (somebody ended it), and why.
  const char* result() const;
  const std::string& reason() const { return reason_; }
  const RunFacts& facts() const { return facts_; }
  const std::map<Author, AgentStatus>& statuses() const { return statuses_; }
  Tick next_row() const { return next_row_; }

 private:
  struct State {
    std::vector<bool> parts;
    std::map<AgentId, Vehicle> vehicles;
    bool complete() const;
  };

  void on(const WorldState& world);
  bool write_next_row();
  void skip_gap();
  void close();
  void write_trajectory(const State& now, const State& next);
  /// Whether somebody drives that vehicle at the row's tick: others stand still and cover nothing.
  bool is_member(AgentId id) const;
  void observe(const State& now);
  void write_metrics(double metric);

  RunId run_;
  Incarnation incarnation_;
  MissionFollower follower_;
  std::ostream& trajectory_;
  std::ostream& metrics_;
  Sequencer sequencer_;

  std::map<Tick, State> states_;
  Tick next_row_ = 0, acked_ = -2;
  bool finished_ = false, failed_ = false;
  std::optional<Instant> over_since_;
  Instant last_row_{};
  std::string reason_;

  Coefficients sums_s_, weights_;
  double covered_s_ = 0;
  std::map<Author, AgentStatus> statuses_;
  Instant next_ack_{};
  RunFacts facts_;
};

/// One line a column set; what stands at the top of the two files.
inline constexpr const char* kTrajectoryHeader = "tick,t_s,agent,x_m,y_m,vx_mps,vy_mps";
inline constexpr const char* kMetricsHeader =
    "tick,t_s,ergodic_metric,metric_spread,max_staleness_s,contributions_received,"
    "contributions_lost";

}  // namespace ergocast
