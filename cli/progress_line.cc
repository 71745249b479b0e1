// SPDX-License-Identifier: BSD-3-Clause
// Redraws one line on a terminal, prints a line at intervals elsewhere, and cuts facts that do not
// fit.
#include "cli/progress_line.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace ergocast::cli {
namespace {

using namespace std::chrono_literals;

constexpr int kBarWidth = 16;
constexpr double kMemory_s = 5;
constexpr std::size_t kLongestLine = 200;

std::string describe(const std::vector<std::string>& facts, std::size_t width) {
  std::string line;
  for (const std::string& fact : facts) {
    if (line.size() + 2 + fact.size() > width) break;
    line += (line.empty() ? "" : ", ") + fact;
  }
  return line;
}

std::string bar(double share) {
  const auto full = static_cast<std::size_t>(std::clamp(share, 0.0, 1.0) * kBarWidth);
  return '[' + std::string(full, '#') + std::string(kBarWidth - full, '.') + "] ";
}

std::size_t terminal_width() {
  winsize size{};
  return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

}  // namespace

std::string clock_text(double seconds) {
  char text[32];
  const auto s = std::lround(std::min(seconds, 359999.0));
  if (s >= 3600) {
    std::snprintf(text, sizeof text, "%ld:%02ld:%02ld", s / 3600, s / 60 % 60, s % 60);
  } else {
    std::snprintf(text, sizeof text, "%ld:%02ld", s / 60, s % 60);
  }
  return text;
}

std::string text_of(const char* format, double value) {
  char text[40];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

double Rate::measure(double count, ProgressLine::Clock::time_point now) {
  if (since_ == ProgressLine::Clock::time_point{} || count < from_) return interrupt(count, now);
  const double elapsed_s = std::chrono::duration<double>(now - since_).count();
  if (elapsed_s < 0.5) return per_s_;
  const double newest_per_s = (count - from_) / elapsed_s;
  const double weight = per_s_ == 0 ? 1 : 1 - std::exp(-elapsed_s / kMemory_s);
  per_s_ += weight * (newest_per_s - per_s_);
  since_ = now;
  from_ = count;
  return per_s_;
}

double Rate::interrupt(double count, ProgressLine::Clock::time_point now) {
  since_ = now;
  from_ = count;
  return per_s_;
}

ProgressLine::ProgressLine() : terminal_(isatty(STDERR_FILENO) == 1) {}

bool ProgressLine::due(Clock::time_point now) {
  if (now < next_) return false;
  next_ = now + (terminal_ ? 200ms : 2000ms);
  return true;
}

void ProgressLine::show(double share, const std::vector<std::string>& facts) {
  if (!terminal_) {
    std::fprintf(stderr, "%s\n", describe(facts, kLongestLine).c_str());
    return;
  }
  const std::size_t width = std::max<std::size_t>(terminal_width(), kBarWidth + 4) - 1;
  const std::string line = bar(share) + describe(facts, width - kBarWidth - 3);
  std::fprintf(stderr, "\r\x1b[K%s", line.c_str());
  bar_shown_ = true;
}

void ProgressLine::print(const std::string& line) {
  std::fprintf(stderr, "%s%s\n", bar_shown_ ? "\r\x1b[K" : "", line.c_str());
  bar_shown_ = false;
}

void ProgressLine::end() {
  if (bar_shown_) std::fputc('\n', stderr);
  bar_shown_ = false;
}

}  // namespace ergocast::cli
