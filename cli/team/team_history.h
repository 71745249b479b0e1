// SPDX-License-Identifier: BSD-3-Clause
// The whole team's values over time, from the agents' statuses, for a browser that connects late.
#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "cli/team/team_view.h"

namespace ergocast {

/// Bounded: a history that is too long loses every second row, and takes half as many from then on.
class TeamHistory {
 public:
  /// Limit (Page): rows of the curve for a browser that connects late. Beyond it: every second one
  /// is left out.
  static constexpr std::size_t kMostRows = 4000;

  struct Row {
    double t_s = 0, phi = 0, spread = 0, age_s = 0;
    std::int64_t received = 0, lost = 0;
  };
  /// The team's values in a picture; NaN: not known.
  static Row row_of(const TeamPicture& picture);

  /// Adds a row if φ² is known and time has advanced.
  void add(const TeamPicture& picture);

  /// {"t": [mission time, …], "phi": [median of the agents' φ², …], "spread", "age", "received",
  /// "lost"}: the columns of metrics.csv, of as many rows. null: not known.
  nlohmann::ordered_json json() const;

 private:
  std::vector<Row> rows_;
  double newest_s_ = -1;  // of all that were offered
  std::size_t every_ = 1, offered_ = 0;
};

}  // namespace ergocast
