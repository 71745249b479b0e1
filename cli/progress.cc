#include "cli/progress.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <vector>

namespace ergocast::cli {
namespace {

using namespace std::chrono_literals;

constexpr int kBarWidth = 16;
constexpr std::size_t kLongestLine = 200;

std::string clock_text(double seconds) {
  char text[32];
  const auto s = static_cast<long>(std::min(seconds, 359999.0) + 0.5);
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

/// What there is to say, most important first.
std::vector<std::string> facts(const MissionProgress& at, double ticks_per_s) {
  std::vector<std::string> said{text_of("t = %.0f of ", static_cast<double>(at.tick) * at.dt_s) +
                                text_of("%.0f s", static_cast<double>(at.tick_count) * at.dt_s)};
  const bool under_way = at.tick < at.tick_count && ticks_per_s > 0 && !at.world_silent;
  if (at.world_silent) said.push_back("waiting for the world");
  if (at.coordinator_silent) said.push_back("no coordinator");
  if (under_way) {
    said.push_back(clock_text(static_cast<double>(at.tick_count - at.tick) / ticks_per_s) + " left");
  }
  if (at.ergodic_metric > 0) said.push_back(text_of("phi^2 = %.3g", at.ergodic_metric));
  if (at.silent_agent != kUnassigned && !at.coordinator_silent) {
    said.push_back("agent " + std::to_string(at.silent_agent) + " silent");
  }
  if (at.missed_deadlines > 0) {
    said.push_back(std::to_string(at.missed_deadlines) + " commands late");
  }
  if (!at.coordinator_silent) {
    said.push_back(std::to_string(at.agents_alive) + " of " + std::to_string(at.agents_expected) +
                   " agents");
  }
  if (under_way) said.push_back(text_of("%.0f ticks/s", ticks_per_s));
  return said;
}

/// As many facts as fit, whole ones.
std::string describe(const MissionProgress& at, double ticks_per_s, std::size_t width) {
  std::string line;
  for (const std::string& fact : facts(at, ticks_per_s)) {
    if (line.size() + 2 + fact.size() > width) break;
    line += (line.empty() ? "" : ", ") + fact;
  }
  return line;
}

std::string bar(const MissionProgress& at) {
  const double share =
      static_cast<double>(at.tick) / static_cast<double>(std::max<Tick>(1, at.tick_count));
  const auto full = static_cast<std::size_t>(std::clamp(share, 0.0, 1.0) * kBarWidth);
  return '[' + std::string(full, '#') + std::string(kBarWidth - full, '.') + "] ";
}

std::size_t terminal_width() {
  winsize size{};
  return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

}  // namespace

ProgressDisplay::ProgressDisplay() : terminal_(isatty(STDERR_FILENO) == 1) {}

void ProgressDisplay::measure_rate(Tick tick, Clock::time_point now) {
  if (rate_since_ == Clock::time_point{} || tick < rate_from_) {
    rate_since_ = now;
    rate_from_ = tick;
    return;
  }
  const double elapsed_s = std::chrono::duration<double>(now - rate_since_).count();
  if (elapsed_s < 0.5 || tick == rate_from_) return;
  ticks_per_s_ = static_cast<double>(tick - rate_from_) / elapsed_s;
  rate_since_ = now;
  rate_from_ = tick;
}

void ProgressDisplay::show(const MissionProgress& progress) {
  const auto now = Clock::now();
  measure_rate(progress.tick, now);
  if (now < next_) return;
  next_ = now + (terminal_ ? 200ms : 2000ms);
  if (!terminal_) {
    std::fprintf(stderr, "%s\n", describe(progress, ticks_per_s_, kLongestLine).c_str());
    return;
  }
  const std::size_t width = std::max<std::size_t>(terminal_width(), kBarWidth + 4) - 1;
  const std::string line = bar(progress) + describe(progress, ticks_per_s_, width - kBarWidth - 3);
  std::fprintf(stderr, "\r\x1b[K%s", line.c_str());
  bar_shown_ = true;
}

void ProgressDisplay::say(const std::string& line) {
  std::fprintf(stderr, "%s%s\n", bar_shown_ ? "\r\x1b[K" : "", line.c_str());
  bar_shown_ = false;
}

void ProgressDisplay::end() {
  if (bar_shown_) std::fputc('\n', stderr);
  bar_shown_ = false;
}

}  // namespace ergocast::cli
