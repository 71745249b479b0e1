// SPDX-License-Identifier: BSD-3-Clause
// Places plots and one key on a drawing whose height follows from the key.
#include "lab/studies/panels.h"

#include <stdexcept>

#include "logger/run_record.h"

namespace ergocast::studies {
namespace {

constexpr double kPanelWidth = 440, kSinglePanelWidth = 700, kPanelHeight = 270;
constexpr double kGap = 84, kLeft = 74, kRight = 18;
constexpr double kKeyRow = 20, kBelow = 56, kTitle = 34;

std::string stroke(const std::string& color, const std::string& dashes) {
  return "stroke-width=\"1.8\" stroke=\"" + color + "\" stroke-dasharray=\"" + dashes + '"';
}

void draw_dot(Svg& svg, const Eigen::Vector2d& at, const std::string& color) {
  svg.circle(at, 3.2, "fill=\"" + color + '"');
}

/// Draws the key and returns its height.
double draw_key(Svg& svg, const std::vector<KeyEntry>& key, double width) {
  constexpr double kPerLetter = 6, kSample = 28;
  double x = kLeft, y = kKeyRow;
  for (const KeyEntry& entry : key) {
    const double needed = kSample + 26 + kPerLetter * static_cast<double>(entry.text.size());
    if (x + needed > width) x = kLeft, y += kKeyRow;
    if (entry.dot) {
      draw_dot(svg, {x + 12, y - 4}, entry.color);
    } else {
      svg.line({x, y - 4}, {x + 24, y - 4}, stroke(entry.color, entry.dashes));
    }
    svg.text({x + kSample, y}, "", entry.text);
    x += needed;
  }
  return y;
}

void draw_panel(Svg& svg, const Area& area, const Panel& panel) {
  svg.text({area.left, area.top - 10}, "class=\"head\"", panel.title);
  Plot plot(svg, area, panel.x, panel.y);
  plot.grid();
  for (const Curve& curve : panel.curves) {
    plot.curve(curve.points, "class=\"curve\" " + stroke(curve.color, curve.dashes));
  }
  for (const Interval& interval : panel.intervals) {
    svg.line(plot.at(interval.x, interval.low), plot.at(interval.x, interval.high),
             stroke(interval.color, "none"));
    draw_dot(svg, plot.at(interval.x, interval.middle), interval.color);
  }
  plot.frame();
}

}  // namespace

std::string figure(const std::string& name, const std::string& description,
                   const std::vector<KeyEntry>& key, const std::vector<Panel>& panels) {
  const auto count = static_cast<double>(panels.size());
  const double panel_width = panels.size() == 1 ? kSinglePanelWidth : kPanelWidth;
  const double width = kLeft + count * panel_width + (count - 1) * kGap + kRight;
  Svg unused(width, 0, name, description);
  const double top = draw_key(unused, key, width) + kTitle;
  Svg svg(width, top + kPanelHeight + kBelow, name, description);
  draw_key(svg, key, width);
  double left = kLeft;
  for (const Panel& panel : panels) {
    draw_panel(svg, {left, top, panel_width, kPanelHeight}, panel);
    left += panel_width + kGap;
  }
  return svg.str();
}

void write_figure(const std::filesystem::path& file, const std::string& svg) {
  if (const auto problem = write_file(file, svg)) throw std::runtime_error(*problem);
}

}  // namespace ergocast::studies
