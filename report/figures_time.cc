// SPDX-License-Identifier: BSD-3-Clause
// The figures over time.
#include <algorithm>
#include <cmath>
#include <functional>

#include "report/axes.h"
#include "report/figures.h"
#include "report/markup.h"

namespace ergocast {
namespace {

constexpr double kRight = 18;
constexpr const char* kNothing = "nothing was recorded";

/// One column of metrics.csv over time.
Polyline series(const RunData& run, const std::function<double(const MetricsRow&)>& value) {
  Polyline points;
  for (const MetricsRow& row : run.metrics) points.push_back({row.t_s, value(row)});
  return points;
}

double largest(const Polyline& points) {
  double result = 0;
  for (const Eigen::Vector2d& point : points) result = std::max(result, point.y());
  return result;
}

/// Until the end of the last recorded step.
Axis time_axis(const RunData& run, const Mission& mission) {
  return range_axis("t", "s", 0, run.end_s() + mission.timing.dt_s);
}

// --- φ² ---

/// The points of a series that a logarithmic plot can show.
struct Positive {
  Polyline points;
  double low = 0, high = 0;
};

Positive positive(const Polyline& points) {
  Positive result;
  for (const Eigen::Vector2d& point : points) {
    if (!(point.x() > 0 && point.y() > 0)) continue;
    result.low = result.points.empty() ? point.y() : std::min(result.low, point.y());
    result.high = std::max(result.high, point.y());
    result.points.push_back(point);
  }
  return result;
}

/// The fitted line, and its slope in the corner that is free under a falling curve.
void draw_fit(Svg& svg, Plot& plot, const PowerLaw& law) {
  plot.curve({{law.from_s, law.at(law.from_s)}, {law.to_s, law.at(law.to_s)}}, "class=\"fit\"");
  const double x = plot.area().right() - 126, y = plot.area().top + 24;
  svg.line({x, y - 4}, {x + 34, y - 4}, "class=\"fit\"");
  svg.text({x + 41, y}, "class=\"halo\"", "slope " + readable(std::round(law.slope * 100) / 100));
}

// --- speeds ---

/// Speeds between two times: of one agent, or of all.
struct Bin {
  double sum = 0, low = 0, high = 0;
  int count = 0;

