// SPDX-License-Identifier: BSD-3-Clause
// Draws each series as curves, bands or estimates, with a colour for each value of the main
// field.
#include "lab/studies/study_figures.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "lab/studies/study_series.h"
#include "report/axes.h"
#include "report/markup.h"
#include "report/raster.h"

namespace ergocast::studies {
namespace {

constexpr double kWidth = 562, kHeight = 400, kWideWidth = 1130;
constexpr double kLeft = 84, kRight = 18, kBelow = 48, kMargin = 1.3;
/// More would not be looked at; the table has them all.
constexpr std::size_t kMostPanels = 12;
/// Positive values this far apart are drawn on a logarithmic axis.
constexpr double kWideRange = 20;

using Summaries = std::vector<PointSummary>;

/// A colour of its own for each of `count` curves: the agents' colours, or a scale if they are
/// more.
std::string color_of(std::size_t curve, std::size_t count) {
  if (count <= kAgentColors) return agent_color(static_cast<AgentId>(curve));
  const Rgb rgb = viridis()[curve * 220 / (count - 1)];  // the scale's end is too light for a line
  char text[8];
  std::snprintf(text, sizeof text, "#%02x%02x%02x", rgb.red, rgb.green, rgb.blue);
  return text;
}

struct Extent {
  double low = 1e300, high = 0;
  void add(double value) {
    if (!(value > 0) || !std::isfinite(value)) return;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  Axis log(const std::string& title) const {
    return log_axis(title, low / kMargin, high * kMargin);
  }
};

/// Names in rows beside their colours, below a line that says what they are; the pixels it took.
double draw_key(Svg& svg, const std::string& title, const std::vector<std::string>& names,
                double width) {
  constexpr double kRow = 18, kSample = 18, kGap = 16;
  double x = kLeft, y = 4;
  if (!title.empty()) {
    svg.text({x, y + 12}, "class=\"note\"", title);
    y += kRow;
  }
  for (std::size_t i = 0; i < names.size(); ++i) {
    const double needed = kSample + 5 + text_width(names[i], 11);
    if (x > kLeft && x + needed > width - kRight) x = kLeft, y += kRow;
    svg.line({x, y + 8}, {x + kSample, y + 8},
             "stroke-width=\"3\" stroke=\"" + color_of(i, names.size()) + '"');
    svg.text({x + kSample + 5, y + 12}, "class=\"tick\"", names[i]);
    x += needed + kGap;
  }
  return y + kRow + 8;
}

std::string stroke(const std::string& color) {
  return "class=\"curve\" stroke-width=\"1.8\" stroke=\"" + color + '"';
}

void draw_band(Svg& svg, const Plot& plot, const PointSummary& summary, const std::string& color,
               std::size_t bands) {
  const char* opacity = bands > 4 ? "0.1" : "0.2";
  Polyline outline;
  for (const auto& [t_s, median] : summary.metric_over_time)
    outline.push_back(plot.at(t_s, median.low));
  std::reverse(outline.begin(), outline.end());
  for (const auto& [t_s, median] : summary.metric_over_time)
    outline.push_back(plot.at(t_s, median.high));
  svg.path(path_data(outline), "fill=\"" + color + "\" fill-opacity=\"" + opacity + '"');
}

std::string in_series(const StudySeries& series) {
  return series.name.empty() ? "" : ": " + series.name;
}

// --- φ² over time ---

Figure over_time_figure(const StudyLayout& layout, std::size_t index, const Summaries& summaries) {
  const StudySeries& series = layout.series[index];
  Extent time, metric;  // of all series, so that panels can be compared
  for (const PointSummary& summary : summaries) {
    for (const auto& [t_s, median] : summary.metric_over_time) {
      time.add(t_s);
      metric.add(median.low);
      metric.add(median.high);
    }
  }
  const std::string name = "over-time-" + std::to_string(index);
  Svg svg(kWidth, kHeight, name, "Ergodic metric over time");
  const double top = draw_key(svg, layout.field, layout.values, kWidth);
  Plot plot(svg, {kLeft, top, kWidth - kLeft - kRight, kHeight - top - kBelow},
            log_axis("t [s]", time.low, time.high), metric.log("ergodic metric φ²"));
  plot.grid();
  for (std::size_t i = 0; i < series.points.size(); ++i) {
    const PointSummary& summary = summaries[series.points[i]];
    draw_band(svg, plot, summary, color_of(i, series.points.size()), series.points.size());
  }
  for (std::size_t i = 0; i < series.points.size(); ++i) {
    Polyline line;
    for (const auto& [t_s, median] : summaries[series.points[i]].metric_over_time) {
      line.push_back({t_s, median.value});
    }
    plot.curve(line, stroke(color_of(i, series.points.size())));
  }
  plot.frame();
  return {name, "φ² over time" + in_series(series),
          "Lines are medians over the seeds; a band holds the true median with 95 % confidence at "
          "each time (order statistics).",
          svg.str()};
}

// --- φ² at the end against the field ---

/// The field's axis, and where its values are on it.
struct FieldAxis {
  Axis axis;
  std::vector<double> places;
};

FieldAxis axis_of(const StudyLayout& layout) {
  const std::vector<double>& numbers = layout.numbers;
  if (!numbers.empty() && numbers.front() > 0 && numbers.back() >= kWideRange * numbers.front()) {
    return {log_axis(layout.field, numbers.front() / kMargin, numbers.back() * kMargin), numbers};
  }
  const bool ordinal =
      numbers.empty() || numbers.size() < 3 || numbers.back() >= kWideRange * numbers[1];
  if (!ordinal) {
    const double room = 0.05 * (numbers.back() - numbers.front());
    return {range_axis(layout.field, "", numbers.front() - room, numbers.back() + room), numbers};
  }
  FieldAxis named{named_axis(layout.field, layout.values), {}};
  for (std::size_t i = 0; i < layout.values.size(); ++i)
    named.places.push_back(static_cast<double>(i + 1));
  return named;
}

/// Points with their intervals, joined where the field is a number.
/// @param aside  pixels to the right, so that series do not hide each other
void draw_estimates(Svg& svg, const Plot& plot, const StudyLayout& layout,
                    const StudySeries& series, const Summaries& summaries, const FieldAxis& field,
                    const std::string& color, double aside) {
  Polyline line;
  for (std::size_t i = 0; i < series.points.size(); ++i) {
    const PointSummary& summary = summaries[series.points[i]];
    if (summary.runs == 0) continue;
    const auto at = [&](double metric) -> Eigen::Vector2d {
      return plot.at(field.places[i], metric) + Eigen::Vector2d(aside, 0);
    };
    svg.line(at(summary.metric.low), at(summary.metric.high),
             "stroke-width=\"2.4\" stroke-opacity=\"0.6\" stroke=\"" + color + '"');
    line.push_back(at(summary.metric.value));
    svg.circle(line.back(), 3.6, "fill=\"" + color + '"');
  }
  if (layout.numbers.empty()) return;
  svg.path(path_data(line), "class=\"curve\" stroke-width=\"1.4\" stroke=\"" + color + '"');
}

Figure metric_figure(const StudyLayout& layout, const Summaries& summaries) {
  Extent metric;
  std::vector<std::string> names;
  for (const PointSummary& summary : summaries) {
    metric.add(summary.metric.low);
    metric.add(summary.metric.high);
  }
  for (const StudySeries& series : layout.series) {
    if (!series.name.empty()) names.push_back(series.name);
  }
  Svg svg(kWideWidth, kHeight, "final-metric", "Ergodic metric at the end");
  const double top = draw_key(svg, "", names, kWideWidth);
  const FieldAxis field = axis_of(layout);
  Plot plot(svg, {kLeft, top, kWideWidth - kLeft - kRight, kHeight - top - kBelow}, field.axis,
            metric.log("φ² at the end"));
  plot.grid();
  const std::size_t count = layout.series.size();
  for (std::size_t i = 0; i < count; ++i) {
    const double aside = std::min(5.0, 30.0 / static_cast<double>(count)) *
                         (static_cast<double>(i) - static_cast<double>(count - 1) / 2);
    draw_estimates(svg, plot, layout, layout.series[i], summaries, field, color_of(i, count),
                   aside);
  }
  plot.frame();
  return {"final-metric", "φ² at the end against " + layout.field,
          "Medians over the seeds; a bar holds the true median with 95 % confidence (order "
          "statistics).",
          svg.str(), true};
}

// --- escapes ---

/// The share of agents that have escaped, in percent, as steps from `begin_s` to `end_s`.
Polyline distribution(const std::vector<double>& times_s, double begin_s, double end_s) {
  Polyline steps{{begin_s, 0}};
  const double percent = 100 / static_cast<double>(times_s.size());
  for (const double t_s : times_s) {
    if (t_s > end_s) break;
    const double before = steps.back().y();
    steps.push_back({std::max(t_s, begin_s), before});
    steps.push_back({std::max(t_s, begin_s), before + percent});
  }
  steps.push_back({end_s, steps.back().y()});
  return steps;
}

Figure escapes_figure(const StudyLayout& layout, std::size_t index, const Summaries& summaries) {
  const StudySeries& series = layout.series[index];
  Extent time;  // of all series
  for (const PointSummary& summary : summaries) {
    for (const double t_s : summary.escape_times_s) time.add(t_s);
    if (!summary.metric_over_time.empty()) time.add(summary.metric_over_time.back().first);
  }
  const std::string name = "escapes-" + std::to_string(index);
  Svg svg(kWidth, kHeight, name, "Escape times");
  const double top = draw_key(svg, layout.field, layout.values, kWidth);
  const double begin_s = std::min(time.low, time.high / 2) / kMargin;
  Plot plot(svg, {kLeft, top, kWidth - kLeft - kRight, kHeight - top - kBelow},
            log_axis("t [s]", begin_s, time.high),
            range_axis("agents that have escaped", "%", -3, 103));
  plot.grid();
  for (std::size_t i = 0; i < series.points.size(); ++i) {
    const PointSummary& summary = summaries[series.points[i]];
    if (summary.escape_times_s.empty()) continue;
    const double end_s = summary.metric_over_time.back().first;
    plot.curve(distribution(summary.escape_times_s, begin_s, end_s),
               stroke(color_of(i, series.points.size())));
  }
  plot.frame();
  return {name, "Escapes" + in_series(series),
          "The share of agents that start on a symmetry line or point of the domain and have been "
          "farther from it than 1 % of the shorter side.",
          svg.str()};
}

bool any(const StudySeries& series, const Summaries& summaries,
         bool (*holds)(const PointSummary&)) {
  return std::any_of(series.points.begin(), series.points.end(),
                     [&](std::size_t point) { return holds(summaries[point]); });
}

}  // namespace

std::vector<Figure> study_figures(const Study& study, const Summaries& summaries) {
  const StudyLayout layout = layout_of(study);
  const std::size_t panels = std::min(layout.series.size(), kMostPanels);
  std::vector<Figure> figures;
  if (std::all_of(summaries.begin(), summaries.end(), [](const auto& s) { return s.runs == 0; }))
    return figures;
  if (layout.values.size() > 1) figures.push_back(metric_figure(layout, summaries));
  for (std::size_t i = 0; i < panels; ++i) {
    const bool flown =
        any(layout.series[i], summaries, [](const PointSummary& s) { return s.runs > 0; });
    if (flown) figures.push_back(over_time_figure(layout, i, summaries));
  }
  for (std::size_t i = 0; i < panels; ++i) {
    const bool held = any(layout.series[i], summaries,
                          [](const PointSummary& s) { return !s.escape_times_s.empty(); });
    if (held) figures.push_back(escapes_figure(layout, i, summaries));
  }
  return figures;
}

}  // namespace ergocast::studies
