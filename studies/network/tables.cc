// SPDX-License-Identifier: BSD-3-Clause
// Tables of the network studies, and what their figures are drawn from, of what
// studies/network/run has simulated.
#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <map>

#include "report/statistics.h"
#include "studies/curves.h"
#include "studies/table.h"

namespace ergocast::studies {
namespace {

namespace fs = std::filesystem;

/// One thing that is varied; FOLDER/<name>-<source>-<agents>-<value>.csv has the seeds of one
/// point. They are compared with runs of the same seeds in which every agent knows everything,
/// FOLDER/central-<agents>/study.csv.
struct Study {
  std::string name, x_title;
  std::vector<std::string> values;
  double unit;  ///< x is the value times this
};

/// Everything about one team at one value.
struct Point {
  double x = 0, contributions = 0;
  std::size_t seeds = 0;
  Estimate metric, ratio;
};

struct Series {
  int agents;
  std::string source;  ///< what agents know of each other from
  std::vector<Point> points;
};

const Study kStudies[] = {
    {"period", "broadcast period [s]", {"1", "4", "10", "16", "50"}, 0.5},
    {"period30", "broadcast period [s], 30 % lost", {"1", "4", "10", "16", "50"}, 0.5},
    {"period10", "broadcast period [s], 10 % lost on all buses", {"1", "4", "10", "50"}, 0.5},
    {"loss", "broadcasts lost [%]", {"0", "0.01", "0.05", "0.1", "0.3", "0.6", "0.8"}, 100},
    {"everywhere", "messages lost on all buses [%]", {"0.01", "0.05", "0.1", "0.3"}, 100},
    {"delay", "mean delay [s]", {"0.2", "0.5", "1", "2", "5"}, 1},
    {"crashes", "agents killed in 100 s", {"0.002", "0.01", "0.05"}, 100},
};
constexpr int kTeams[] = {4, 16, 32, 64};
constexpr const char* kSources[] = {"places", "broadcasts"};

/// φ² at the end, by seed.
using Metrics = std::map<double, double>;

Metrics metrics_of(const Table& table) {
  Metrics metrics;
  const auto& seeds = table.at("seed");
  for (std::size_t i = 0; i < seeds.size(); ++i) metrics[seeds[i]] = table.at("ergodic_metric")[i];
  return metrics;
}

/// Compares the seeds that both have. Throws std::runtime_error if there is none.
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
  const auto& metrics = table.at("ergodic_metric");
  point.metric = ratio_of(metrics, std::vector<double>(metrics.size(), 1.0));
  point.contributions = median_of(table.at("contributions")).value;
  return point;
}

Series series_of(const Study& study, int agents, const std::string& source,
                 const fs::path& folder) {
  Series series{agents, source, {}};
  const std::string team = "-" + std::to_string(agents);
  const fs::path central_file = folder / ("central" + team) / "study.csv";
  if (!fs::exists(central_file)) return series;
  const Metrics central = metrics_of(read_study(central_file).front().columns);
  for (const std::string& value : study.values) {
    const fs::path file = folder / (study.name + '-' + source + team + '-' + value + ".csv");
    if (!fs::exists(file)) continue;
    series.points.push_back(point_of(read_table(file), std::stod(value) * study.unit, central));
  }
  return series;
}

void print(const Study& study, const std::vector<Series>& all) {
  std::printf(
      "| agents | known from | %s | seeds | contributions | φ² (95 %%) | φ² against central (95 "
      "%%) |\n"
      "|---|---|---|---|---|---|---|\n",
      study.x_title.c_str());
  for (const Series& series : all) {
    for (const Point& p : series.points) {
      std::printf("| %d | %s | %g | %zu | %.0f | %.2e (%.2e to %.2e) | %.2f (%.2f to %.2f) |\n",
                  series.agents, series.source.c_str(), p.x, p.seeds, p.contributions,
                  p.metric.value, p.metric.low, p.metric.high, p.ratio.value, p.ratio.low,
                  p.ratio.high);
    }
  }
  std::printf("\n");
}

/// Ratios with their confidence intervals.
std::vector<CurvePoint> curves_of(const std::vector<Series>& all) {
  std::vector<CurvePoint> curves;
  for (const Series& series : all) {
    for (const Point& p : series.points) {
      curves.emplace_back("", std::to_string(series.agents) + " agents", series.source, p.x,
                          p.ratio.low, p.ratio.value, p.ratio.high);
    }
  }
  return curves;
}

void run(const fs::path& folder, const fs::path& curves) {
  for (const Study& study : kStudies) {
    std::vector<Series> all;
    for (const int agents : kTeams) {
      for (const char* source : kSources) {
        Series series = series_of(study, agents, source, folder);
        if (!series.points.empty()) all.push_back(std::move(series));
      }
    }
    if (all.empty()) continue;
    print(study, all);
    write_curves(curves / ("network_" + study.name + ".csv"), curves_of(all));
  }
}

}  // namespace
}  // namespace ergocast::studies

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: studies-network FOLDER_OF_CSV_FILES FOLDER_OF_CURVES\n");
    return 2;
  }
  try {
    ergocast::studies::run(argv[1], argv[2]);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "studies-network: %s\n", error.what());
    return 2;
  }
}
