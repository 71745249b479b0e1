// Theorem 2: mean square distances from the centre of contraction against the bound.
#include <cmath>
#include <cstdio>

#include "logger/figures.h"
#include "studies/bounds.h"
#include "studies/panels.h"
#include "studies/table.h"
#include "studies/theorems.h"

namespace ergocast::studies {
namespace {

namespace fs = std::filesystem;
using lab::Edges;

constexpr int kPoints = 60;

struct Case {
  std::string name, text;
  Mission mission;
};

/// The paper's square and target with a stronger law about the centre, from there.
Mission strong(double gain_per_s, double sigma) {
  Mission mission = paper_mission();
  mission.law.contraction_gain_per_s = gain_per_s;
  mission.law.contraction_center_m = mission.domain.center_m();
  mission.law.noise_intensity = sigma;
  mission.starts_m = {mission.domain.center_m()};
  return mission;
}

Mission outward(double gain_per_s, double sigma, double dt_s, double duration_s) {
  ControlLaw law;
  law.u_max_mps = 10;
  law.contraction_gain_per_s = gain_per_s;
  law.noise_intensity = sigma;
  return driven_outward(law, dt_s, duration_s);
}

std::vector<Case> cases() {
  return {{"paper", "Fig. 2(a) as printed, worst agent", paper_mission()},
          {"strong", "paper's target, k = 0.05, σ = 30", strong(0.05, 30)},
          {"stronger", "paper's target, k = 0.05, σ = 200", strong(0.05, 200)},
          {"outward-quiet", "u always outward, k = 0.05, σ = 1", outward(0.05, 1, 0.1, 150)},
          {"outward-loud", "u always outward, k = 0.05, σ = 100", outward(0.05, 100, 0.1, 150)},
          {"outward-half", "u always outward, k·dt = 0.5, σ = 3", outward(5, 3, 0.1, 15)},
          {"outward-one", "u always outward, k·dt = 1, σ = 3", outward(10, 3, 0.1, 15)}};
}

constexpr Edges kBoth[] = {Edges::kReflect, Edges::kNone};

std::string name_of(const Case& c, Edges edges) {
  return "square-" + c.name + (edges == Edges::kReflect ? "-reflected" : "-free");
}

void write_case(const Case& c, Edges edges, int seeds, std::ostream& out) {
  out << "agent,t_s,mean_m2,standard_error_m2,bound_m2\n";
  const auto squares = mean_squares(c.mission, edges, seeds, kPoints);
  for (std::size_t i = 0; i < squares.size(); ++i) {
    for (const MeanSquare& at : squares[i]) {
      out << i << ',' << at.t_s << ',' << at.mean_m2 << ',' << at.standard_error_m2 << ','
          << mean_square_bound_m2(c.mission, i) << '\n';
    }
  }
}

/// The row where the measured mean is nearest to its bound.
std::size_t nearest(const Table& table) {
  std::size_t best = 0;
  const auto share = [&table](std::size_t i) { return table.at("mean_m2")[i] / table.at("bound_m2")[i]; };
  for (std::size_t i = 1; i < table.at("mean_m2").size(); ++i) {
    if (share(i) > share(best)) best = i;
  }
  return best;
}

void print(const Case& c, Edges edges, const Table& table) {
  const std::size_t i = nearest(table);
  const double bound_m2 = table.at("bound_m2")[i];
  std::printf("| %s | %s | %.4g | %.4g ± %.2g | %.4f ± %.4f | %g |\n", c.text.c_str(),
              edges == Edges::kReflect ? "reflecting" : "none", std::sqrt(bound_m2), table.at("mean_m2")[i],
              1.96 * table.at("standard_error_m2")[i], table.at("mean_m2")[i] / bound_m2,
              1.96 * table.at("standard_error_m2")[i] / bound_m2, table.at("t_s")[i]);
}

Curve curve_of(const Table& table, const std::string& color, const char* dashes) {
  Curve curve{color, {}, dashes};
  const double agent = table.at("agent")[nearest(table)], end_s = table.at("t_s").back();
  for (std::size_t i = 0; i < table.at("t_s").size(); ++i) {
    if (table.at("agent")[i] != agent) continue;
    curve.points.push_back({table.at("t_s")[i] / end_s, table.at("mean_m2")[i] / table.at("bound_m2")[i]});
  }
  return curve;
}

}  // namespace

std::vector<Part> theorem2_parts(int seeds) {
  std::vector<Part> parts;
  for (const Case& c : cases()) {
    for (const Edges edges : kBoth) {
      parts.push_back({name_of(c, edges),
                       [c, edges, seeds](std::ostream& out) { write_case(c, edges, seeds, out); }});
    }
  }
  return parts;
}

void report_theorem2(const fs::path& folder, const fs::path& images) {
  std::printf("### Mean squares\n\n"
              "| case | edges | √bound [m] | largest mean of ‖x − c‖² [m²] | of the bound | at [s] |\n"
              "|---|---|---|---|---|---|\n");
  Panel panel{"Mean of ‖x − c‖² as a share of the bound", range_axis("time, as a share of the mission's", "", 0, 1),
              range_axis("measured / bound", "", 0, 1.05), {}, {}};
  panel.curves.push_back({"#333333", {{0, 1}, {1, 1}}, "2 3"});
  std::vector<KeyEntry> key;
  for (const Case& c : cases()) {
    const std::string color = agent_color(static_cast<AgentId>(key.size()));
    key.push_back({c.text, color});
    for (const Edges edges : kBoth) {
      const Table table = read_table(folder / (name_of(c, edges) + ".csv"));
      print(c, edges, table);
      panel.curves.push_back(curve_of(table, color, edges == Edges::kReflect ? "none" : "6 4"));
    }
  }
  key.push_back({"no edges", "#333333", "6 4"});
  std::printf("\n");
  write_figure(images / "theorem_2_mean_square.svg",
               figure("theorem-2-mean-square", "Mean squares against their bound", key, {panel}));
}

}  // namespace ergocast::studies