  void add(double speed) {
    low = count == 0 ? speed : std::min(low, speed);
    high = std::max(high, speed);
    sum += speed;
    ++count;
  }
};
using Bins = std::vector<Bin>;

struct Speeds {
  double bin_s = 1;  ///< bin i covers [i, i + 1) · bin_s
  std::map<AgentId, Bins> agents;
  Bins team;
  double fastest = 0;
};

Speeds speeds_of(const RunData& run, double dt_s) {
  constexpr double kMostBins = 160;
  const double end_s = run.end_s() + dt_s;
  Speeds speeds;
  speeds.bin_s = std::max(dt_s, end_s / kMostBins);
  speeds.team.resize(static_cast<std::size_t>(end_s / speeds.bin_s) + 1);
  for (const auto& [agent, track] : run.tracks) {
    Bins& bins = speeds.agents.emplace(agent, Bins(speeds.team.size())).first->second;
    for (const TrackPoint& point : track) {
      const double speed = point.v_mps.norm();
      const auto bin = static_cast<std::size_t>(std::max(point.t_s, 0.0) / speeds.bin_s);
      bins[bin].add(speed);
      speeds.team[bin].add(speed);
      speeds.fastest = std::max(speeds.fastest, speed);
    }
  }
  return speeds;
}

/// `value` of each bin that has one, at the bin's middle.
template <class Value>
Polyline over_time(const Bins& bins, double bin_s, const Value& value) {
  Polyline points;
  for (std::size_t i = 0; i < bins.size(); ++i) {
    const double middle_s = (static_cast<double>(i) + 0.5) * bin_s;
    if (bins[i].count > 0) points.push_back({middle_s, value(bins[i])});
  }
  return points;
}

/// The area between the slowest and the fastest command.
void draw_band(Svg& svg, const Plot& plot, const Speeds& speeds) {
  Polyline outline = over_time(speeds.team, speeds.bin_s, [](const Bin& bin) { return bin.high; });
  const Polyline low = over_time(speeds.team, speeds.bin_s, [](const Bin& bin) { return bin.low; });
  outline.insert(outline.end(), low.rbegin(), low.rend());
  for (Eigen::Vector2d& point : outline) point = plot.at(point);
  svg.path(path_data(outline), "class=\"band\"");
}

/// In a large team the lines of the agents are only a pale background of the team's.
void draw_means(Plot& plot, const Speeds& speeds) {
  const bool large = speeds.agents.size() > kAgentColors;
  const std::string style =
      large ? "stroke-width=\"0.8\" stroke-opacity=\"0.4\"" : "stroke-width=\"1.6\"";
  const auto mean = [](const Bin& bin) { return bin.sum / bin.count; };
  for (const auto& [agent, bins] : speeds.agents) {
    plot.curve(over_time(bins, speeds.bin_s, mean),
               "class=\"curve\" " + style + " stroke=\"" + agent_color(agent) + '"');
  }
  if (large) plot.curve(over_time(speeds.team, speeds.bin_s, mean), "class=\"curve team\"");
}

void draw_limit(Svg& svg, const Plot& plot, const Mission& mission) {
  const double u_max_mps = mission.law.u_max_mps;
  const Eigen::Vector2d left = plot.at(0, u_max_mps);
  svg.line(left, {plot.area().right(), left.y()}, "class=\"limit\"");
  svg.text({left.x() + 6, plot.area().top + 14}, "class=\"note halo\"",
           "dashed: u_max = " + readable(u_max_mps) + " m/s");
}

// --- communication ---

struct Panel {
  std::string title, unit;
  Polyline points;
};

void draw_panel(Svg& svg, const Area& area, const Axis& time, const Panel& panel) {
  svg.text({area.left, area.top - 9}, "class=\"head\"", panel.title);
  Plot plot(svg, area, time, amount_axis("", panel.unit, largest(panel.points)));
  plot.grid();
  plot.curve(panel.points, "class=\"curve main\"");
  if (panel.points.empty()) plot.show_message(kNothing);
  plot.frame();
}

std::string total(const std::string& what, const Polyline& points) {
  return points.empty() ? what : what + ": " + readable(points.back().y());
}

}  // namespace

Figure metric_figure(const RunData& run, const Mission& mission) {
  constexpr double kWidth = 562, kHeight = 520, kTop = 48, kMargin = 1.6;
  const Positive metric =
      positive(series(run, [](const MetricsRow& r) { return r.ergodic_metric; }));
  const double first_s = metric.points.empty() ? 1 : metric.points.front().x();

  Svg svg(kWidth, kHeight, "ergodic_metric", "Ergodic metric over time");
  Plot plot(svg, {kRoomLeft, kTop, kWidth - kRoomLeft - kRight, kHeight - kTop - kRoomBelow},
            log_axis("t [s]", first_s, run.end_s()),
            log_axis("ergodic metric φ²", metric.low / kMargin, metric.high * kMargin));
  plot.grid();
  plot.curve(metric.points, "class=\"curve main\"");
  const std::optional<PowerLaw> law = fit_last_decade(run);
  if (law) draw_fit(svg, plot, *law);
  if (metric.points.size() < 2)
    plot.show_message(run.metrics.empty() ? kNothing : "too short for a curve");
  plot.frame();
  svg.text({kRoomLeft, kTop - 10}, "class=\"note\"", conventions_line(mission.basis));
  return {"ergodic_metric", svg.str()};
}

Figure speeds_figure(const RunData& run, const Mission& mission) {
  constexpr double kWidth = 562, kHeight = 502;
  const Speeds speeds = speeds_of(run, mission.timing.dt_s);
  Svg svg(kWidth, kHeight, "speeds", "Commanded speeds");
  const double top = 12 + agent_legend(svg, run, kRoomLeft, 4, kWidth - kRoomLeft - kRight);
  Plot plot(svg, {kRoomLeft, top, kWidth - kRoomLeft - kRight, kHeight - top - kRoomBelow},
            time_axis(run, mission),
            amount_axis("commanded speed", "m/s", std::max(speeds.fastest, mission.law.u_max_mps)));
  plot.grid();
  draw_band(svg, plot, speeds);
  draw_means(plot, speeds);
  draw_limit(svg, plot, mission);
  if (run.empty()) plot.show_message(kNothing);
  plot.frame();
  return {"speeds", svg.str()};
}

Figure communication_figure(const RunData& run, const Mission& mission) {
  constexpr double kWidth = 1130, kPanelWidth = 470, kPanelHeight = 150, kTop = 28, kRowGap = 84;
  const Polyline received = series(run, [](const MetricsRow& r) { return r.received; });
  const Polyline lost = series(run, [](const MetricsRow& r) { return r.lost; });
  const std::string spread = std::string("Spread of φ²") +
                             (mission.basis.free_domain ? " in modes of the free domain" : "") +
                             " among the agents";
  const Panel panels[] = {
      {total("Contributions received", received), "", received},
      {total("Contributions lost", lost), "", lost},
      {"Age of the oldest teammate's contribution", "s",
       series(run, [](const MetricsRow& r) { return r.max_staleness_s; })},
      {spread, "", series(run, [](const MetricsRow& r) { return r.spread; })},
  };
  Svg svg(kWidth, kTop + 2 * kPanelHeight + kRowGap + kRoomBelow - 4, "communication",
          "Communication over time");
  for (int i = 0; i < 4; ++i) {
    const int column = i % 2, row = i / 2;
    const double left = column == 0 ? kRoomLeft : kWidth - kRight - kPanelWidth;
    const double top = kTop + row * (kPanelHeight + kRowGap);
    draw_panel(svg, {left, top, kPanelWidth, kPanelHeight}, time_axis(run, mission), panels[i]);
  }
  return {"communication", svg.str()};
}

}  // namespace ergocast
