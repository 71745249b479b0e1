// SPDX-License-Identifier: BSD-3-Clause
// Plots measured medians and distributions of escape times over the predicted ones.
#include "lab/studies/theorems/theorem1_figures.h"

#include <algorithm>
#include <cmath>

#include "lab/studies/panels.h"
#include "lab/studies/theorems/escape.h"
#include "report/figures.h"

namespace ergocast::studies {
namespace {

namespace fs = std::filesystem;

constexpr double kMedianOfNormal = 0.67448975;  // of |z|

std::string color_of(int start) {
  const auto* at = std::find(std::begin(kOneOfEach), std::end(kOneOfEach), start);
  return agent_color(static_cast<AgentId>(at - std::begin(kOneOfEach)));
}

std::vector<KeyEntry> key_of_sets() {
  std::vector<KeyEntry> key;
  for (const int start : kOneOfEach) key.push_back({starts()[start].set, color_of(start)});
  return key;
}

/// Median times over the varied parameter: dots with 10 % to 90 % measured, solid the law, dashed
/// the law without the past. Only rows whose `other` parameter has the value `wanted`.
Panel panel_of(const std::vector<Row>& rows, double exponent, Axis x, Axis y, double Point::*varied,
               double Point::*other, double wanted) {
  Panel panel{weight_text(exponent), std::move(x), std::move(y), {}, {}};
  for (const int start : kOneOfEach) {
    Curve law{color_of(start), {}, "none"}, without{color_of(start), {}, "5 4"};
    for (const Row& row : rows) {
      const Point& p = row.point;
      if (p.near || p.start != start || p.exponent != exponent || p.*other != wanted) continue;
      const double at = p.*varied;
      if (std::isfinite(row.law_median_s)) law.points.push_back({at, row.law_median_s});
      if (std::isfinite(row.without_past_s)) without.points.push_back({at, row.without_past_s});
      if (!std::isfinite(row.quantile_s(0.5))) continue;
      panel.intervals.push_back({color_of(start), at, row.quantile_s(0.1), row.quantile_s(0.5),
                                 std::min(kUntil_s, row.quantile_s(0.9))});
    }
    for (Curve* curve : {&law, &without}) {
      std::sort(curve->points.begin(), curve->points.end(),
                [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a.x() < b.x(); });
    }
    panel.curves.push_back(std::move(law));
    if (starts()[start].name == "midline-x" || starts()[start].name == "diagonal") {
      panel.curves.push_back(std::move(without));
    }
  }
  return panel;
}

std::vector<KeyEntry> key_of_medians() {
  std::vector<KeyEntry> key = key_of_sets();
  key.push_back({"measured: median, 10 to 90 %", "#333333", "none", true});
  key.push_back({"predicted median", "#333333"});
  key.push_back({"the same, past neglected", "#333333", "5 4"});
  return key;
}

void draw_medians(const std::vector<Row>& rows, const fs::path& images) {
  std::vector<Panel> noise, smoothing;
  for (const double exponent : kExponents) {
    noise.push_back(panel_of(rows, exponent, log_axis("σ [m/√s]", 5e-9, 20),
                             range_axis("time of escape", "s", 0, kUntil_s), &Point::sigma,
                             &Point::epsilon, kPaperEpsilon));
    smoothing.push_back(panel_of(rows, exponent, log_axis("ε [1/m]", 5e-6, 2e-2),
                                 log_axis("time of escape [s]", 0.5, kUntil_s), &Point::epsilon,
                                 &Point::sigma, kPaperSigma));
  }
  write_figure(
      images / "theorem_1_noise.svg",
      figure("theorem-1-noise", "Time of escape against the noise", key_of_medians(), noise));
  write_figure(
      images / "theorem_1_epsilon.svg",
      figure("theorem-1-epsilon", "Time of escape against epsilon", key_of_medians(), smoothing));
}

/// Shares escaped over time, measured and by the law.
Panel distributions(const std::vector<Row>& rows, int start) {
  const bool midline = starts()[start].name == "midline-x";
  Panel panel{starts()[start].set,
              range_axis("time", "s", 0, midline ? 300 : 200),
              range_axis("share escaped", "", 0, 1),
              {},
              {}};
  int color = 0;
  for (const double sigma : {1e-8, 1e-5, 1e-2, 1.0}) {
    for (const Row& row : rows) {
      const Point& p = row.point;
      if (p.near || p.start != start || p.sigma != sigma || p.exponent != 1 ||
          p.epsilon != kPaperEpsilon)
        continue;
      Curve measured{agent_color(color), {}, "none"}, law{"#333333", {}, "4 4"};
      const EscapeLaw predicted(row.spreads.counted, mission_of(p), far_m(p));
      for (int half = 0; half <= 2 * panel.x.high; ++half) {
        const double t_s = 0.5 * half;
        measured.points.push_back({t_s, row.share_by(t_s)});
        law.points.push_back({t_s, predicted.probability(t_s)});
      }
      panel.curves.push_back(std::move(measured));
      panel.curves.push_back(std::move(law));
    }
    ++color;
  }
  return panel;
}

void draw_distributions(const std::vector<Row>& rows, const fs::path& images) {
  const std::vector<KeyEntry> key = {{"σ = 1e-8 m/√s", agent_color(0)},
                                     {"σ = 1e-5", agent_color(1)},
                                     {"σ = 0.01", agent_color(2)},
                                     {"σ = 1", agent_color(3)},
                                     {"predicted", "#333333", "4 4"}};
  write_figure(images / "theorem_1_distribution.svg",
               figure("theorem-1-distribution", "Share of seeds escaped over time", key,
                      {distributions(rows, 1), distributions(rows, 3)}));
}

/// Left: how the spread grows. Right: the measured medians lie where the spread reaches the
/// distance.
void draw_growth(const std::vector<Row>& rows, const fs::path& images) {
  Panel growth{"Spread of the linearised recursion for σ = 1 m/√s",
               range_axis("time", "s", 0, 300),
               log_axis("standard deviation [m]", 0.1, 1e12),
               {},
               {}};
  Panel collapse{"One dot for each set and σ: on the line if the law is exact",
                 log_axis("predicted spread at the measured median time, σ = 1 m/√s [m]", 1, 1e11),
                 log_axis("spread that escape takes: 20 m / (0.674 σ)", 1, 1e11),
                 {},
                 {}};
  collapse.curves.push_back({"#333333", {{1, 1}, {1e11, 1e11}}, "none"});
  for (const Row& row : rows) {
    const Point& p = row.point;
    if (p.near || p.exponent != 1 || p.epsilon != kPaperEpsilon || !is_one_of_each(p.start))
      continue;
    const double dt_s = mission_of(p).timing.dt_s;
    if (p.sigma == kPaperSigma) {
      Curve counted{color_of(p.start), {}, "none"}, neglected{color_of(p.start), {}, "5 4"};
      for (std::size_t j = 1; j < row.spreads.counted.size(); j += 5) {
        const double t_s = static_cast<double>(j) * dt_s;
        counted.points.push_back({t_s, row.spreads.counted[j]});
        neglected.points.push_back({t_s, row.spreads.neglected[j]});
      }
      growth.curves.push_back(std::move(counted));
      growth.curves.push_back(std::move(neglected));
    }
    const double median_s = row.quantile_s(0.5);
    if (!std::isfinite(median_s) || starts()[p.start].name == "corner") continue;
    const double reached =
        row.spreads.counted[static_cast<std::size_t>(std::lround(median_s / dt_s))];
    const double needed = far_m(p) / (kMedianOfNormal * p.sigma);
    collapse.intervals.push_back({color_of(p.start), reached, needed, needed, needed});
  }
  std::vector<KeyEntry> key = key_of_sets();
  key.push_back({"past neglected", "#333333", "5 4"});
  write_figure(images / "theorem_1_growth.svg",
               figure("theorem-1-growth", "Growth of a deviation", key, {growth, collapse}));
}

}  // namespace

void draw_theorem1(const std::vector<Row>& rows, const fs::path& images) {
  draw_medians(rows, images);
  draw_distributions(rows, images);
  draw_growth(rows, images);
}

}  // namespace ergocast::studies
