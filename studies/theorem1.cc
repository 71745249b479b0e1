// Theorem 1: times of escape by the strength of the noise, from every set of Proposition 1.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <utility>
#include <variant>

#include "core/require.h"
#include "lab/ideal_team.h"
#include "lab/manifolds.h"
#include "logger/figures.h"
#include "scenario/scenario.h"
#include "studies/escape.h"
#include "studies/linearised.h"
#include "studies/panels.h"
#include "studies/table.h"
#include "studies/theorems.h"

namespace ergocast::studies {
namespace {

namespace fs = std::filesystem;

constexpr double kPaperEnd_s = 150, kUntil_s = 600;
/// Nearer than the finest mode's wavelength by far, where the linearised recursion should be exact.
constexpr double kNear_m = 0.5;
constexpr double kSigmas[] = {1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 1e-1, 1, 10};
constexpr double kEpsilons[] = {1e-5, 1e-4, 1e-3, 1e-2};
constexpr double kExponents[] = {1, 1.5};
constexpr double kPaperSigma = 1e-5, kPaperEpsilon = 1e-3;
constexpr double kMedianOfNormal = 0.67448975;  // of |z|
/// Of the sets that are alike by the square's symmetry, one each.
constexpr int kOneOfEach[] = {0, 1, 3, 5};

struct Point {
  int start;
  double exponent, epsilon, sigma;
  bool near = false;  ///< farther off than kNear_m counts, in place of the usual distance
};

std::string name_of(const Point& p) {
  char text[96];
  std::snprintf(text, sizeof text, "%s-%s-s%g-e%g-n%g", p.near ? "near" : "escape",
                starts()[p.start].name.c_str(), p.exponent, p.epsilon, p.sigma);
  return text;
}

std::vector<Point> all_points() {
  std::vector<Point> points;
  for (const double exponent : kExponents) {
    for (int start = 0; start < static_cast<int>(starts().size()); ++start) {
      for (const double sigma : kSigmas) points.push_back({start, exponent, kPaperEpsilon, sigma});
      points.push_back({start, exponent, kPaperEpsilon, kPaperSigma, true});
    }
    for (const int start : kOneOfEach) {
      for (const double epsilon : kEpsilons) {
        if (epsilon != kPaperEpsilon) points.push_back({start, exponent, epsilon, kPaperSigma});
      }
    }
  }
  return points;
}

Mission mission_of(const Point& p) {
  Mission mission = paper_mission();
  mission.basis.sobolev_exponent = p.exponent;
  mission.law.epsilon = p.epsilon;
  mission.law.noise_intensity = p.sigma;
  return from(starts()[p.start], mission);
}

double far_m(const Point& p) { return p.near ? kNear_m : lab::escape_distance_m(paper_mission().domain); }

/// Of one set under one law: for σ = 1, with and without what the past does.
struct Spreads {
  std::vector<double> counted, neglected;
};

Spreads spreads_of(const Point& p) {
  const Mission mission = mission_of(p);
  const auto steps = linearised(mission, std::lround(kUntil_s / mission.timing.dt_s));
  return {spread(steps, mission, Past::kCounted), spread(steps, mission, Past::kNeglected)};
}

/// One point, measured and predicted.
struct Row {
  Point point;
  std::vector<double> times_s;  // ascending; infinite where an agent never escaped
  double law_median_s = 0, without_past_s = 0, distance = 0;

