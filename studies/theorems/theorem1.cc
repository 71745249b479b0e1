// SPDX-License-Identifier: BSD-3-Clause
// Theorem 1: times of escape by the strength of the noise, from every set of Proposition 1.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

#include "studies/theorems/escape.h"
#include "studies/theorems/escape_points.h"
#include "studies/theorems/linearised.h"
#include "studies/theorems/theorem1_curves.h"
#include "studies/theorems/theorems.h"

namespace ergocast::studies {
namespace {

std::string seconds_text(double t_s) {
  char text[32];
  std::snprintf(text, sizeof text, std::isfinite(t_s) ? "%.1f" : "> %g",
                std::isfinite(t_s) ? t_s : kUntil_s);
  return text;
}

/// Every set at the paper's σ and ε.
void print_sets(const std::vector<Row>& rows, double exponent, bool near) {
  std::printf(
      "| set | out by 150 s | by 600 s | 10 %% | median | 90 %% | predicted median | past "
      "neglected | distance |\n"
      "|---|---|---|---|---|---|---|---|---|\n");
  for (const Row& row : rows) {
    const Point& p = row.point;
    if (p.exponent != exponent || p.near != near || p.sigma != kPaperSigma ||
        p.epsilon != kPaperEpsilon)
      continue;
    std::printf("| %s | %.1f %% | %.1f %% | %s | %s | %s | %s | %s | %.3f |\n",
                starts()[p.start].set.c_str(), 100 * row.share_by(kPaperEnd_s),
                100 * row.share_by(kUntil_s), seconds_text(row.quantile_s(0.1)).c_str(),
                seconds_text(row.quantile_s(0.5)).c_str(),
                seconds_text(row.quantile_s(0.9)).c_str(), seconds_text(row.law_median_s).c_str(),
                seconds_text(row.without_past_s).c_str(), row.distance);
  }
  std::printf("\n");
}

/// Medians, predictions and shares of each set, by the varied parameter.
void print_varied(const std::vector<Row>& rows, const char* title, double Point::*varied) {
  std::map<double, std::string> lines;
  double farthest = 0;
  for (const int start : kOneOfEach) {
    for (const Row& row : rows) {
      if (row.point.start != start) continue;
      char cell[96];
      std::snprintf(cell, sizeof cell, " %s (%s), %.0f %% |",
                    seconds_text(row.quantile_s(0.5)).c_str(),
                    seconds_text(row.law_median_s).c_str(), 100 * row.share_by(kPaperEnd_s));
      lines[row.point.*varied] += cell;
      if (start != 0 && row.point.sigma < 1) farthest = std::max(farthest, row.distance);
    }
  }
  std::printf("| %s |", title);
  for (const int start : kOneOfEach) std::printf(" %s |", starts()[start].set.c_str());
  std::printf("\n|---|---|---|---|---|\n");
  for (const auto& [value, cells] : lines) std::printf("| %g |%s\n", value, cells.c_str());
  std::printf("\nLargest distance for σ < 1, without the origin: %.3f\n\n", farthest);
}

/// γ along the path, and the spread of a noise of σ = 1.
void print_growth(double exponent) {
  std::printf(
      "| set | γ at 0 s | 5 s | 20 s | 80 s | 150 s [1/s] | spread at 150 s [m] | past neglected "
      "[m] |\n"
      "|---|---|---|---|---|---|---|---|\n");
  for (int start = 0; start < static_cast<int>(starts().size()); ++start) {
    const Mission mission = mission_of({start, exponent, kPaperEpsilon, 1});
    const auto steps = linearised(mission, std::lround(kPaperEnd_s / mission.timing.dt_s) + 1);
    std::printf("| %s |", starts()[start].set.c_str());
    for (const double t_s : {0.0, 5.0, 20.0, 80.0, kPaperEnd_s}) {
      std::printf(
          " %.3f |",
          steps[static_cast<std::size_t>(std::lround(t_s / mission.timing.dt_s))].rate_per_s);
    }
    std::printf(" %.3g | %.3g |\n", spread(steps, mission, Past::kCounted).back(),
                spread(steps, mission, Past::kNeglected).back());
  }
  std::printf("\n");
}

/// The rows at the usual distance with the exponent that satisfy `wanted`.
std::vector<Row> chosen(const std::vector<Row>& rows, double exponent,
                        bool (*wanted)(const Point&)) {
  std::vector<Row> some;
  for (const Row& row : rows) {
    if (!row.point.near && row.point.exponent == exponent && wanted(row.point)) some.push_back(row);
  }
  return some;
}

void print_tables(const std::vector<Row>& rows, double exponent) {
  std::printf("## %s, %zu seeds\n\n### Growth\n\n", weight_text(exponent).c_str(),
              rows.front().times_s.size());
  print_growth(exponent);
  std::printf("### Escape at σ = 1e-5 m/√s\n\n");
  print_sets(rows, exponent, false);
  std::printf("### The same, farther off than %g m\n\n", kNear_m);
  print_sets(rows, exponent, true);
  std::printf("### Escape by σ\n\n");
  print_varied(chosen(rows, exponent, [](const Point& p) { return p.epsilon == kPaperEpsilon; }),
               "σ [m/√s]", &Point::sigma);
  std::printf("### Escape by ε\n\n");
  print_varied(chosen(rows, exponent, [](const Point& p) { return p.sigma == kPaperSigma; }),
               "ε [1/m]", &Point::epsilon);
}

}  // namespace

std::vector<Part> theorem1_parts(int seeds) {
  std::vector<Part> parts;
  for (const Point& p : all_points()) {
    parts.push_back({name_of(p), [p, seeds](std::ostream& out) {
                       out << "escape_s\n";
                       for (const double t_s :
                            escape_times_s(mission_of(p), seeds, far_m(p), kUntil_s))
                         out << t_s << '\n';
                     }});
  }
  return parts;
}

void report_theorem1(const std::filesystem::path& folder, const std::filesystem::path& curves) {
  const std::vector<Row> rows = read_rows(folder);
  for (const double exponent : kExponents) print_tables(rows, exponent);
  write_theorem1_curves(rows, curves);
}

}  // namespace ergocast::studies
