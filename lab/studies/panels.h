// SPDX-License-Identifier: BSD-3-Clause
// A figure of one or more plots side by side, with one key for all.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "report/axes.h"

namespace ergocast::studies {

struct Curve {
  std::string color;            ///< "#rrggbb"
  Polyline points;              ///< ascending in x
  std::string dashes = "none";  ///< as stroke-dasharray
};
/// A dot, and a line from low to high.
struct Interval {
  std::string color;
  double x, low, middle, high;
};

struct Panel {
  std::string title;
  Axis x, y;
  std::vector<Curve> curves;
  std::vector<Interval> intervals;
};

/// What a colour or a kind of line stands for.
struct KeyEntry {
  std::string text, color, dashes = "none";
  bool dot = false;
};

std::string figure(const std::string& name, const std::string& description,
                   const std::vector<KeyEntry>& key, const std::vector<Panel>& panels);

/// Throws std::runtime_error if it cannot.
void write_figure(const std::filesystem::path& file, const std::string& svg);

}  // namespace ergocast::studies