  double quantile(double p) const {
    return times_s[std::min(times_s.size() - 1, static_cast<std::size_t>(p * static_cast<double>(times_s.size())))];
  }
  double share_by(double t_s) const {
    return static_cast<double>(std::upper_bound(times_s.begin(), times_s.end(), t_s + 1e-9) - times_s.begin()) /
           static_cast<double>(times_s.size());
  }
};

Row row_of(const Point& p, const Spreads& spreads, const fs::path& folder) {
  Row row{p, read_table(folder / (name_of(p) + ".csv")).at("escape_s")};
  std::sort(row.times_s.begin(), row.times_s.end());
  const Mission mission = mission_of(p);
  const EscapeLaw law(spreads.counted, mission, far_m(p));
  row.law_median_s = law.quantile_s(0.5);
  row.without_past_s = EscapeLaw(spreads.neglected, mission, far_m(p)).quantile_s(0.5);
  for (double t_s = 0; t_s <= kUntil_s; t_s += mission.timing.dt_s) {
    row.distance = std::max(row.distance, std::abs(row.share_by(t_s) - law.probability(t_s)));
  }
  return row;
}

std::string seconds_text(double t_s) {
  char text[32];
  std::snprintf(text, sizeof text, std::isfinite(t_s) ? "%.1f" : "> %g", std::isfinite(t_s) ? t_s : kUntil_s);
  return text;
}

/// Every set at the paper's σ and ε.
void print_sets(const std::vector<Row>& rows, double exponent) {
  std::printf("| set | out by 150 s | by 600 s | 10 %% | median | 90 %% | predicted median | past neglected | distance |\n"
              "|---|---|---|---|---|---|---|---|---|\n");
  for (const Row& row : rows) {
    if (row.point.exponent != exponent || row.point.sigma != kPaperSigma) continue;
    std::printf("| %s | %.1f %% | %.1f %% | %s | %s | %s | %s | %s | %.3f |\n", starts()[row.point.start].set.c_str(),
                100 * row.share_by(kPaperEnd_s), 100 * row.share_by(kUntil_s), seconds_text(row.quantile(0.1)).c_str(),
                seconds_text(row.quantile(0.5)).c_str(), seconds_text(row.quantile(0.9)).c_str(),
                seconds_text(row.law_median_s).c_str(), seconds_text(row.without_past_s).c_str(), row.distance);
  }
  std::printf("\n");
}

/// Medians, predictions and shares of one set each, by what is varied.
void print_varied(const std::vector<Row>& rows, double exponent, const char* title, double Point::*varied) {
  std::map<double, std::string> lines;
  double farthest = 0;
  for (const int start : kOneOfEach) {
    for (const Row& row : rows) {
      if (row.point.start != start || row.point.exponent != exponent) continue;
      char cell[96];
      std::snprintf(cell, sizeof cell, " %s (%s), %.0f %% |", seconds_text(row.quantile(0.5)).c_str(),
                    seconds_text(row.law_median_s).c_str(), 100 * row.share_by(kPaperEnd_s));
      lines[row.point.*varied] += cell;
      if (start != 0 && row.point.sigma < 1) farthest = std::max(farthest, row.distance);
    }
  }
  std::printf("| %s |", title);
  for (const int start : kOneOfEach) std::printf(" %s |", starts()[start].set.c_str());
  std::printf("\n|---|---|---|---|---|\n");
  for (const auto& [value, cells] : lines) std::printf("| %g |%s\n", value, cells.c_str());
  std::printf("\nLargest distance for σ < 1, without the origin: %.3f\n\n", farthest);
}

/// γ along the path, and what it makes of a noise of σ = 1.
void print_growth(double exponent) {
  std::printf("| set | γ at 0 s | 5 s | 20 s | 80 s | 150 s [1/s] | spread at 150 s [m] | past neglected [m] |\n"
              "|---|---|---|---|---|---|---|---|\n");
  for (int start = 0; start < static_cast<int>(starts().size()); ++start) {
    const Mission mission = mission_of({start, exponent, kPaperEpsilon, 1});
    const auto steps = linearised(mission, std::lround(kPaperEnd_s / mission.timing.dt_s) + 1);
    std::printf("| %s |", starts()[start].set.c_str());
    for (const double t_s : {0.0, 5.0, 20.0, 80.0, kPaperEnd_s}) {
      std::printf(" %.3f |", steps[static_cast<std::size_t>(std::lround(t_s / mission.timing.dt_s))].rate_per_s);
    }
    std::printf(" %.3g | %.3g |\n", spread(steps, mission, Past::kCounted).back(),
                spread(steps, mission, Past::kNeglected).back());
  }
  std::printf("\n");
}

/// How far off the agents of Fig. 2(a) are from the sets that they start on, at its end: from the origin,
/// the two edges, and the diagonal that the last one runs down.
void write_fig2a(int seeds, std::ostream& out) {
  out << "origin_m,lower_edge_m,left_edge_m,diagonal_m\n";
  Mission mission = paper_mission();
  for (int seed = 1; seed <= seeds; ++seed) {
    mission.seed = static_cast<std::uint64_t>(seed);
    lab::IdealTeam team(mission);
    team.run_until(kPaperEnd_s);
    out << team.x_m(0).norm() << ',' << team.x_m(1).y() << ',' << team.x_m(2).x() << ','
        << std::abs(team.x_m(3).x() - team.x_m(3).y()) / std::sqrt(2.0) << '\n';
  }
}

void print_fig2a(const Table& table) {
  constexpr std::pair<const char*, const char*> kAgents[] = {{"(0, 0), from the origin", "origin_m"},
                                                             {"(2000, 0), from the lower edge", "lower_edge_m"},
                                                             {"(0, 2000), from the left edge", "left_edge_m"},
                                                             {"(2000, 2000), from the diagonal", "diagonal_m"}};
  const double escaped_m = lab::escape_distance_m(paper_mission().domain);
  std::printf("## Fig. 2(a) at 150 s\n\n| agent from | least [m] | median | most | within 20 m |\n|---|---|---|---|---|\n");
  for (const auto& [text, column] : kAgents) {
    std::vector<double> off_m = table.at(column);
    std::sort(off_m.begin(), off_m.end());
    const auto near = std::upper_bound(off_m.begin(), off_m.end(), escaped_m) - off_m.begin();
    std::printf("| %s | %.2g | %.3g | %.3g | %.1f %% |\n", text, off_m.front(), off_m[off_m.size() / 2], off_m.back(),
                100 * static_cast<double>(near) / static_cast<double>(off_m.size()));
  }
  std::printf("\n");
}

// ---- figures -------------------------------------------------------------------------------------

std::string color_of(int start) {
  const auto* at = std::find(std::begin(kOneOfEach), std::end(kOneOfEach), start);
  return agent_color(static_cast<AgentId>(at - std::begin(kOneOfEach)));
}

std::vector<KeyEntry> key_of_sets() {
  std::vector<KeyEntry> key;
  for (const int start : kOneOfEach) key.push_back({starts()[start].set, color_of(start)});
  return key;
}

bool one_of_each(int start) {
  return std::find(std::begin(kOneOfEach), std::end(kOneOfEach), start) != std::end(kOneOfEach);
}

std::string weight_text(double exponent) {
  return exponent == 1 ? "λ = 1/(1 + m² + n²)" : "λ = (1 + m² + n²)^(−3/2)";
}

/// Median times against what is varied: dots with 10 % to 90 % measured, solid the law, dashed the
/// law without the past.
Panel panel_of(const std::vector<Row>& rows, double exponent, Axis x, Axis y, double Point::*varied) {
  Panel panel{weight_text(exponent), std::move(x), std::move(y), {}, {}};
  for (const int start : kOneOfEach) {
    Curve law{color_of(start), {}, "none"}, without{color_of(start), {}, "5 4"};
    for (const Row& row : rows) {
      if (row.point.start != start || row.point.exponent != exponent) continue;
      const double at = row.point.*varied;
      if (std::isfinite(row.law_median_s)) law.points.push_back({at, row.law_median_s});
      if (std::isfinite(row.without_past_s)) without.points.push_back({at, row.without_past_s});
      if (!std::isfinite(row.quantile(0.5))) continue;
      panel.intervals.push_back({color_of(start), at, row.quantile(0.1), row.quantile(0.5),
                                 std::min(kUntil_s, row.quantile(0.9))});
    }
    panel.curves.push_back(std::move(law));
    if (starts()[start].name == "midline-x" || starts()[start].name == "diagonal") {
      panel.curves.push_back(std::move(without));
    }
  }
  return panel;
}

std::vector<KeyEntry> key_of_medians() {
  std::vector<KeyEntry> key = key_of_sets();
  key.push_back({"measured: median, 10 to 90 %", "#333333", "none", true});
  key.push_back({"predicted median", "#333333"});
  key.push_back({"the same, past neglected", "#333333", "5 4"});
  return key;
}

void draw_medians(const std::vector<Row>& by_sigma, const std::vector<Row>& by_epsilon, const fs::path& images) {
  std::vector<Panel> noise, smoothing;
  for (const double exponent : kExponents) {
    noise.push_back(panel_of(by_sigma, exponent, log_axis("σ [m/√s]", 5e-9, 20),
                             range_axis("time of escape", "s", 0, kUntil_s), &Point::sigma));
    smoothing.push_back(panel_of(by_epsilon, exponent, log_axis("ε [1/m]", 5e-6, 2e-2),
                                 log_axis("time of escape [s]", 0.5, kUntil_s), &Point::epsilon));
  }
  write_figure(images / "theorem_1_noise.svg",
               figure("theorem-1-noise", "Time of escape against the noise", key_of_medians(), noise));
  write_figure(images / "theorem_1_epsilon.svg",
               figure("theorem-1-epsilon", "Time of escape against epsilon", key_of_medians(), smoothing));
}

/// Shares escaped over time, measured and by the law.
Panel distributions(const std::vector<Row>& rows, const std::vector<Spreads>& spreads, int start) {
  const bool midline = starts()[start].name == "midline-x";
  Panel panel{starts()[start].set, range_axis("time", "s", 0, midline ? 300 : 200),
              range_axis("share escaped", "", 0, 1), {}, {}};
  int color = 0;
  for (const double sigma : {1e-8, 1e-5, 1e-2, 1.0}) {
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const Point& p = rows[i].point;
      if (p.start != start || p.sigma != sigma || p.exponent != 1) continue;
      Curve measured{agent_color(color), {}, "none"}, law{"#333333", {}, "4 4"};
      const EscapeLaw predicted(spreads[i].counted, mission_of(p), far_m(p));
      for (double t_s = 0; t_s <= panel.x.high; t_s += 0.5) {
        measured.points.push_back({t_s, rows[i].share_by(t_s)});
        law.points.push_back({t_s, predicted.probability(t_s)});
      }
      panel.curves.push_back(std::move(measured));
      panel.curves.push_back(std::move(law));
    }
    ++color;
  }
  return panel;
}

void draw_distributions(const std::vector<Row>& rows, const std::vector<Spreads>& spreads, const fs::path& images) {
  const std::vector<KeyEntry> key = {{"σ = 1e-8 m/√s", agent_color(0)}, {"σ = 1e-5", agent_color(1)},
                                     {"σ = 0.01", agent_color(2)},      {"σ = 1", agent_color(3)},
                                     {"predicted", "#333333", "4 4"}};
  write_figure(images / "theorem_1_distribution.svg",
               figure("theorem-1-distribution", "Share of seeds escaped over time", key,
                      {distributions(rows, spreads, 1), distributions(rows, spreads, 3)}));
}

/// Left, how the spread grows; right, that the measured medians lie where it reaches the distance.
void draw_growth(const std::vector<Row>& rows, const std::vector<Spreads>& spreads, const fs::path& images) {
  Panel growth{"Spread of the linearised recursion for σ = 1 m/√s", range_axis("time", "s", 0, 300),
               log_axis("standard deviation [m]", 0.1, 1e12), {}, {}};
  Panel collapse{"One dot for each set and σ: on the line if the law is exact",
                 log_axis("predicted spread at the measured median time, σ = 1 m/√s [m]", 1, 1e11),
                 log_axis("spread that escape takes: 20 m / (0.674 σ)", 1, 1e11), {}, {}};
  collapse.curves.push_back({"#333333", {{1, 1}, {1e11, 1e11}}, "none"});
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Point& p = rows[i].point;
    if (p.exponent != 1 || !one_of_each(p.start)) continue;
    const double dt_s = mission_of(p).timing.dt_s;
    if (p.sigma == kPaperSigma) {
      Curve counted{color_of(p.start), {}, "none"}, neglected{color_of(p.start), {}, "5 4"};
      for (std::size_t j = 1; j < spreads[i].counted.size(); j += 5) {
        const double t_s = static_cast<double>(j) * dt_s;
        counted.points.push_back({t_s, spreads[i].counted[j]});
        neglected.points.push_back({t_s, spreads[i].neglected[j]});
      }
      growth.curves.push_back(std::move(counted));
      growth.curves.push_back(std::move(neglected));
    }
    const double median_s = rows[i].quantile(0.5);
    if (!std::isfinite(median_s) || starts()[p.start].name == "corner") continue;
    const double reached = spreads[i].counted[static_cast<std::size_t>(std::lround(median_s / dt_s))];
    const double needed = far_m(p) / (kMedianOfNormal * p.sigma);
    collapse.intervals.push_back({color_of(p.start), reached, needed, needed, needed});
  }
  std::vector<KeyEntry> key = key_of_sets();
  key.push_back({"past neglected", "#333333", "5 4"});
  write_figure(images / "theorem_1_growth.svg",
               figure("theorem-1-growth", "Growth of a deviation", key, {growth, collapse}));
}

}  // namespace

