// SPDX-License-Identifier: BSD-3-Clause
// The figures that are maps: of the domain, and of the modes.
#include <algorithm>
#include <cmath>

#include "core/station.h"
#include "report/axes.h"
#include "report/figures.h"
#include "report/markup.h"
#include "target/rectangle.h"

namespace ergocast {
namespace {

constexpr double kBar = 72;                   // room for the bar of colours
constexpr double kTitled = 30, kLegend = 48;  // room above it
constexpr double kSide = 424;                 // of a map that shares its row with another
constexpr double kWholeRow = 990;
constexpr double kMostCells = 128;                 // along the longer side of a field
constexpr double kFewestCells = kMaxModesPerAxis;  // so that modes do not alias

/// The largest box of the proportions of `size` in kSide × `width`; never thinner than what can
/// carry labels, nor lower than `lowest`.
Area fitted(double top, double width, const Eigen::Vector2d& size, double lowest = 0) {
  constexpr double kThinnest = 60;
  const double scale = std::min(width / size.x(), kSide / size.y());
  return {kRoomLeft, top, std::max(size.x() * scale, kThinnest),
          std::max({size.y() * scale, kThinnest, lowest})};
}

/// Maps of long domains get a row of their own.
bool long_domain(const Rectangle& domain) { return domain.size_m.x() > 2 * domain.size_m.y(); }

/// The heights of a flat box fill a quarter of its length.
Area map_area(double top, const Rectangle& domain, const View& view) {
  const double width = long_domain(domain) ? kWholeRow : kSide;
  return fitted(top, width, domain.size_m, view.up == 2 ? width / 4 : 0);
}

Axis across_axis(const Rectangle& domain, const View& view) {
  return range_axis(view.across_name(), "m", domain.origin_m.x(),
                    domain.origin_m.x() + domain.size_m.x());
}

Axis up_axis(const Rectangle& domain, const View& view) {
  return range_axis(view.up_name(), "m", domain.origin_m.y(),
                    domain.origin_m.y() + domain.size_m.y());
}

/// `value(x)` at the centres of a grid of nearly square cells over the domain.
template <class Value>
Field sample(const Rectangle& domain, const Value& value) {
  const Eigen::Vector2d cells =
      (domain.size_m / domain.size_m.maxCoeff() * kMostCells).cwiseMax(kFewestCells);
  Field field(static_cast<Eigen::Index>(cells.x()), static_cast<Eigen::Index>(cells.y()));
  const Eigen::Vector2d cell_m(domain.size_m.x() / static_cast<double>(field.rows()),
                               domain.size_m.y() / static_cast<double>(field.cols()));
  for (Eigen::Index i = 0; i < field.rows(); ++i) {
    for (Eigen::Index j = 0; j < field.cols(); ++j) {
      const Eigen::Vector2d center(static_cast<double>(i) + 0.5, static_cast<double>(j) + 0.5);
      field(i, j) = value(domain.origin_m + cell_m.cwiseProduct(center));
    }
  }
  return field;
}

/// Σ a_k f_k / mean(f_k²): what the coefficients say of the density, in multiples of uniform.
Field reconstruction(Coefficients coefficients, const Mission& mission) {
  auto weights = in_plane(coefficients, mission.basis);
  weights.bottomRows(weights.rows() - 1) *= 2;  // mean(cos²) = ½ along each axis that varies
  weights.rightCols(weights.cols() - 1) *= 2;
  return sample(base_of(mission.domain), [&](const Eigen::Vector2d& x_m) {
    return basis_values(on_ground(x_m), mission.domain, mission.basis)
        .cwiseProduct(coefficients)
        .sum();
  });
}

// --- trajectories ---

constexpr std::size_t kMostTrackPoints = 50'000;  // together; about 7 bytes each
constexpr double kUnseen = 0.15;                  // an invisible deviation in pixels

struct DrawnTracks {
  std::map<AgentId, Polyline> lines;
  double from_s = 0;  ///< earlier points are left out
  std::size_t points = 0;
  double length = 0;
};

DrawnTracks draw_tracks(const RunData& run, const Plot& plot, double from_s) {
  DrawnTracks drawn;
  drawn.from_s = from_s;
  for (const auto& [agent, track] : run.tracks) {
    Polyline line;
    for (const TrackPoint& point : track) {
      if (point.t_s >= from_s) line.push_back(plot.at(point.x_m.head<2>()));
    }
    line = simplify(line, kUnseen);
    for (std::size_t i = 1; i < line.size(); ++i) drawn.length += (line[i] - line[i - 1]).norm();
    drawn.points += line.size();
    drawn.lines[agent] = std::move(line);
  }
  return drawn;
}

/// All tracks; of very long ones only the end, as much as the limit allows.
DrawnTracks draw_tracks(const RunData& run, const Plot& plot) {
  DrawnTracks drawn = draw_tracks(run, plot, 0);
  if (drawn.points <= kMostTrackPoints) return drawn;
  const double kept = static_cast<double>(kMostTrackPoints) / static_cast<double>(drawn.points);
  return draw_tracks(run, plot, run.end_s() * (1 - kept));
}

/// Lines this wide cover at most about half of the ground together.
double stroke_width(double length, const Area& area) {
  constexpr double kInk = 0.5;
  return std::clamp(kInk * area.width * area.height / std::max(length, 1.0), 0.4, 1.6);
}

std::string square_at(const Eigen::Vector2d& center) {
  constexpr double kArm = 9;
  const Eigen::Vector2d across(kArm, 0), down(0, kArm);
  return path_data({center - across - down, center + across - down, center + across + down,
                    center - across + down}) +
         'Z';
}

/// Lines along the edges, where classical agents are caught, are drawn in full.
void draw_lines(Svg& svg, const DrawnTracks& tracks, const Area& area) {
  const std::string width = fixed(stroke_width(tracks.length, area), 2);
  svg.begin_clip({area.left - 1, area.top - 1, area.width + 2, area.height + 2});
  for (const auto& [agent, line] : tracks.lines) {
    svg.path(path_data(line),
             "class=\"curve\" stroke-width=\"" + width + "\" stroke=\"" + agent_color(agent) + '"');
  }
  svg.end_clip();
}

/// Open squares where agents are to be at the end.
void draw_stations(Svg& svg, const RunData& run, const Mission& mission, const Plot& plot) {
  for (const auto& [agent, track] : run.tracks) {
    const auto station_m = station_of(mission, agent);
    if (!station_m) continue;
    const Eigen::Vector2d at = plot.at(station_m->head<2>());
    svg.path(square_at(at), "fill=\"none\" stroke=\"#fff\" stroke-width=\"4.6\"");
    svg.path(square_at(at), "fill=\"none\" stroke=\"#333\" stroke-width=\"1.6\"");
  }
}

/// Crosses over open circles, so that an agent that never moved shows both.
void draw_ends(Svg& svg, const RunData& run, const Plot& plot) {
  constexpr double kArm = 5, kRadius = 5;
  const Eigen::Vector2d falling(kArm, kArm), rising(kArm, -kArm);
  for (const auto& [agent, track] : run.tracks) {
    const Eigen::Vector2d end = plot.at(track.back().x_m.head<2>());
    svg.circle(end, kRadius + 2, "fill=\"#fff\"");
    svg.circle(end, kRadius,
               "fill=\"none\" stroke-width=\"2.6\" stroke=\"" + agent_color(agent) + '"');
  }
  for (const auto& [agent, track] : run.tracks) {
    const Eigen::Vector2d start = plot.at(track.front().x_m.head<2>());
    const std::string cross =
        path_data({start - falling, start + falling}) + path_data({start - rising, start + rising});
    svg.path(cross, "fill=\"none\" stroke=\"#fff\" stroke-width=\"4.6\" stroke-linecap=\"round\"");
    svg.path(cross, "fill=\"none\" stroke-width=\"2.4\" stroke=\"" + agent_color(agent) + '"');
  }
}

/// Draws numbers beside the circles if colours alone do not distinguish the agents, unless there
/// are too many.
void draw_numbers(Svg& svg, const RunData& run, const Plot& plot) {
  constexpr std::size_t kMostNumbers = 24;
  if (run.tracks.size() <= kAgentColors || run.tracks.size() > kMostNumbers) return;
  for (const auto& [agent, track] : run.tracks) {
    const Eigen::Vector2d end = plot.at(track.back().x_m.head<2>());
    const bool at_edge = end.x() > plot.area().right() - 24;
    svg.text(end + Eigen::Vector2d(at_edge ? -8 : 8, 4),
             at_edge ? "class=\"onmap halo end\"" : "class=\"onmap halo\"", std::to_string(agent));
  }
}

void draw_signs(Svg& svg, double right, double y, bool stations) {
  const double x = right - 92;
  if (stations) {
    svg.path(square_at({x - 62, y + 8}), "class=\"mark\" fill=\"none\" stroke-width=\"1.6\"");
    svg.text({x - 49, y + 12}, "class=\"tick\"", "station");
  }
  svg.path(path_data({{x, y + 4}, {x + 8, y + 12}}) + path_data({{x, y + 12}, {x + 8, y + 4}}),
           "class=\"mark\" fill=\"none\" stroke-width=\"2\"");
  svg.text({x + 13, y + 12}, "class=\"tick\"", "start");
  svg.circle({x + 55, y + 8}, 4.5, "class=\"mark\" fill=\"none\" stroke-width=\"2\"");
  svg.text({x + 64, y + 12}, "class=\"tick\"", "end");
}

// --- coverage and coefficients ---

/// Where an odd number of rings are around.
void draw_walls(Svg& svg, const Rings& walls, const Plot& plot) {
  if (walls.empty()) return;
  const Area& area = plot.area();
  svg.begin_clip({area.left, area.top, area.width, area.height});
  std::string data;
  for (const Ring& ring : walls) {
    Polyline line;
    for (const Eigen::Vector2d& corner_m : ring) line.push_back(plot.at(corner_m));
    data += path_data(line) + 'Z';
  }
  svg.path(data, "fill=\"#777\" fill-rule=\"evenodd\" stroke=\"#333\" stroke-width=\"1\"");
  svg.end_clip();
}

void draw_field(Svg& svg, const Area& area, const Field& field, double brightest,
                const Mission& mission, const View& view, std::string_view title) {
  const Rectangle domain = base_of(mission.domain);
  Plot plot(svg, area, across_axis(domain, view), up_axis(domain, view));
  plot.image(field / brightest, viridis(), true);
  draw_walls(svg, mission.walls, plot);
  plot.frame();
  svg.text({area.left, area.top - 9}, "class=\"head\"", title);
}

Axis mode_axis(const std::string& title, int modes) {
  return range_axis(title, "", -0.5, modes - 0.5);
}

/// log |c − μ| between the decades `low` and `high`, as 0 … 1.
Field log_levels(const PlaneCoefficients& difference, const Axis& colors) {
  return difference.unaryExpr(
      [&](double value) { return value > colors.low ? colors.position(value) : 0.0; });
}

/// The three decades below the largest difference.
Axis difference_axis(const PlaneCoefficients& difference) {
  const double largest = difference.maxCoeff();
  return log_axis("|cₖ − μₖ|", largest / 1000, largest);
}

}  // namespace

Figure trajectories_figure(const RunData& run, const Mission& mission, const Field& target,
                           const View& view) {
  const Rectangle domain = base_of(mission.domain);
  const Area area = map_area(kLegend, domain, view);
  Svg svg(area.right() + kBar, area.bottom() + kRoomBelow, "trajectories", "Trajectories");
  Plot plot(svg, area, across_axis(domain, view), up_axis(domain, view));

  const Field ground =
      target.size() > 0 ? target : reconstruction(mission.target_coefficients, mission);
  // A uniform target is drawn light, and not as dark as a peak.
  const double densest = std::max(2.0, ground.maxCoeff());
  plot.image(ground / densest, pencil(), true);
  draw_walls(svg, mission.walls, plot);

  const DrawnTracks tracks = draw_tracks(run, plot);
  plot.frame();
  draw_lines(svg, tracks, area);
  if (view.up == 1) draw_stations(svg, run, mission, plot);
  draw_ends(svg, run, plot);
  draw_numbers(svg, run, plot);
  agent_legend(svg, run, kRoomLeft, 4, area.width);
  if (!run.empty()) draw_signs(svg, area.right() + kBar - 8, 4, any_station(mission));
  color_bar(svg, area, pencil(), range_axis("density, × uniform", "", 0, densest));
  return {"trajectories" + view.ending(), svg.str()};
}

Figure coverage_figure(const Coefficients& coverage, const Mission& mission, const View& view) {
  constexpr double kGap = 84;
  const Rectangle domain = base_of(mission.domain);
  const Field target = reconstruction(mission.target_coefficients, mission);
  const Field achieved = reconstruction(coverage, mission);
  // Leaves room above the target's own peak, for coverage that is too dense in places.
  const double peak = target.maxCoeff();
  const double brightest = std::clamp(achieved.maxCoeff(), peak, 1.5 * peak);

  const Area first = map_area(kTitled, domain, view);
  const Area second = long_domain(domain)
                          ? Area{first.left, first.bottom() + kGap, first.width, first.height}
                          : Area{first.right() + kGap, first.top, first.width, first.height};
  Svg svg(second.right() + kBar, second.bottom() + kRoomBelow, "coverage",
          "Coverage beside the target");
  draw_field(svg, first, achieved, brightest, mission, view, "achieved: Σ cₖ fₖ");
  draw_field(svg, second, target, brightest, mission, view, "target: Σ μₖ fₖ");
  color_bar(svg, second, viridis(), range_axis("time spent, × uniform", "", 0, brightest));
  return {"coverage" + view.ending(), svg.str()};
}

Figure coefficients_figure(const Coefficients& coverage, const Mission& mission, const View& view) {
  const Coefficients all = (coverage - mission.target_coefficients).cwiseAbs();
  const PlaneCoefficients difference = in_plane(all, mission.basis);
  const Axis colors = difference_axis(difference);
  const Eigen::Vector2d modes(mission.basis.modes_x, mission.basis.modes_y);
  const Area area = fitted(kTitled, kSide, modes);
  Svg svg(area.right() + kBar, area.bottom() + kRoomBelow, "coefficients", "Differences by mode");
  Plot plot(svg, area,
            mode_axis("m (half waves along " + view.across_name() + ')', mission.basis.modes_x),
            mode_axis("n (half waves along " + view.up_name() + ')', mission.basis.modes_y));
  if (coverage[0] == 0) {
    plot.show_message("no position was recorded");
  } else {
    plot.image(log_levels(difference, colors), viridis(), false);
  }
  plot.frame();
  color_bar(svg, area, viridis(), colors);
  return {"coefficients" + view.ending(), svg.str()};
}

}  // namespace ergocast
