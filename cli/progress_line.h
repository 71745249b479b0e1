// SPDX-License-Identifier: BSD-3-Clause
// One line that says how far something is: a bar on a terminal, a plain line now and then elsewhere.
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

  /// Whether the last time is long enough ago; if so, show() is expected now.
  bool due(Clock::time_point now);
  /// @param share  0 … 1 of the way
  /// @param facts  most important first; as many as fit are shown
  void show(double share, const std::vector<std::string>& facts);
  /// A line of its own, above the bar.
  void say(const std::string& line);
  /// The bar's last state stays; what follows begins on a new line.
  void end();

 private:
  bool terminal_;
  bool bar_shown_ = false;
  Clock::time_point next_{};
};

/// How fast something goes: measured over half a second and more, and smoothed over some seconds, so
/// that what is left to wait does not jump with every breath of the machine.
class Rate {
 public:
  /// Counts per second; 0 until it is known.
  double measure(double count, ProgressLine::Clock::time_point now);

 private:
  ProgressLine::Clock::time_point since_{};
  double from_ = 0, per_s_ = 0;
};

/// "1:02", "1:02:03".
std::string clock_text(double seconds);
/// One number in printf's format.
std::string text_of(const char* format, double value);

}  // namespace ergocast::cli
