// SPDX-License-Identifier: BSD-3-Clause
// Compares a recorded trajectory with a simulated one: row by row, bit by bit.
#pragma once

#include <filesystem>
#include <istream>
#include <optional>
#include <string>

#include "core/base/ids.h"
#include "logger/table_lines.h"

namespace ergocast::cli {

/// The place and both texts of the first cell in which two rows of a table differ:
/// "FILE:LINE, column NAME\nrecorded:  …\nsimulated: …\n".
/// @param place   of the recorded row, as TableLines::place() formats it
/// @param header  the names of the columns
std::string first_difference(std::string place, const std::string& header,
                             const std::string& recorded, const std::string& simulated);

/// Rows that the record lacks are counted; they are no difference.
class TrajectoryComparison {
 public:
  explicit TrajectoryComparison(const std::filesystem::path& run_dir);

  /// Expects an emergency stop: in the last tick the vehicles stand still, unlike in a simulation.
  void expect_halt() { emergency_stop_expected_ = true; }
  /// The reason why the record cannot be read; nullopt if it can.
  const std::optional<std::string>& problem() const { return lines_.problem(); }
  /// Compares all complete lines; returns false at the first difference.
  bool compare(std::istream& simulated);

  bool same() const { return same_; }
  /// Whether the record ended before the simulation did.
  bool recorded_over() const { return recorded_over_; }
  /// Whether the record continues after the simulation's end.
  bool has_more() const { return recorded_.has_value(); }
  /// Whether its last tick has rows of standing vehicles.
  bool emergency_stopped() const { return emergency_stopped_; }
  /// Whether the record ends within a line, or within the rows of a tick.
  bool torn() const { return lines_.torn() || amid_tick_; }
  /// "tick 12, agent 3" of the first line that differs.
  std::string place() const;
  const std::string& difference() const { return difference_; }
  std::string last_tick() const { return last_.substr(0, last_.find(',')); }
  /// Rows that equal the simulation's.
  std::int64_t rows() const { return rows_; }
  /// Ticks up to the last compared row that lack rows.
  Tick missing() const { return missing_; }
  /// "tick 12, agent 3" of the first row that is missing.
  const std::string& first_missing() const { return first_missing_; }

 private:
  void read_next();
  void compare_row(const std::string& simulated);
  void miss(const std::string& simulated);
  bool stands_where(const std::string& simulated) const;

  TableLines lines_;
  bool emergency_stop_expected_ = false, emergency_stopped_ = false;
  std::optional<std::string> recorded_;  // the row to be compared next
  std::string recorded_place_;
  bool same_ = true, recorded_over_ = false, amid_tick_ = false;
  std::string last_, first_, difference_, first_missing_;
  std::int64_t rows_ = 0;
  Tick missing_ = 0, last_missing_ = -1;
};

}  // namespace ergocast::cli
