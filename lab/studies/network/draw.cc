// SPDX-License-Identifier: BSD-3-Clause
// Tables and figures of the network studies, from what lab/studies/network/run has simulated.
#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <map>
#include <optional>

#include "report/axes.h"
#include "report/figures.h"
#include "logger/run_record.h"
#include "report/statistics.h"
#include "lab/studies/table.h"

namespace ergocast::studies {
namespace {

namespace fs = std::filesystem;

/// One thing that is varied; FOLDER/<name>-<source>-<agents>-<value>.csv has the seeds of one point. They
/// are compared with the same seeds where every agent knows everything, FOLDER/central-<agents>/study.csv.
struct Study {
  std::string name, x_title;
  std::vector<std::string> values;
  double unit;  ///< x is the value times this
  bool log_x = false;
};

/// What agents know of each other from.
struct Source {
  std::string name, dashes;
};

/// Everything about one team at one value.
struct Point {
  double x = 0, metric = 0, contributions = 0;
  std::size_t seeds = 0;
  Estimate ratio;
};

struct Curve {
  int agents;
  Source source;
  std::string color;
  std::vector<Point> points;
};

const Study kStudies[] = {
    {"period", "broadcast period [s]", {"1", "4", "10", "16", "50"}, 0.5, true},
    {"period30", "broadcast period [s], 30 % lost", {"1", "4", "10", "16", "50"}, 0.5, true},
    {"loss", "broadcasts lost [%]", {"0", "0.01", "0.05", "0.1", "0.3", "0.6", "0.8"}, 100},
    {"everywhere", "messages lost on all buses [%]", {"0.01", "0.05", "0.1", "0.3"}, 100},
    {"delay", "mean delay [s]", {"0.2", "0.5", "1"}, 1},
    {"crashes", "agents killed in 100 s", {"0.002", "0.01", "0.05"}, 100},
};
constexpr int kTeams[] = {4, 16, 32, 64};
const Source kSources[] = {{"places", "none"}, {"broadcasts", "5 4"}};

/// φ² at the end, by seed.
using Metrics = std::map<double, double>;

Metrics metrics_of(const Table& table) {
  Metrics metrics;
  const auto& seeds = table.at("seed");
  for (std::size_t i = 0; i < seeds.size(); ++i) metrics[seeds[i]] = table.at("ergodic_metric")[i];
  return metrics;
}

/// Of the seeds that both have. Throws std::runtime_error if there is none.
Estimate compare(const Metrics& ours, const Metrics& theirs) {
  std::vector<double> numerators, denominators;
  for (const auto& [seed, metric] : ours) {
    const auto twin = theirs.find(seed);
    if (twin == theirs.end()) continue;
    numerators.push_back(metric);
    denominators.push_back(twin->second);
  }
  if (numerators.empty()) throw std::runtime_error("two points have no seed in common");
  return ratio_of(numerators, denominators);
}

Point point_of(const Table& table, double x, const Metrics& central) {
  Point point;
  point.seeds = table.at("seed").size();
  point.x = x;
  point.ratio = compare(metrics_of(table), central);
  point.metric = median_of(table.at("ergodic_metric")).value;
  point.contributions = median_of(table.at("contributions")).value;
  return point;
}

Curve curve_of(const Study& study, int agents, const Source& source, const fs::path& folder) {
  const auto color = agent_color(static_cast<AgentId>(std::find(kTeams, std::end(kTeams), agents) - kTeams));
  Curve curve{agents, source, color, {}};
  const std::string team = "-" + std::to_string(agents);
  const fs::path central_file = folder / ("central" + team) / "study.csv";
  if (!fs::exists(central_file)) return curve;
  const Metrics central = metrics_of(read_study(central_file).front().columns);
  for (const std::string& value : study.values) {
    const fs::path file = folder / (study.name + '-' + source.name + team + '-' + value + ".csv");
    if (!fs::exists(file)) continue;
    curve.points.push_back(point_of(read_table(file), std::stod(value) * study.unit, central));
  }
  return curve;
}

void print(const Study& study, const std::vector<Curve>& curves) {
  std::printf("| agents | known from | %s | seeds | contributions | φ² (median) | φ² against central (95 %%) |\n"
              "|---|---|---|---|---|---|---|\n",
              study.x_title.c_str());
  for (const Curve& curve : curves) {
    for (const Point& p : curve.points) {
      std::printf("| %d | %s | %g | %zu | %.0f | %.3g | %.2f (%.2f to %.2f) |\n", curve.agents,
                  curve.source.name.c_str(), p.x, p.seeds, p.contributions, p.metric, p.ratio.value,
                  p.ratio.low, p.ratio.high);
    }
  }
  std::printf("\n");
}

// ---- figures -------------------------------------------------------------------------------------

constexpr double kWidth = 760, kHeight = 360, kPanelWidth = 530, kPanelHeight = 270;
constexpr double kTop = 36, kLeft = 66;

std::string stroke(const Curve& curve) {
  return "stroke=\"" + curve.color + "\" stroke-width=\"1.8\" stroke-dasharray=\"" + curve.source.dashes + '"';
}

/// One line a team and source, with its confidence intervals.
void draw_ratios(Svg& svg, Axis x, Axis y, const std::vector<Curve>& curves) {
  svg.text({kLeft, kTop - 12}, "class=\"head\"", "φ² at the end against central");
  Plot plot(svg, {kLeft, kTop, kPanelWidth, kPanelHeight}, std::move(x), std::move(y));
  plot.grid();
  for (const Curve& curve : curves) {
    const std::string color = "stroke=\"" + curve.color + '"';
    Polyline line;
    for (const Point& p : curve.points) {
      line.push_back({p.x, p.ratio.value});
      svg.circle(plot.at(p.x, p.ratio.value), 2, color);  // of one point there is no line
      svg.line(plot.at(p.x, p.ratio.low), plot.at(p.x, p.ratio.high), color);
    }
    plot.curve(line, "class=\"curve\" " + stroke(curve));
  }
  plot.frame();
}

void draw_key(Svg& svg, const std::vector<Curve>& curves) {
  const double left = kLeft + kPanelWidth + 18;
  double y = kTop + 8;
  for (const Curve& curve : curves) {
    svg.line({left, y}, {left + 30, y}, stroke(curve));
    svg.text({left + 36, y + 4}, "", std::to_string(curve.agents) + ", " + curve.source.name);
    y += 20;
  }
}

struct Extent {
  double low = 1e300, high = 0;
  void add(double value) {
    if (value > 0) low = std::min(low, value), high = std::max(high, value);
  }
};

std::string draw(const Study& study, const std::vector<Curve>& curves) {
  Extent x, ratio;
  for (const Curve& curve : curves) {
    for (const Point& p : curve.points) {
      x.add(p.x);
      ratio.add(p.ratio.low);
      ratio.add(p.ratio.high);
    }
  }
  Svg svg(kWidth, kHeight, study.name, study.x_title);
  draw_key(svg, curves);
  draw_ratios(svg,
              study.log_x ? log_axis(study.x_title, x.low / 1.2, x.high * 1.2)
                          : range_axis(study.x_title, "", 0, x.high),
              log_axis("ratio", std::min(0.9, ratio.low / 1.1), std::max(1.1, ratio.high * 1.1)), curves);
  return svg.str();
}

int run(const fs::path& folder, const fs::path& images) {
  for (const Study& study : kStudies) {
    std::vector<Curve> curves;
    for (const int agents : kTeams) {
      for (const Source& source : kSources) {
        Curve curve = curve_of(study, agents, source, folder);
        if (!curve.points.empty()) curves.push_back(std::move(curve));
      }
    }
    if (curves.empty()) continue;
    print(study, curves);
    if (const auto problem = write_file(images / (study.name + ".svg"), draw(study, curves))) {
      throw std::runtime_error(*problem);
    }
  }
  return 0;
}

}  // namespace
}  // namespace ergocast::studies

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: studies-network FOLDER_OF_CSV_FILES FOLDER_OF_IMAGES\n");
    return 2;
  }
  try {
    return ergocast::studies::run(argv[1], argv[2]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "studies-network: %s\n", error.what());
    return 2;
  }
}
