// SPDX-License-Identifier: BSD-3-Clause
// Runs one agent from a set until it is far enough away, and predicts that time from the growth of
// its spread.
#include "studies/theorems/escape.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/require.h"
#include "lab/ideal_team.h"
#include "lab/manifolds.h"

namespace ergocast::studies {
namespace {

/// P(‖z‖ ≤ r) for a standard normal vector z.
double share_within(double r, int dimensions) {
  return dimensions == 1 ? std::erf(r / std::sqrt(2.0)) : -std::expm1(-0.5 * r * r);
}

}  // namespace

std::span<const Start> starts() {
  static const Start kStarts[] = {
      {"corner", "origin", {0, 0, 0}, {0, 0, 0}},
      {"axis-x", "axis x = 0", {0, 300, 0}, {0, 0, 0}},
      {"axis-y", "axis y = 0", {300, 0, 0}, {0, 0, 0}},
      {"midline-x", "midline x = Lx/2", {1000, 300, 0}, {1000, 1000, 0}},
      {"midline-y", "midline y = Ly/2", {300, 1000, 0}, {1000, 1000, 0}},
      {"diagonal", "diagonal y = x", {300, 300, 0}, {0, 0, 0}},
      {"antidiagonal", "diagonal y = Lx − x", {300, 1700, 0}, {1000, 1000, 0}},
  };
  return kStarts;
}

Mission from(const Start& start, Mission mission) {
  mission.starts_m = {start.x_m};
  mission.law.contraction_center_m = start.center_m;
  return mission;
}

std::optional<double> escape_time_s(const Mission& mission, double far_m, double until_s) {
  const auto set = lab::manifold_at(mission.starts_m.front(), mission.domain);
  ERGOCAST_REQUIRE(set.has_value());
  lab::IdealTeam team(mission);
  while (team.t_s() < until_s - 1e-9) {
    team.step();
    if (set->distance_m(team.x_m(0)) > far_m) return team.t_s();
  }
  return std::nullopt;
}

std::vector<double> escape_times_s(Mission mission, int seeds, double far_m, double until_s) {
  std::vector<double> times_s;
  for (int seed = 1; seed <= seeds; ++seed) {
    mission.seed = static_cast<std::uint64_t>(seed);
    times_s.push_back(
        escape_time_s(mission, far_m, until_s).value_or(std::numeric_limits<double>::infinity()));
  }
  return times_s;
}

EscapeLaw::EscapeLaw(std::vector<double> spread, const Mission& mission, double far_m)
    : dt_s_(mission.timing.dt_s),
      far_m_(far_m),
      dimensions_(normal_of(mission).dimensions),
      spread_m_(std::move(spread)) {
  double largest = 0;
  for (double& s : spread_m_) s = largest = std::max(largest, s * mission.law.noise_intensity);
}

double EscapeLaw::probability(double t_s) const {
  const auto step = std::min(spread_m_.size() - 1, static_cast<std::size_t>(t_s / dt_s_ + 1e-9));
  return spread_m_[step] > 0 ? 1 - share_within(far_m_ / spread_m_[step], dimensions_) : 0;
}

double EscapeLaw::quantile_s(double p) const {
  for (std::size_t step = 0; step < spread_m_.size(); ++step) {
    const double t_s = static_cast<double>(step) * dt_s_;
    if (probability(t_s) >= p) return t_s;
  }
  return std::numeric_limits<double>::infinity();
}

}  // namespace ergocast::studies
