// Tables and figures of the network studies, from what studies/network/run has simulated.
#include <cstdio>
#include <exception>
#include <filesystem>
#include <map>
#include <optional>

#include "logger/axes.h"
#include "logger/figures.h"
#include "logger/run_record.h"
#include "logger/statistics.h"
#include "studies/table.h"

namespace ergocast::studies {
namespace {

namespace fs = std::filesystem;

/// One thing that is varied; FOLDER/<name>-<agents>-<value>.csv has the seeds of one point. They are
/// compared with the same seeds where every agent knows everything, FOLDER/central-<agents>/study.csv,
/// and with those of FOLDER/<untroubled>.csv, to tell what is varied from what is old anyway.
struct Study {
  std::string name, x_title;
  std::string untroubled, untroubled_title;  ///< % is the number of agents
  std::vector<std::string> values;
  double unit;       ///< x is the value times this
  bool by_messages;  ///< drawn against the contributions sent
};

/// Everything about one team at one value.
struct Point {
  double x = 0, view_error = 0, metric = 0, contributions = 0;
  std::size_t seeds = 0;
  Estimate ratio, ratio_to_untroubled;
};

struct Curve {
  int agents;
  std::vector<Point> points;
};

const Study kStudies[] = {
    {"loss", "messages lost [%]", "loss-%-0", "no loss", {"0", "0.01", "0.05", "0.1", "0.3", "0.6", "0.8"}, 100, false},
    {"delay", "mean delay [s]", "loss-%-0", "no delay", {"0.5", "1", "2", "5"}, 1, false},
    {"budget", "error budget [% of the residual]", "period-%-1", "every tick",
     {"0.02", "0.05", "0.1", "0.2"}, 100, true},
    {"period", "broadcast period [ticks]", "period-%-1", "every tick",
     {"1", "2", "5", "10", "20", "50"}, 1, true},
};
constexpr int kTeams[] = {4, 16, 32};

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

Point point_of(const Table& table, double x, const Metrics& central, const Metrics& untroubled) {
  Point point;
  point.seeds = table.at("seed").size();
  point.x = x;
  point.ratio = compare(metrics_of(table), central);
  point.ratio_to_untroubled = compare(metrics_of(table), untroubled);
  point.metric = median_of(table.at("ergodic_metric")).value;
  point.view_error = median_of(table.at("view_error")).value;
  point.contributions = median_of(table.at("contributions")).value;
  return point;
}

Curve curve_of(const Study& study, int agents, const fs::path& folder) {
  Curve curve{agents, {}};
  const std::string team = "-" + std::to_string(agents), name = study.name + team + "-";
  std::string untroubled = study.untroubled + ".csv";
  untroubled.replace(untroubled.find('%'), 1, std::to_string(agents));
  const fs::path central_file = folder / ("central" + team) / "study.csv";
  if (!fs::exists(central_file) || !fs::exists(folder / untroubled)) return curve;
  const Metrics central = metrics_of(read_study(central_file).front().columns);
  const Metrics least = metrics_of(read_table(folder / untroubled));
  for (const std::string& value : study.values) {
    const fs::path file = folder / (name + value + ".csv");
    if (!fs::exists(file)) continue;
    curve.points.push_back(point_of(read_table(file), std::stod(value) * study.unit, central, least));
  }
  return curve;
}

void print(const Study& study, const std::vector<Curve>& curves) {
  std::printf("| agents | %s | seeds | contributions | φ² (median) | φ² against central (95 %%) | against %s (95 %%) | view error |\n"
              "|---|---|---|---|---|---|---|---|\n",
              study.x_title.c_str(), study.untroubled_title.c_str());
  for (const Curve& curve : curves) {
    for (const Point& p : curve.points) {
      const auto [ratio, low, high] = p.ratio_to_untroubled;
      std::printf("| %d | %g | %zu | %.0f | %.3g | %.2f (%.2f to %.2f) | %.2f (%.2f to %.2f) | %.2g |\n",
                  curve.agents, p.x, p.seeds, p.contributions, p.metric, p.ratio.value, p.ratio.low,
                  p.ratio.high, ratio, low, high, p.view_error);
    }
  }
  std::printf("\n");
}

// ---- figures -------------------------------------------------------------------------------------

constexpr double kWidth = 1130, kHeight = 360, kPanelWidth = 470, kPanelHeight = 250;
constexpr double kTop = 56, kLeft = 66;

using ValueOf = double (*)(const Point&);

/// One line a team, with its confidence interval where there is one.
void draw_panel(Svg& svg, double left, const std::string& title, Axis x, Axis y,
                const std::vector<Curve>& curves, ValueOf x_of, ValueOf y_of, bool intervals) {
  const Box area{left, kTop, kPanelWidth, kPanelHeight};
  svg.text({left, kTop - 12}, "class=\"head\"", title);
  Plot plot(svg, area, std::move(x), std::move(y));
  plot.grid();
  for (std::size_t i = 0; i < curves.size(); ++i) {
    const std::string color = "stroke=\"" + agent_color(static_cast<AgentId>(i)) + '"';
    Polyline line;
    for (const Point& p : curves[i].points) {
      line.push_back({x_of(p), y_of(p)});
      svg.circle(plot.at(x_of(p), y_of(p)), 2, color);  // of one point there is no line
      if (!intervals) continue;
      svg.line(plot.at(x_of(p), p.ratio.low), plot.at(x_of(p), p.ratio.high), color + " stroke-width=\"2\"");
    }
    plot.curve(line, "class=\"curve\" stroke-width=\"1.6\" " + color);
  }
  plot.frame();
}

void draw_key(Svg& svg, const std::vector<Curve>& curves) {
  double left = kLeft;
  for (std::size_t i = 0; i < curves.size(); ++i) {
    svg.line({left, 14}, {left + 24, 14}, "stroke-width=\"2\" stroke=\"" + agent_color(static_cast<AgentId>(i)) + '"');
    svg.text({left + 30, 18}, "", std::to_string(curves[i].agents) + " agents");
    left += 120;
  }
}

struct Extent {
  double low = 1e300, high = 0;
  void add(double value) {
    if (value > 0) low = std::min(low, value), high = std::max(high, value);
  }
};

std::string draw(const Study& study, const std::vector<Curve>& curves) {
  Extent x, ratio, error;
  for (const Curve& curve : curves) {
    for (const Point& p : curve.points) {
      x.add(study.by_messages ? p.contributions : p.x);
      ratio.add(p.ratio.low);
      ratio.add(p.ratio.high);
      error.add(p.view_error);
    }
  }
  const ValueOf x_of = study.by_messages ? [](const Point& p) { return p.contributions; }
                                   : [](const Point& p) { return p.x; };
  const auto x_axis = [&] {
    return study.by_messages ? log_axis("contributions sent", x.low / 1.2, x.high * 1.2)
                       : range_axis(study.x_title, "", 0, x.high);
  };
  Svg svg(kWidth, kHeight, study.name, study.x_title);
  draw_key(svg, curves);
  draw_panel(svg, kLeft, "φ² at the end against central", x_axis(),
             log_axis("ratio", std::min(0.9, ratio.low / 1.1), std::max(1.1, ratio.high * 1.1)), curves,
             x_of, [](const Point& p) { return p.ratio.value; }, true);
  draw_panel(svg, kWidth - 18 - kPanelWidth, "What the worst-informed agent's c lacks at the end", x_axis(),
             log_axis("√Σ λ (c_a − c)²", error.low / 1.5, error.high * 1.5), curves, x_of,
             [](const Point& p) { return p.view_error; }, false);
  return svg.str();
}

int run(const fs::path& folder, const fs::path& images) {
  for (const Study& study : kStudies) {
    std::vector<Curve> curves;
    for (const int agents : kTeams) {
      Curve curve = curve_of(study, agents, folder);
      if (!curve.points.empty()) curves.push_back(std::move(curve));
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
