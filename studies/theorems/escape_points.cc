// SPDX-License-Identifier: BSD-3-Clause
// Lists the points of the study, and stores each with its measured and predicted escape times in
// one row.
#include "studies/theorems/escape_points.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "lab/manifolds.h"
#include "studies/table.h"
#include "studies/theorems/escape.h"
#include "studies/theorems/linearised.h"
#include "studies/theorems/theorems.h"

namespace ergocast::studies {
namespace {

constexpr double kSigmas[] = {1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 1e-1, 1, 10};
constexpr double kEpsilons[] = {1e-5, 1e-4, 1e-3, 1e-2};

Row row_of(const Point& p, const Spreads& spreads, const std::filesystem::path& folder) {
  Row row{p, spreads, read_table(folder / (name_of(p) + ".csv")).at("escape_s")};
  std::sort(row.times_s.begin(), row.times_s.end());
  const Mission mission = mission_of(p);
  const EscapeLaw law(spreads.counted, mission, far_m(p));
  row.law_median_s = law.quantile_s(0.5);
  row.without_past_s = EscapeLaw(spreads.neglected, mission, far_m(p)).quantile_s(0.5);
  for (Tick tick = 0; static_cast<double>(tick) * mission.timing.dt_s <= kUntil_s; ++tick) {
    const double t_s = static_cast<double>(tick) * mission.timing.dt_s;
    row.distance = std::max(row.distance, std::abs(row.share_by(t_s) - law.probability(t_s)));
  }
  return row;
}

}  // namespace

bool is_one_of_each(int start) {
  return std::find(std::begin(kOneOfEach), std::end(kOneOfEach), start) != std::end(kOneOfEach);
}

std::string name_of(const Point& p) {
  char text[96];
  std::snprintf(text, sizeof text, "%s-%s-s%g-e%g-n%g", p.near ? "near" : "escape",
                starts()[p.start].name.c_str(), p.exponent, p.epsilon, p.sigma);
  return text;
}

std::vector<Point> all_points() {
  std::vector<Point> points;
  for (const double exponent : kExponents) {
    for (int start = 0; start < static_cast<int>(starts().size()); ++start) {
      for (const double sigma : kSigmas) points.push_back({start, exponent, kPaperEpsilon, sigma});
      points.push_back({start, exponent, kPaperEpsilon, kPaperSigma, true});
    }
    for (const int start : kOneOfEach) {
      for (const double epsilon : kEpsilons) {
        if (epsilon != kPaperEpsilon) points.push_back({start, exponent, epsilon, kPaperSigma});
      }
    }
  }
  return points;
}

Mission mission_of(const Point& p) {
  Mission mission = paper_mission();
  mission.basis.sobolev_exponent = p.exponent;
  mission.law.epsilon = p.epsilon;
  mission.law.noise_intensity = p.sigma;
  return from(starts()[p.start], mission);
}

double far_m(const Point& p) {
  return p.near ? kNear_m : lab::escape_distance_m(paper_mission().domain);
}

Spreads spreads_of(const Point& p) {
  const Mission mission = mission_of(p);
  const auto steps = linearised(mission, std::lround(kUntil_s / mission.timing.dt_s));
  return {spread(steps, mission, Past::kCounted), spread(steps, mission, Past::kNeglected)};
}

double Row::quantile_s(double p) const {
  const auto rank = static_cast<std::size_t>(p * static_cast<double>(times_s.size()));
  return times_s[std::min(times_s.size() - 1, rank)];
}

double Row::share_by(double t_s) const {
  const auto later = std::upper_bound(times_s.begin(), times_s.end(), t_s + 1e-9);
  return static_cast<double>(later - times_s.begin()) / static_cast<double>(times_s.size());
}

std::vector<Row> read_rows(const std::filesystem::path& folder) {
  std::vector<Row> rows;
  for (const Point& p : all_points()) {
    // σ only scales the spread, so one spread serves all points of a set.
    const bool same = !rows.empty() && p.start == rows.back().point.start &&
                      p.exponent == rows.back().point.exponent &&
                      p.epsilon == rows.back().point.epsilon;
    rows.push_back(row_of(p, same ? rows.back().spreads : spreads_of(p), folder));
  }
  return rows;
}

std::string weight_text(double exponent) {
  return exponent == 1 ? "λ = 1/(1 + m² + n²)" : "λ = (1 + m² + n²)^(−3/2)";
}

}  // namespace ergocast::studies
