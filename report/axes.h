// SPDX-License-Identifier: BSD-3-Clause
// The coordinate system of a plot: positions of values, ticks and labels.
#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "report/polyline.h"
#include "report/raster.h"
#include "report/svg.h"

namespace ergocast {

constexpr double kRoomLeft = 66, kRoomBelow = 48;  ///< of a plot, for labels

enum class Scale { kLinear, kLog };

/// One axis. Made by one of the functions below, low < high, both finite, and both > 0 if
/// logarithmic.
struct Axis {
  std::string title;
  double low = 0, high = 1;
  Scale scale = Scale::kLinear;
  double label_unit = 1;  ///< labels are values divided by this

  /// 0 at the low end, 1 at the high end.
  double position(double value) const;
};

/// Exactly from `low` to `high`; "title [unit]".
Axis range_axis(const std::string& title, const std::string& unit, double low, double high);
/// From 0 to a little above the largest value. Labels of tiny or huge values are in units of a
/// power of ten that the title names.
Axis amount_axis(const std::string& title, const std::string& unit, double largest);
/// Logarithmic from `low` to `high`; each must be > 0 or is replaced.
Axis log_axis(const std::string& title, double low, double high);

struct AxisMark {
  double value = 0;
  std::string label;  ///< empty: a fine line without a number
};
/// Round values along the axis, about `count` of them with labels.
std::vector<AxisMark> marks(const Axis& axis, int count);

/// A rectangle of a drawing with two axes.
class Plot {
 public:
  Plot(Svg& svg, const Area& area, Axis x, Axis y);

  const Area& area() const { return area_; }
  Eigen::Vector2d at(double x, double y) const;
  Eigen::Vector2d at(const Eigen::Vector2d& point) const { return at(point.x(), point.y()); }

  /// Grid lines, below what is plotted.
  void grid();
  /// Frame, tick labels and titles, drawn above the plotted data.
  void frame();
  /// `field` stretched over the whole area.
  void image(const Field& field, const ColorScale& colors, bool smooth);
  /// A curve over ascending x, cut off at the area's edge. Logarithms of values ≤ 0 are left out.
  void curve(const Polyline& points, std::string_view attributes);
  /// Writes in the middle of the area why nothing is drawn.
  void show_message(std::string_view message);

 private:
  Svg& svg_;
  Area area_;
  Axis x_, y_;
};

/// A strip of colours right of `area`, with labels, and its title above.
void color_bar(Svg& svg, const Area& area, const ColorScale& colors, const Axis& axis);

}  // namespace ergocast
