// SPDX-License-Identifier: BSD-3-Clause
// What is varied in the study of Theorem 1: the set, the weights, ε and σ; and one such point,
// measured and predicted.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/mission/mission.h"

namespace ergocast::studies {

inline constexpr double kPaperEnd_s = 150, kUntil_s = 600;
inline constexpr double kPaperSigma = 1e-5, kPaperEpsilon = 1e-3;
inline constexpr double kExponents[] = {1, 1.5};
/// A distance far below the finest mode's wavelength, where the linearised recursion should be
/// exact.
inline constexpr double kNear_m = 0.5;
/// Indices of starts(): one of each group of sets that are equal by the square's symmetry.
inline constexpr int kOneOfEach[] = {0, 1, 3, 5};
bool is_one_of_each(int start);

struct Point {
  int start;  ///< of starts()
  double exponent, epsilon, sigma;
  bool near = false;  ///< escape means farther off than kNear_m, instead of the usual distance
};
std::vector<Point> all_points();
/// The name of a point's file, without ".csv".
std::string name_of(const Point& point);
Mission mission_of(const Point& point);
/// How far off counts as escaped.
double far_m(const Point& point);

/// The spreads of one set under one law, for σ = 1: with and without the effect of the past.
struct Spreads {
  std::vector<double> counted, neglected;
};
Spreads spreads_of(const Point& point);

struct Row {
  Point point;
  Spreads spreads;
  std::vector<double> times_s;  ///< ascending; infinite where an agent did not escape
  double law_median_s = 0, without_past_s = 0;
  double distance =
      0;  ///< the largest between the measured and the predicted share, over all times

  double quantile_s(double p) const;
  double share_by(double t_s) const;
};
/// All points, in the order of all_points(), from the files in `folder`.
std::vector<Row> read_rows(const std::filesystem::path& folder);

/// "λ = …".
std::string weight_text(double exponent);

}  // namespace ergocast::studies
