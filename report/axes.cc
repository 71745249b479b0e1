// SPDX-License-Identifier: BSD-3-Clause
// Chooses round steps or powers of ten for the marks, and draws grid, labels and titles around a
// box.
#include "report/axes.h"

#include <algorithm>
#include <cmath>

#include "report/markup.h"

namespace ergocast {
namespace {

constexpr int kX = 6, kY = 5;  // labels that fit along either axis
constexpr double kMarkLength = 4;

std::string titled(const std::string& title, const std::string& unit) {
  return unit.empty() ? title : title + " [" + unit + "]";
}

/// The smallest of 1, 2 and 5 times a power of ten that is not below `step`.
double round_step(double step) {
  const double decade = std::pow(10, std::floor(std::log10(step)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (step <= factor * decade * (1 + 1e-9)) return factor * decade;
  }
  return 10 * decade;
}

std::vector<AxisMark> linear_marks(const Axis& axis, int count) {
  const double low = axis.low / axis.label_unit, high = axis.high / axis.label_unit;
  const double step = round_step((high - low) / count);
  std::vector<AxisMark> result;
  // The marks are multiples of `step`, not sums: with a step below the rounding of `low`, adding
  // would never end.
  const double first = std::ceil(low / step - 1e-9);
  for (int i = 0; i <= 2 * count; ++i) {
    const double value = (first + i) * step;
    if (value > high + 1e-9 * step) break;
    result.push_back({value * axis.label_unit, axis_label(value, step)});
  }
  return result;
}

std::vector<AxisMark> log_marks(const Axis& axis) {
  constexpr double kSlack = 1 + 1e-9;
  const int first = static_cast<int>(std::floor(std::log10(axis.low * kSlack)));
  const int last = static_cast<int>(std::ceil(std::log10(axis.high / kSlack)));
  const bool plain = first >= -3 && last <= 4;
  const bool few = std::log10(axis.high / axis.low) <= 2;
  const int stride = std::max(1, (last - first + 7) / 8);
  std::vector<AxisMark> result;
  for (int decade = first; decade <= last; ++decade) {
    for (int digit = 1; digit <= 9; ++digit) {
      const double value = digit * std::pow(10, decade);
      if (value * kSlack < axis.low || value > axis.high * kSlack) continue;
      const bool labelled = digit == 1 ? decade % stride == 0 : few && (digit == 2 || digit == 5);
      if (!labelled && stride > 1) continue;
      std::string label;
      if (labelled && digit == 1) label = power_of_ten(decade, plain);
      if (labelled && digit != 1) {
        label =
            plain ? readable(value) : std::to_string(digit) + " × " + power_of_ten(decade, false);
      }
      result.push_back({value, label});
    }
  }
  return result;
}

/// Round steps; the labels of very small or large values have a power of ten each.
std::vector<AxisMark> marks_within_a_decade(Axis axis, int count) {
  const int decade = static_cast<int>(std::floor(std::log10(axis.low)));
  if (decade >= -3 && decade < 6) return linear_marks(axis, count);
  axis.label_unit = std::pow(10, decade);
  std::vector<AxisMark> result = linear_marks(axis, count);
  for (AxisMark& mark : result) mark.label += " × " + power_of_ten(decade, false);
  return result;
}

}  // namespace

double Axis::position(double value) const {
  if (scale == Scale::kLinear) return (value - low) / (high - low);
  return std::log(value / low) / std::log(high / low);
}

Axis range_axis(const std::string& title, const std::string& unit, double low, double high) {
  if (!(std::isfinite(low) && std::isfinite(high))) low = high = 0;
  if (!(low < high)) high = low + std::max(1.0, std::abs(low));
  return {titled(title, unit), low, high, Scale::kLinear, 1};
}

Axis amount_axis(const std::string& title, const std::string& unit, double largest) {
  constexpr double kHeadroom = 1.08;
  Axis axis = range_axis(title, unit, 0, std::max(largest, 0.0) * kHeadroom);
  if (axis.high >= 1e-3 && axis.high < 1e6) return axis;
  const int decade = static_cast<int>(std::floor(std::log10(axis.high)));
  axis.label_unit = std::pow(10, decade);
  axis.title = titled(title, power_of_ten(decade, false) + (unit.empty() ? "" : "\u00a0" + unit));
  return axis;
}

Axis log_axis(const std::string& title, double low, double high) {
  if (!(high > 0 && std::isfinite(high))) high = 1;
  if (!(low > 0 && low <= high)) low = high / 10;
  if (low == high) high *= 10;
  return {title, low, high, Scale::kLog, 1};
}

std::vector<AxisMark> marks(const Axis& axis, int count) {
  if (axis.scale == Scale::kLinear) return linear_marks(axis, count);
  std::vector<AxisMark> result = log_marks(axis);
  const auto labelled = std::count_if(result.begin(), result.end(),
                                      [](const AxisMark& mark) { return !mark.label.empty(); });
  // Up to a decade, round steps may give more labels than powers of ten; beyond, they would crowd
  // at its end.
  return labelled >= 3 || axis.high > 10 * axis.low ? result : marks_within_a_decade(axis, count);
}

Plot::Plot(Svg& svg, const Area& area, Axis x, Axis y)
    : svg_(svg), area_(area), x_(std::move(x)), y_(std::move(y)) {}

Eigen::Vector2d Plot::at(double x, double y) const {
  return {area_.left + area_.width * x_.position(x),
          area_.bottom() - area_.height * y_.position(y)};
}

void Plot::grid() {
  for (const AxisMark& mark : marks(x_, kX)) {
    const double x = at(mark.value, y_.low).x();
    svg_.line({x, area_.top}, {x, area_.bottom()},
              mark.label.empty() ? "class=\"fine\"" : "class=\"grid\"");
  }
  for (const AxisMark& mark : marks(y_, kY)) {
    const double y = at(x_.low, mark.value).y();
    svg_.line({area_.left, y}, {area_.right(), y},
              mark.label.empty() ? "class=\"fine\"" : "class=\"grid\"");
  }
}

void Plot::frame() {
  svg_.rect(area_, "class=\"frame\"");
  double widest_label = 0;
  for (const AxisMark& mark : marks(x_, kX)) {
    if (mark.label.empty()) continue;
    const double x = at(mark.value, y_.low).x();
    svg_.line({x, area_.bottom()}, {x, area_.bottom() + kMarkLength}, "class=\"mark\"");
    svg_.text({x, area_.bottom() + 19}, "class=\"tick middle\"", mark.label);
  }
  for (const AxisMark& mark : marks(y_, kY)) {
    if (mark.label.empty()) continue;
    const double y = at(x_.low, mark.value).y();
    svg_.line({area_.left - kMarkLength, y}, {area_.left, y}, "class=\"mark\"");
    svg_.text({area_.left - 9, y + 4}, "class=\"tick end\"", mark.label);
    widest_label = std::max(widest_label, text_width(mark.label, 11));
  }
  svg_.text({area_.left + area_.width / 2, area_.bottom() + 38}, "class=\"middle\"", x_.title);
  const double x = area_.left - 18 - widest_label, y = area_.top + area_.height / 2;
  const std::string turned = "transform=\"rotate(-90 " + pixels(x) + ' ' + pixels(y) + ")\"";
  svg_.text({x, y}, "class=\"middle\" " + turned, y_.title);
}

void Plot::image(const Field& field, const ColorScale& colors, bool smooth) {
  svg_.image(area_, png_data_uri(field, colors), smooth);
}

void Plot::curve(const Polyline& points, std::string_view attributes) {
  Polyline drawn;
  for (const Eigen::Vector2d& point : points) {
    if (x_.scale == Scale::kLog && !(point.x() > 0)) continue;
    if (y_.scale == Scale::kLog && !(point.y() > 0)) continue;
    drawn.push_back(at(point));
  }
  svg_.begin_clip(area_);
  svg_.path(path_data(thin_columns(drawn)), attributes);
  svg_.end_clip();
}

void Plot::show_message(std::string_view message) {
  svg_.text({area_.left + area_.width / 2, area_.top + area_.height / 2}, "class=\"note middle\"",
            message);
}

void color_bar(Svg& svg, const Area& area, const ColorScale& colors, const Axis& axis) {
  const Area bar{area.right() + 16, area.top, 12, area.height};
  svg.image(bar, png_data_uri(Eigen::RowVectorXd::LinSpaced(256, 0, 1), colors), false);
  svg.rect(bar, "class=\"frame\"");
  for (const AxisMark& mark : marks(axis, kY)) {
    if (mark.label.empty()) continue;
    const double y = bar.bottom() - bar.height * axis.position(mark.value);
    svg.line({bar.right(), y}, {bar.right() + kMarkLength, y}, "class=\"mark\"");
    svg.text({bar.right() + 8, y + 4}, "class=\"tick\"", mark.label);
  }
  svg.text({bar.right() + 38, bar.top - 10}, "class=\"tick end\"", axis.title);
}

}  // namespace ergocast
