// SPDX-License-Identifier: BSD-3-Clause
// The figures of a report. Each is a complete SVG document; an empty run gives empty plots. A map
// is one of a mission in a plane; report/projection.h gives one for each view of a box.
#pragma once

#include <string>
#include <vector>

#include "core/mission.h"
#include "logger/run_data.h"
#include "report/projection.h"
#include "report/raster.h"
#include "report/svg.h"

namespace ergocast {

struct Figure {
  std::string name;  ///< of its file, without ".svg"
  std::string svg;
};

/// The agents' tracks over the target density: crosses are starts, circles are ends.
/// @param target  in multiples of the uniform density; if empty, the sum of the μ_k is drawn
Figure trajectories_figure(const RunData& run, const Mission& mission, const Field& target,
                           const View& view = {});

/// φ² against t, log–log, with the power of t that fits the last decade.
Figure metric_figure(const RunData& run, const Mission& mission);

/// Σ c_k f_k beside Σ μ_k f_k, f normalised, in the same colours. `coverage` is c_k, or all zero.
Figure coverage_figure(const Coefficients& coverage, const Mission& mission, const View& view = {});

/// |c_k − μ_k| of every mode, logarithmic. `coverage` is c_k, or all zero.
Figure coefficients_figure(const Coefficients& coverage, const Mission& mission,
                           const View& view = {});

/// Each agent's commanded speed over time.
Figure speeds_figure(const RunData& run, const Mission& mission);

/// Contributions received and lost, staleness, and how much the agents' own φ² differ.
Figure communication_figure(const RunData& run, const Mission& mission);

/// All figures, in the order of the report: six, in a box a map of each kind for each view. Maps of
/// a mission that steers by the modes of its free domain are of cosines.
std::vector<Figure> draw_figures(const RunData& run, const Mission& flown, const Field& target);

/// "λ = (1 + |k|²)^−1.5, f not divided by hₖ, 15 × 15 modes": the conventions that a φ² depends on.
std::string conventions_line(const Basis& basis);

/// The colour of an agent, "#rrggbb": seven colours that are distinct with any colour vision (Okabe
/// and Ito's, without those too pale on white), then again from the first.
std::string agent_color(AgentId agent);
inline constexpr std::size_t kAgentColors = 7;

/// A legend of the agents' colours in rows of at most `width` pixels below `top`; returns its
/// height in pixels.
double agent_legend(Svg& svg, const RunData& run, double left, double top, double width);

}  // namespace ergocast
