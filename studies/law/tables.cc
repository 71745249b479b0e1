// Tables and the figure of docs/law.md, from the studies that studies/law/run has flown.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <stdexcept>

#include "logger/figures.h"
#include "logger/statistics.h"
#include "studies/panels.h"
#include "studies/table.h"

namespace ergocast::studies {
namespace {

namespace fs = std::filesystem;
using Points = std::vector<StudyRuns>;

constexpr const char* kMetric = "ergodic_metric";
constexpr double kSoon_s = 15;

const StudyRuns& named(const Points& points, const std::string& scenario,
                       const std::string& value = "") {
  for (const StudyRuns& runs : points) {
    const bool this_value = value.empty() || std::stod(runs.names.at(1)) == std::stod(value);
    if (runs.names.front() == scenario && this_value) return runs;
  }
  throw std::runtime_error("no runs of " + scenario + " " + value);
}

/// Geometric mean of φ² against another's, seed by seed as far as both go.
Estimate against(const StudyRuns& ours, const StudyRuns& theirs) {
  std::vector<double> a = ours.of(kMetric), b = theirs.of(kMetric);
  const std::size_t count = std::min(a.size(), b.size());
  a.resize(count);
  b.resize(count);
  return ratio_of(a, b);
}

std::string text(const Estimate& e) {
  char line[80];
  std::snprintf(line, sizeof line, "%.3g (%.3g to %.3g)", e.value, e.low, e.high);
  return line;
}

double share_within(const std::vector<double>& times_s, double limit_s) {
  const auto end = std::upper_bound(times_s.begin(), times_s.end(), limit_s);
  return static_cast<double>(end - times_s.begin()) / static_cast<double>(times_s.size());
}

double mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

// ---- the laws ----

void print_laws(const Points& ours, const Points& papers, const StudyRuns& classical) {
  std::printf(
      "| four agents start | runs | φ²(2000 s), default | against classical from random starts "
      "| φ²(2000 s), the paper's constants | the paper's against the default |\n"
      "|---|---|---|---|---|---|\n");
  for (const StudyRuns& runs : ours) {
    const std::string& start = runs.names.front();
    std::printf("| %s | %zu | %.3g | %s |", start.c_str(), runs.of(kMetric).size(),
                median_of(runs.of(kMetric)).value, text(against(runs, classical)).c_str());
    if (start == "random") {
      std::printf(" | |\n");
      continue;
    }
    const StudyRuns& theirs = named(papers, start);
    std::printf(" %.3g | %s |\n", median_of(theirs.of(kMetric)).value,
                text(against(theirs, runs)).c_str());
  }
  std::printf("\nclassical from random starts: median %.3g\n\n",
              median_of(classical.of(kMetric)).value);
}

void print_escapes(const Points& ours, const Points& papers) {
  std::printf(
      "| start | agents | within 15 s | median [s] | 99 %% within [s] | last [s] "
      "| the paper's constants: within 15 s | median [s] |\n|---|---|---|---|---|---|---|---|\n");
  for (const StudyRuns& theirs : papers) {
    const std::string& start = theirs.names.front();
    const std::vector<double> fast = named(ours, start).escape_times_s(),
                              slow = theirs.escape_times_s();
    std::printf("| %s | %zu | %.2f %% | %.1f | %.1f | %.1f | %.1f %% | %.1f |\n", start.c_str(),
                fast.size(), 100 * share_within(fast, kSoon_s), quantile(fast, 0.5),
                quantile(fast, 0.99), fast.back(), 100 * share_within(slow, kSoon_s),
                quantile(slow, 0.5));
  }
  std::printf("\n");
}

// ---- one constant varied ----

/// A constant, the default it is compared with, and where.
struct Ladder {
  std::string study, title, usual;
  std::vector<std::string> starts;
};

const Ladder kLadders[] = {
    {"ceiling", "σ_max [m/√s]", "20", {"midline", "diagonal", "random"}},
    {"floor", "σ [m/√s]", "1", {"corners", "random"}},
    {"epsilon", "ε [of the residual]", "0.2", {"corners", "random"}},
    {"contraction", "k [1/s]", "1e-4", {"corners", "random"}},
};

void print_ladder(const Ladder& ladder, const Points& points) {
  std::printf(
      "| %s | start | φ² against its value at %s | left within 15 s | mean speed [m/s] "
      "| share of time at the edge |\n|---|---|---|---|---|---|\n",
      ladder.title.c_str(), ladder.usual.c_str());
  for (const StudyRuns& runs : points) {
    const std::vector<double> times_s = runs.escape_times_s();
    char left[32] = "";
    if (!times_s.empty()) {
      std::snprintf(left, sizeof left, "%.1f %%", 100 * share_within(times_s, kSoon_s));
    }
    std::printf("| %s | %s | %s | %s | %.1f | %.2g %% |\n", runs.names.at(1).c_str(),
                runs.names.front().c_str(),
                text(against(runs, named(points, runs.names.front(), ladder.usual))).c_str(), left,
                mean(runs.of("speed_mean_mps")), 100 * mean(runs.of("edge_share")));
  }
  std::printf("\n");
}

Panel panel_of(const Ladder& ladder, const Points& points) {
  Panel panel{"φ²(2000 s) against its value at " + ladder.usual,
              range_axis("", "", 0, 1),
              log_axis("ratio", 0.7, 1.6),
              {},
              {}};
  double low = 1e300, high = 0;
  for (std::size_t i = 0; i < ladder.starts.size(); ++i) {
    Curve curve{agent_color(static_cast<AgentId>(i)), {}};
    for (const StudyRuns& runs : points) {
      const double x = std::stod(runs.names.at(1));
      if (runs.names.front() != ladder.starts[i] || x <= 0) continue;
      const Estimate ratio = against(runs, named(points, ladder.starts[i], ladder.usual));
      curve.points.push_back({x, ratio.value});
      panel.intervals.push_back({curve.color, x, ratio.low, ratio.value, ratio.high});
      low = std::min(low, x);
      high = std::max(high, x);
    }
    panel.curves.push_back(std::move(curve));
  }
  panel.x = log_axis(ladder.title, low / 1.3, high * 1.3);
  return panel;
}

void draw_ladder(const Ladder& ladder, const Points& points, const fs::path& images) {
  std::vector<KeyEntry> key;
  for (std::size_t i = 0; i < ladder.starts.size(); ++i) {
    key.push_back({ladder.starts[i], agent_color(static_cast<AgentId>(i)), "none", true});
  }
  write_figure(images / ("law_" + ladder.study + ".svg"),
               figure("law_" + ladder.study, ladder.title, key, {panel_of(ladder, points)}));
}

// ---- other targets ----

/// The geometric mean, what one run in ten exceeds, and the worst: on targets that can be divided among
/// the team in a wrong way, the first alone would hide what the others say.
std::string spread(const StudyRuns& runs) {
  std::vector<double> sorted = runs.of(kMetric);
  std::sort(sorted.begin(), sorted.end());
  double sum = 0;
  for (const double value : sorted) sum += std::log(value);
  char line[80];
  std::snprintf(line, sizeof line, "%.2e | %.2e | %.2e", std::exp(sum / static_cast<double>(sorted.size())),
                quantile(sorted, 0.9), sorted.back());
  return line;
}

void print_targets(const Points& ours, const Points& classical) {
  std::printf(
      "| target and start | runs | default, mean | 9 of 10 below | worst | classical, mean | 9 of 10 below "
      "| worst | default against classical |\n|---|---|---|---|---|---|---|---|---|\n");
  for (const StudyRuns& runs : ours) {
    const StudyRuns& theirs = named(classical, runs.names.front());
    std::printf("| %s | %zu | %s | %s | %s |\n", runs.names.front().c_str(), runs.of(kMetric).size(),
                spread(runs).c_str(), spread(theirs).c_str(), text(against(runs, theirs)).c_str());
  }
  std::printf("\n");
}

// ---- teams of other sizes, and the uniform target ----

void print_sizes(const fs::path& folder) {
  std::printf(
      "| agents | φ²(2000 s), default | against constant noise | against classical |\n"
      "|---|---|---|---|\n");
  for (const char* size : {"1", "2", "8", "16"}) {
    const auto runs = [&](const std::string& law) {
      return read_study(folder / ("size-" + law + "-" + size) / "study.csv").front();
    };
    const StudyRuns ours = runs("default");
    std::printf("| %s | %.3g | %s | %s |\n", size, median_of(ours.of(kMetric)).value,
                text(against(ours, runs("constant"))).c_str(),
                text(against(ours, runs("classical"))).c_str());
  }
  std::printf("\n");
}

void print_uniform(const Points& points) {
  std::printf("| agents | runs | φ²(200 s) | slope |\n|---|---|---|---|\n");
  for (const StudyRuns& runs : points) {
    const Estimate slope = median_of(runs.of("slope"));
    std::printf("| %s | %zu | %.3g | %.2f (%.2f to %.2f) |\n", runs.names.at(1).c_str(),
                runs.of(kMetric).size(), median_of(runs.of(kMetric)).value, slope.value, slope.low,
                slope.high);
  }
}

void run(const fs::path& folder, const fs::path& images) {
  const auto study = [&](const std::string& name) {
    return read_study(folder / name / "study.csv");
  };
  const Points ours = study("default"), papers = study("paper");
  print_laws(ours, papers, study("classical").front());
  print_escapes(ours, papers);
  for (const Ladder& ladder : kLadders) {
    const Points points = study(ladder.study);
    print_ladder(ladder, points);
    draw_ladder(ladder, points, images);
  }
  print_targets(study("targets-default"), study("targets-classical"));
  print_sizes(folder);
  print_uniform(study("uniform"));
}

}  // namespace
}  // namespace ergocast::studies

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: studies-law FOLDER_OF_STUDIES FOLDER_OF_IMAGES\n");
    return 2;
  }
  try {
    ergocast::studies::run(argv[1], argv[2]);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "studies-law: %s\n", error.what());
    return 2;
  }
}