Mission paper_mission() {
  const auto loaded = Scenario::load(fs::path(ERGOCAST_SCENARIO_DIR) / "paper_fig2a.textproto");
  ERGOCAST_REQUIRE(std::holds_alternative<Scenario>(loaded));
  return std::get<Scenario>(loaded).mission();
}

std::vector<Part> theorem1_parts(int seeds) {
  std::vector<Part> parts;
  for (const Point& p : all_points()) {
    parts.push_back({name_of(p), [p, seeds](std::ostream& out) {
      out << "escape_s\n";
      for (const double t_s : escape_times_s(mission_of(p), seeds, far_m(p), kUntil_s)) out << t_s << '\n';
    }});
  }
  parts.push_back({"fig2a", [seeds](std::ostream& out) { write_fig2a(seeds, out); }});
  return parts;
}

void report_theorem1(const fs::path& folder, const fs::path& images) {
  std::vector<Row> by_sigma, by_epsilon, near;
  std::vector<Spreads> spreads_by_sigma;
  Spreads spreads;
  Point last{-1, 0, 0, 0};
  for (const Point& p : all_points()) {
    // σ only scales the spread, so one does for all of a set's.
    if (p.start != last.start || p.exponent != last.exponent || p.epsilon != last.epsilon) spreads = spreads_of(p);
    last = p;
    const Row row = row_of(p, spreads, folder);
    if (p.near) {
      near.push_back(row);
      continue;
    }
    if (p.sigma == kPaperSigma && one_of_each(p.start)) by_epsilon.push_back(row);
    if (p.epsilon != kPaperEpsilon) continue;
    by_sigma.push_back(row);
    spreads_by_sigma.push_back(spreads);
  }
  std::sort(by_epsilon.begin(), by_epsilon.end(), [](const Row& a, const Row& b) {
    return std::pair(a.point.start, a.point.epsilon) < std::pair(b.point.start, b.point.epsilon);
  });
  for (const double exponent : kExponents) {
    std::printf("## %s, %zu seeds\n\n### Growth\n\n", weight_text(exponent).c_str(), by_sigma.front().times_s.size());
    print_growth(exponent);
    std::printf("### Escape at σ = 1e-5 m/√s\n\n");
    print_sets(by_sigma, exponent);
    std::printf("### The same, farther off than %g m\n\n", kNear_m);
    print_sets(near, exponent);
    std::printf("### Escape by σ\n\n");
    print_varied(by_sigma, exponent, "σ [m/√s]", &Point::sigma);
    std::printf("### Escape by ε\n\n");
    print_varied(by_epsilon, exponent, "ε [1/m]", &Point::epsilon);
  }
  print_fig2a(read_table(folder / "fig2a.csv"));
  draw_medians(by_sigma, by_epsilon, images);
  draw_distributions(by_sigma, spreads_by_sigma, images);
  draw_growth(by_sigma, spreads_by_sigma, images);
}

}  // namespace ergocast::studies
