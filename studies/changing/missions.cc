// SPDX-License-Identifier: BSD-3-Clause
// Writes scenarios, and compiles them.
#include "studies/changing/missions.h"

#include <cmath>
#include <stdexcept>

#include "scenario/scenario.h"

namespace ergocast::studies {
namespace {

constexpr double kCentre_m = 1000;

std::string peak(double x_m, double y_m) {
  return " gaussians { mean_x_m: " + std::to_string(x_m) + " mean_y_m: " + std::to_string(y_m) +
         " sigma_m: 150 }";
}

/// Peak `i` of four, turned by an angle from its corner.
std::string turned_peak(int i, double angle_rad) {
  const double at_rad = angle_rad + (0.25 + 0.5 * i) * std::numbers::pi;
  return peak(kCentre_m + kPeakRadius_m * std::cos(at_rad),
              kCentre_m + kPeakRadius_m * std::sin(at_rad));
}

std::string turned(double angle_rad) {
  std::string text;
  for (int i = 0; i < 4; ++i) text += turned_peak(i, angle_rad);
  return text;
}

std::string text_of(Peaks peaks) {
  if (peaks == Peaks::kCorners) return turned(0);
  if (peaks == Peaks::kTurned) return turned(std::numbers::pi / 4);
  return peak(kCentre_m, kCentre_m) + turned_peak(1, 0) + turned_peak(2, 0) + turned_peak(3, 0);
}

Mission mission_of(const MissionOptions& options, const std::string& peaks, std::uint64_t seed) {
  const std::string text =
      "domain { size_x_m: 2000 size_y_m: 2000 } target {" + peaks + " } law { u_max_mps: 20 " +
      options.law + " } time { duration_s: " + std::to_string(options.duration_s) + ' ' +
      options.time + " } agents { random_count: " + std::to_string(options.agents) + ' ' +
      options.team + " }";
  auto parsed = Scenario::parse(text, "study", {.seed = seed});
  if (!parsed) throw std::runtime_error(to_string(parsed.error().front()));
  return parsed->mission();
}

}  // namespace

Mission mission_of(const MissionOptions& options, Peaks peaks, std::uint64_t seed) {
  return mission_of(options, text_of(peaks), seed);
}

Coefficients target_turned_by(double angle_rad) {
  return mission_of({.agents = 1}, turned(angle_rad), 1).target_coefficients;
}

}  // namespace ergocast::studies
