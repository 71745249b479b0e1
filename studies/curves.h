// SPDX-License-Identifier: BSD-3-Clause
// The points of a figure as a CSV file, which curves.py draws.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace ergocast::studies {

/// A point of a line, or the middle of an interval from `low` to `high`.
struct CurvePoint {
  std::string panel;   ///< the plot that it belongs to, by its title
  std::string series;  ///< what its colour stands for
  std::string kind;    ///< what the kind of line stands for
  double x, low, middle, high;

  CurvePoint(std::string in_panel, std::string of_series, std::string of_kind, double at_x,
             double y)
      : CurvePoint(std::move(in_panel), std::move(of_series), std::move(of_kind), at_x, y, y, y) {}
  CurvePoint(std::string in_panel, std::string of_series, std::string of_kind, double at_x,
             double least, double y, double most)
      : panel(std::move(in_panel)),
        series(std::move(of_series)),
        kind(std::move(of_kind)),
        x(at_x),
        low(least),
        middle(y),
        high(most) {}
};

/// Columns panel, series, kind, x, low, middle, high. Throws std::runtime_error if it cannot.
void write_curves(const std::filesystem::path& file, const std::vector<CurvePoint>& points);

}  // namespace ergocast::studies
