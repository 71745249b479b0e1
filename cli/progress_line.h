// SPDX-License-Identifier: BSD-3-Clause
// One line of progress: a bar on a terminal, a plain line at intervals elsewhere.
#pragma once

#include <chrono>
#include <string>
#include <vector>

namespace ergocast::cli {

class ProgressLine {
 public:
  using Clock = std::chrono::steady_clock;

  ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;
  ~ProgressLine() { end(); }

  /// Whether the last display was long enough ago; if so, the caller calls show() now.
  bool due(Clock::time_point now);
  /// @param share  the completed share, 0 … 1
  /// @param facts  the most important first; as many as fit are shown
  void show(double share, const std::vector<std::string>& facts);
  /// Prints a separate line above the bar.
  void print(const std::string& line);
  /// Leaves the bar's last state on the terminal; later output begins on a new line.
  void end();

 private:
  bool terminal_;
  bool bar_shown_ = false;
  Clock::time_point next_{};
};

/// The rate of a count: measured over half a second or more and smoothed over some seconds, so that
/// the remaining time does not jump.
class Rate {
 public:
  /// Counts per second; 0 until it is known.
  double measure(double count, ProgressLine::Clock::time_point now);
  /// The same during an intended pause of the count: the pause is left out.
  double interrupt(double count, ProgressLine::Clock::time_point now);

 private:
  ProgressLine::Clock::time_point since_{};
  double from_ = 0, per_s_ = 0;
};

/// "1:02", "1:02:03".
std::string clock_text(double seconds);
/// Formats one number with printf's format.
std::string text_of(const char* format, double value);

}  // namespace ergocast::cli
