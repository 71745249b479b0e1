// SPDX-License-Identifier: BSD-3-Clause
// Tables of docs/law.md and docs/results/law.md, and what their figures are drawn from, of the
// studies of studies/law/run.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <stdexcept>

#include "report/statistics.h"
#include "studies/curves.h"
#include "studies/table.h"

namespace ergocast::studies {
namespace {

namespace fs = std::filesystem;
using Points = std::vector<StudyRuns>;

constexpr const char* kMetric = "ergodic_metric";
constexpr double kSoon_s = 15;

/// The folders of a group end in these; what the tables and the figure call them.
struct Law {
  const char *folder, *name;
};
constexpr Law kLaws[] = {{"default", "the default"},
                         {"old", "version 0.1.0"},
                         {"classical", "classical"},
                         {"paper", "the paper's constants"}};

std::string joined(const std::vector<std::string>& names) {
  std::string all;
  for (const std::string& name : names) all += (all.empty() ? "" : ", ") + name;
  return all;
}

/// The point whose names begin with `names`: what a law is made of stands behind them.
const StudyRuns& named(const Points& points, const std::vector<std::string>& names) {
  for (const StudyRuns& runs : points) {
    if (std::equal(names.begin(), names.end(), runs.names.begin())) return runs;
  }
  throw std::runtime_error("no runs of " + joined(names));
}

/// Geometric mean of φ² against another's, seed by seed.
Estimate against(const StudyRuns& ours, const StudyRuns& theirs) {
  if (ours.of("seed") != theirs.of("seed")) {
    throw std::runtime_error("other seeds of " + joined(ours.names) + " and " +
                             joined(theirs.names));
  }
  return ratio_of(ours.of(kMetric), theirs.of(kMetric));
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

double geometric_mean(std::vector<double> values) {
  for (double& value : values) value = std::log(value);
  return std::exp(mean(values));
}

// ---- the laws ----

/// The geometric mean, what one run in ten exceeds, and the worst: on targets that can be divided
/// among the team in a wrong way, the first alone would hide what the others say.
std::string spread(const StudyRuns& runs) {
  std::vector<double> sorted = runs.of(kMetric);
  std::sort(sorted.begin(), sorted.end());
  char line[80];
  std::snprintf(line, sizeof line, "%.2e · %.1e · %.1e", geometric_mean(sorted),
                quantile(sorted, 0.9), sorted.back());
  return line;
}

/// Studies of one kind, and what stands behind each name of their points.
struct Group {
  const char* study;
  std::vector<std::string> units;
};

std::string label(const Group& group, const StudyRuns& runs) {
  std::vector<std::string> names = runs.names;
  for (std::size_t i = 0; i < names.size(); ++i) names[i] += group.units.at(i);
  return joined(names);
}

/// Nothing if the group has no such folder: not every law suits every scenario.
Points points_of(const fs::path& folder, const Group& group, const Law& law) {
  const fs::path study = folder / (std::string(group.study) + "-" + law.folder);
  return fs::exists(study) ? read_study(study / "study.csv") : Points();
}

void print_rows(const fs::path& folder, const Group& group) {
  std::vector<Points> laws;
  for (const Law& law : kLaws) laws.push_back(points_of(folder, group, law));
  for (const StudyRuns& ours : laws[0]) {
    std::printf("| %s | %zu", label(group, ours).c_str(), ours.of(kMetric).size());
    for (const int law : {0, 1, 2})
      std::printf(" | %s", spread(named(laws[law], ours.names)).c_str());
    if (laws[3].empty()) {
      std::printf(" | –");
    } else {
      std::printf(" | %.1e", geometric_mean(named(laws[3], ours.names).of(kMetric)));
    }
    for (const int law : {1, 2})
      std::printf(" | %s", text(against(ours, named(laws[law], ours.names))).c_str());
    std::printf(" |\n");
  }
}

void print_laws(const fs::path& folder, const std::vector<Group>& groups) {
  std::printf(
      "| | runs | the default | version 0.1.0 | classical | the paper's | default against 0.1.0 "
      "| default against classical |\n|---|---|---|---|---|---|---|---|\n");
  for (const Group& group : groups) print_rows(folder, group);
  std::printf("\n");
}

void print_escapes(const Points& ours, const Points& old, const Points& papers) {
  std::printf(
      "| start | agents | within 15 s | median [s] | 99 %% within [s] | last [s] "
      "| version 0.1.0: within 15 s | the paper's constants: within 15 s "
      "|\n|---|---|---|---|---|---|---|---|\n");
  for (const StudyRuns& runs : ours) {
    const std::vector<double> times_s = runs.escape_times_s();
    const auto soon = [&](const Points& points) {
      return 100 * share_within(named(points, runs.names).escape_times_s(), kSoon_s);
    };
    std::printf("| %s | %zu | %.2f %% | %.1f | %.1f | %.1f | %.2f %% | %.1f %% |\n",
                runs.names.front().c_str(), times_s.size(), soon(ours), quantile(times_s, 0.5),
                quantile(times_s, 0.99), times_s.back(), soon(old), soon(papers));
  }
  std::printf("\n");
}

/// φ² over time, by the columns ergodic_metric_at_T_s.
void write_decay(const fs::path& folder, const std::string& group, const fs::path& file) {
  const std::string begin = std::string(kMetric) + "_at_";
  std::vector<CurvePoint> curves;
  for (const Law& law : kLaws) {
    const StudyRuns runs = read_study(folder / (group + "-" + law.folder) / "study.csv").front();
    for (const auto& [column, values] : runs.columns) {
      if (!column.starts_with(begin)) continue;
      const double t_s = std::stod(column.substr(begin.size()));
      if (t_s >= 10) curves.emplace_back("", law.name, "", t_s, geometric_mean(values));
    }
    curves.emplace_back("", law.name, "", std::stod(runs.names.at(1)),
                        geometric_mean(runs.of(kMetric)));
  }
  write_curves(file, curves);
}

// ---- one constant varied ----

/// A constant, and the value that the others are compared with: the default or next to it.
struct Ladder {
  const char *study, *title, *usual;
};
constexpr Ladder kLadders[] = {
    {"anticipation", "anticipation", "2"}, {"epsilon", "ε [of the residual]", "0.05"},
    {"ceiling", "σ_max [m/√s]", "20"},     {"floor", "σ [m/√s]", "1"},
    {"contraction", "k [1/s]", "1e-4"},
};

/// The same scenario and duration at the default.
const StudyRuns& usual(const Ladder& ladder, const Points& points, const StudyRuns& runs) {
  std::vector<std::string> names = runs.names;
  names.at(1) = ladder.usual;
  return named(points, names);
}

/// All constants in one table, in the order of kLadders.
void print_ladders(const std::vector<Points>& studies) {
  std::printf(
      "| constant | value | start, T [s] | runs | φ² | against the usual value | mean speed [m/s] "
      "|\n|---|---|---|---|---|---|---|\n");
  for (std::size_t i = 0; i < studies.size(); ++i) {
    for (const StudyRuns& runs : studies[i]) {
      std::printf("| %s | %s | %s, %s | %zu | %.2e | %s | %.1f |\n", kLadders[i].title,
                  runs.names.at(1).c_str(), runs.names.front().c_str(), runs.names.at(2).c_str(),
                  runs.of(kMetric).size(), geometric_mean(runs.of(kMetric)),
                  text(against(runs, usual(kLadders[i], studies[i], runs))).c_str(),
                  mean(runs.of("speed_mean_mps")));
    }
  }
  std::printf("\n");
}

/// One curve for each scenario and duration.
void write_ladder(const Ladder& ladder, const Points& points, const fs::path& file) {
  std::vector<CurvePoint> curves;
  for (const StudyRuns& runs : points) {
    const double x = std::stod(runs.names.at(1));
    if (x <= 0) continue;
    const Estimate ratio = against(runs, usual(ladder, points, runs));
    curves.emplace_back("", runs.names.front() + ", " + runs.names.at(2) + " s", "", x, ratio.low,
                        ratio.value, ratio.high);
  }
  write_curves(file, curves);
}

/// A field that is off or on.
struct Choice {
  const char *study, *field;
};
constexpr Choice kChoices[] = {{"pairs", "`paired_pushes`"}, {"ends", "`ends_with_plan`"}};

void print_choice(const Choice& choice, const Points& points) {
  for (const StudyRuns& off : points) {
    if (off.names.at(1) != "false") continue;
    std::vector<std::string> names = off.names;
    names[1] = "true";
    const StudyRuns& on = named(points, names);
    names.erase(names.begin() + 1);
    std::printf("| %s | %s | %zu | %s | %s | %s |\n", choice.field, joined(names).c_str(),
                on.of(kMetric).size(), spread(off).c_str(), spread(on).c_str(),
                text(against(on, off)).c_str());
  }
}

/// The power of t that fits φ² over the last decade of time.
void print_slopes(const fs::path& folder, const Group& group) {
  std::printf(
      "| | runs | the default: slope | version 0.1.0 | classical |\n|---|---|---|---|---|\n");
  std::vector<Points> laws;
  for (const int law : {0, 1, 2}) laws.push_back(points_of(folder, group, kLaws[law]));
  for (const StudyRuns& ours : laws[0]) {
    std::printf("| %s | %zu", label(group, ours).c_str(), ours.of(kMetric).size());
    for (const Points& points : laws) {
      const Estimate slope = median_of(named(points, ours.names).of("slope"));
      std::printf(" | %.2f (%.2f to %.2f)", slope.value, slope.low, slope.high);
    }
    std::printf(" |\n");
  }
  std::printf("\n");
}

void run(const fs::path& folder, const fs::path& curves) {
  const auto study = [&](const std::string& name) {
    return read_study(folder / name / "study.csv");
  };
  const std::vector<std::string> timed{"", " s"}, sized{"", " s", " agents"},
      stepped{"", " s", " s a step"}, squared{"", " agents"};
  print_laws(folder, {{"promised", timed},
                      {"brief", timed},
                      {"short", timed},
                      {"later", timed},
                      {"long", timed},
                      {"sixteen", sized}});
  print_laws(folder, {{"sizes", sized}, {"crowd", timed}, {"starts", timed}});
  print_laws(folder, {{"targets", timed},
                      {"long-domains", timed},
                      {"divided", sized},
                      {"far", timed},
                      {"modes", {"", " s", " modes along x", " along y"}}});
  print_laws(folder, {{"fine", stepped},
                      {"steps", stepped},
                      {"steps-16", stepped},
                      {"steps-48", {"", " s", " s a step", " modes along x", " along y"}}});
  print_laws(folder, {{"published", squared}});
  print_slopes(folder, {"published", squared});
  write_decay(folder, "long", curves / "law_decay.csv");
  print_escapes(study("escape-default"), study("escape-old"), study("escape-paper"));
  std::vector<Points> ladders;
  for (const Ladder& ladder : kLadders) ladders.push_back(study(ladder.study));
  print_ladders(ladders);
  write_ladder(kLadders[0], ladders[0], curves / "law_anticipation.csv");
  std::printf(
      "| field | start, T [s] | runs | off | on | on against off |\n|---|---|---|---|---|---|\n");
  for (const Choice& choice : kChoices) print_choice(choice, study(choice.study));
  std::printf("\n");
}

}  // namespace
}  // namespace ergocast::studies

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: studies-law FOLDER_OF_STUDIES FOLDER_OF_CURVES\n");
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
