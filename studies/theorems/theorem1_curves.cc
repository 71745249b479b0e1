// SPDX-License-Identifier: BSD-3-Clause
// Puts measured medians and distributions of escape times beside the predicted ones.
#include "studies/theorems/theorem1_curves.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "studies/curves.h"
#include "studies/theorems/escape.h"

namespace ergocast::studies {
namespace {

namespace fs = std::filesystem;
using Curves = std::vector<CurvePoint>;

constexpr double kMedianOfNormal = 0.67448975;  // of |z|

/// Median times against what is varied: 10 % to 90 % measured, the law, and the law without the
/// past. The `other` parameter has only the `wanted` value.
void write_medians(const std::vector<Row>& rows, double Point::*varied, double Point::*other,
                   double wanted, const fs::path& file) {
  Curves curves;
  for (const Row& row : rows) {
    const Point& p = row.point;
    if (p.near || !is_one_of_each(p.start) || p.*other != wanted) continue;
    const std::string panel = weight_text(p.exponent), set = starts()[p.start].set;
    const double at = p.*varied;
    if (std::isfinite(row.law_median_s))
      curves.emplace_back(panel, set, "predicted", at, row.law_median_s);
    if (std::isfinite(row.without_past_s))
      curves.emplace_back(panel, set, "past neglected", at, row.without_past_s);
    if (!std::isfinite(row.quantile_s(0.5))) continue;
    curves.emplace_back(panel, set, "measured", at, row.quantile_s(0.1), row.quantile_s(0.5),
                        std::min(kUntil_s, row.quantile_s(0.9)));
  }
  write_curves(file, curves);
}

/// Shares escaped over time, measured and by the law, from two sets.
void write_distributions(const std::vector<Row>& rows, const fs::path& file) {
  constexpr double kSigmas[] = {1e-8, 1e-5, 1e-2, 1.0};
  Curves curves;
  for (const Row& row : rows) {
    const Point& p = row.point;
    const bool midline = starts()[p.start].name == "midline-x";
    if (p.near || (p.start != 1 && p.start != 3) || p.exponent != 1 || p.epsilon != kPaperEpsilon ||
        std::find(std::begin(kSigmas), std::end(kSigmas), p.sigma) == std::end(kSigmas))
      continue;
    char sigma[32];
    std::snprintf(sigma, sizeof sigma, "σ = %g m/√s", p.sigma);
    const EscapeLaw law(row.spreads.counted, mission_of(p), far_m(p));
    for (int half = 0; half <= (midline ? 600 : 400); ++half) {
      const double t_s = 0.5 * half;
      curves.emplace_back(starts()[p.start].set, sigma, "measured", t_s, row.share_by(t_s));
      curves.emplace_back(starts()[p.start].set, sigma, "predicted", t_s, law.probability(t_s));
    }
  }
  write_curves(file, curves);
}

/// How the spread grows; and that the measured medians lie where it reaches the distance.
void write_growth(const std::vector<Row>& rows, const fs::path& file) {
  constexpr double kDrawn_s = 300;
  Curves curves;
  for (const Row& row : rows) {
    const Point& p = row.point;
    if (p.near || p.exponent != 1 || p.epsilon != kPaperEpsilon || !is_one_of_each(p.start))
      continue;
    const std::string set = starts()[p.start].set;
    const double dt_s = mission_of(p).timing.dt_s;
    if (p.sigma == kPaperSigma) {
      for (std::size_t j = 1; j < row.spreads.counted.size(); j += 5) {
        const double t_s = static_cast<double>(j) * dt_s;
        if (t_s > kDrawn_s) break;
        curves.emplace_back("growth", set, "predicted", t_s, row.spreads.counted[j]);
        curves.emplace_back("growth", set, "past neglected", t_s, row.spreads.neglected[j]);
      }
    }
    const double median_s = row.quantile_s(0.5);
    if (!std::isfinite(median_s) || starts()[p.start].name == "corner") continue;
    const double reached =
        row.spreads.counted[static_cast<std::size_t>(std::lround(median_s / dt_s))];
    curves.emplace_back("collapse", set, "measured", reached,
                        far_m(p) / (kMedianOfNormal * p.sigma));
  }
  write_curves(file, curves);
}

}  // namespace

void write_theorem1_curves(const std::vector<Row>& rows, const fs::path& curves) {
  write_medians(rows, &Point::sigma, &Point::epsilon, kPaperEpsilon,
                curves / "theorem_1_noise.csv");
  write_medians(rows, &Point::epsilon, &Point::sigma, kPaperSigma,
                curves / "theorem_1_epsilon.csv");
  write_distributions(rows, curves / "theorem_1_distribution.csv");
  write_growth(rows, curves / "theorem_1_growth.csv");
}

}  // namespace ergocast::studies
