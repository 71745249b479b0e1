// SPDX-License-Identifier: BSD-3-Clause
// The state of a team's agents over time, for the page of a record and for a browser that connects
// late.
#pragma once

#include <chrono>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <vector>

#include "cli/team/team_view.h"
#include "core/base/ids.h"

namespace ergocast {

/// Bounded: a history that is too long loses every second sample, and has samples half as often
/// from then on.
class AgentHistory {
 public:
  /// Whether add() would keep a sample.
  bool due(Instant now) const { return now >= next_; }
  /// Adds a sample if one is due, and the mission is not over.
  void add(const TeamPicture& picture, Instant now);

  /// Null without a sample, else {"t": [mission time, …], "metric": [median of the agents' φ², …],
  /// "agents": {"0": {"state": [index into "words", …], "phase": [index into "phases", …],
  /// "silent_s", "metric", "age_s", "lag_s", "lost", "drops", "waits_for"}, …}, "words", "phases"}.
  /// Each list has an item for each t; null: not known. An agent that was blocked has "blocked_s"
  /// and "blocked_by", too.
  nlohmann::ordered_json json() const;

 private:
  struct Sample {
    double t_s = 0;
    std::optional<double> metric;
    std::vector<AgentRow> agents;
  };

  std::vector<Sample> samples_;
  Instant next_{};
  PacingClock::duration period_ = std::chrono::milliseconds(50);
};

}  // namespace ergocast
