// SPDX-License-Identifier: BSD-3-Clause
// Calls the function of each figure in the order of the page, and gives each agent its colour.
#include "report/figures.h"

#include <array>

#include "report/markup.h"

namespace ergocast {

std::vector<Figure> draw_figures(const RunData& run, const Mission& flown, const Field& target) {
  // Maps are of cosines; φ² over time is as it was recorded.
  const Mission mission = in_cosines(flown);
  const Coefficients coverage = coverage_of(run, mission);
  std::vector<Figure> tracks, fields, modes;
  for (const View& view : views_of(mission.domain)) {
    const Mission seen = projected(mission, view);
    const Coefficients seen_coverage = projected(coverage, mission.basis, view);
    // The target that was recorded is the one from above.
    const bool from_above = view.ending().empty();
    tracks.push_back(from_above ? trajectories_figure(run, seen, target, view)
                                : trajectories_figure(projected(run, view), seen, {}, view));
    fields.push_back(coverage_figure(seen_coverage, seen, view));
    modes.push_back(coefficients_figure(seen_coverage, seen, view));
  }
  std::vector<Figure> all = std::move(tracks);
  const auto add = [&all](const std::vector<Figure>& figures) {
    all.insert(all.end(), figures.begin(), figures.end());
  };
  add({metric_figure(run, flown)});
  add(fields);
  add(modes);
  add({speeds_figure(run, mission), communication_figure(run, flown)});
  return all;
}

std::string conventions_line(const Basis& basis) {
  const bool squared = basis.sobolev_form == SobolevForm::kSquaredNorm;
  if (basis.free_domain) {
    return std::string("modes of the free domain, λ = (1 + ") + (squared ? "νL²/π²" : "√ν L/π") +
           ")^−" + readable(basis.sobolev_exponent) + ", f " + (basis.normalized ? "" : "not ") +
           "divided by hₖ, " + std::to_string(basis.mode_count()) + " modes";
  }
  return std::string("λ = (1 + |k|") + (squared ? "²" : "") + ")^−" +
         readable(basis.sobolev_exponent) + ", f " + (basis.normalized ? "" : "not ") +
         "divided by hₖ, " + std::to_string(basis.modes_x) + " × " + std::to_string(basis.modes_y) +
         (basis.planar() ? "" : " × " + std::to_string(basis.modes_z)) + " modes";
}

std::string agent_color(AgentId agent) {
  static constexpr std::array<const char*, kAgentColors> kColors = {
      "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#7a4fb5"};
  return kColors[static_cast<std::size_t>(agent) % kColors.size()];
}

double agent_legend(Svg& svg, const RunData& run, double left, double top, double width) {
  constexpr double kRow = 18, kColumn = 72;
  if (run.tracks.size() > kAgentColors) {
    svg.text({left, top + 12}, "class=\"tick\"",
             std::to_string(run.tracks.size()) + " agents; the colours repeat after " +
                 std::to_string(kAgentColors));
    return kRow;
  }
  double x = left, y = top;
  for (const auto& [agent, track] : run.tracks) {
    if (x + kColumn > left + width) x = left, y += kRow;
    svg.line({x, y + 8}, {x + 18, y + 8},
             "stroke-width=\"3\" stroke=\"" + agent_color(agent) + '"');
    svg.text({x + 23, y + 12}, "class=\"tick\"", "agent " + std::to_string(agent));
    x += kColumn;
  }
  return y + kRow - top;
}

}  // namespace ergocast
