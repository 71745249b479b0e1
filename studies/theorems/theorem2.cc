// SPDX-License-Identifier: BSD-3-Clause
// Theorem 2: mean square distances from the centre of contraction against the bound.
#include <cmath>
#include <cstdio>

#include "studies/curves.h"
#include "studies/table.h"
#include "studies/theorems/bounds.h"
#include "studies/theorems/theorems.h"

namespace ergocast::studies {
namespace {

namespace fs = std::filesystem;
using lab::Edges;

constexpr int kPoints = 60;
constexpr int kRunsPerSeed = 10;  // means of squares need more runs than times do

struct Case {
  std::string name, text;
  Mission mission;
  Edges edges;
};

/// The paper's square and target with a stronger contraction, from its centre.
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
  return {
      {"paper", "Fig. 2(a) as printed, edges reflect", paper_mission(), Edges::kReflect},
      {"paper-free", "Fig. 2(a) as printed, no edges", paper_mission(), Edges::kNone},
      {"loud", "paper's target about (1000, 1000), k = 0.05, σ = 200, edges reflect",
       strong(0.05, 200), Edges::kReflect},
      {"loud-free", "paper's target about (1000, 1000), k = 0.05, σ = 200, no edges",
       strong(0.05, 200), Edges::kNone},
      {"outward-loud", "u outward, k = 0.05, σ = 100", outward(0.05, 100, 0.1, 150), Edges::kNone},
      {"outward-quiet", "u outward, k = 0.05, σ = 1", outward(0.05, 1, 0.1, 150), Edges::kNone},
      {"outward-one", "u outward, k·dt = 1, σ = 3", outward(10, 3, 0.1, 15), Edges::kNone}};
}

std::string name_of(const Case& c) { return "square-" + c.name; }

void write_case(const Case& c, int seeds, std::ostream& out) {
  out << "runs,agent,t_s,mean_m2,standard_error_m2,bound_m2\n";
  const auto squares = mean_squares(c.mission, c.edges, kRunsPerSeed * seeds, kPoints);
  for (std::size_t i = 0; i < squares.size(); ++i) {
    for (const MeanSquare& at : squares[i]) {
      out << kRunsPerSeed * seeds << ',' << i << ',' << at.t_s << ',' << at.mean_m2 << ','
          << at.standard_error_m2 << ',' << mean_square_bound_m2(c.mission, i) << '\n';
    }
  }
}

/// The row where the measured mean is nearest to its bound.
std::size_t nearest(const Table& table) {
  std::size_t best = 0;
  const auto share = [&table](std::size_t i) {
    return table.at("mean_m2")[i] / table.at("bound_m2")[i];
  };
  for (std::size_t i = 1; i < table.at("mean_m2").size(); ++i) {
    if (share(i) > share(best)) best = i;
  }
  return best;
}

/// The last row of the same agent.
std::size_t last(const Table& table) {
  const double agent = table.at("agent")[nearest(table)];
  std::size_t row = table.at("agent").size() - 1;
  while (table.at("agent")[row] != agent) --row;
  return row;
}

void print(const Case& c, const Table& table) {
  const std::size_t near = nearest(table), end = last(table);
  const double bound_m2 = table.at("bound_m2")[end], mean_m2 = table.at("mean_m2")[end];
  std::printf("| %s | %.0f | %.5g | %.4f | %.5g | %.4f ± %.4f |\n", c.text.c_str(),
              table.at("runs")[end], bound_m2, table.at("mean_m2")[near] / bound_m2, mean_m2,
              mean_m2 / bound_m2, 1.96 * table.at("standard_error_m2")[end] / bound_m2);
}

/// The agent that is nearest to the bound, over the case's own duration.
void add_curve(const Case& c, const Table& table, std::vector<CurvePoint>& curves) {
  const double agent = table.at("agent")[nearest(table)], end_s = table.at("t_s").back();
  for (std::size_t i = 0; i < table.at("t_s").size(); ++i) {
    if (table.at("agent")[i] != agent) continue;
    curves.emplace_back("", c.text, c.edges == Edges::kReflect ? "edges reflect" : "no edges",
                        table.at("t_s")[i] / end_s,
                        table.at("mean_m2")[i] / table.at("bound_m2")[i]);
  }
}

}  // namespace

std::vector<Part> theorem2_parts(int seeds) {
  std::vector<Part> parts;
  for (const Case& c : cases()) {
    parts.push_back({name_of(c), [c, seeds](std::ostream& out) { write_case(c, seeds, out); }});
  }
  parts.push_back({"outside", [seeds](std::ostream& out) {
                     out << "agent,start_x_m,start_y_m,share\n";
                     const Mission mission = paper_mission();
                     const std::vector<double> shares = shares_outside(mission, seeds);
                     for (std::size_t i = 0; i < shares.size(); ++i) {
                       out << i << ',' << mission.starts_m[i].x() << ',' << mission.starts_m[i].y()
                           << ',' << shares[i] << '\n';
                     }
                   }});
  return parts;
}

void report_theorem2(const fs::path& folder, const fs::path& folder_of_curves) {
  std::printf(
      "### Mean squares\n\n"
      "| case | runs | bound [m²] | largest share of it | mean at the end [m²] | share of the "
      "bound (95 %%) |\n"
      "|---|---|---|---|---|---|\n");
  std::vector<CurvePoint> curves;
  for (const Case& c : cases()) {
    const Table table = read_table(folder / (name_of(c) + ".csv"));
    print(c, table);
    add_curve(c, table, curves);
  }
  std::printf(
      "\n### Fig. 2(a) without edges\n\n| start [m] | outside the domain at 150 s |\n|---|---|\n");
  const Table outside = read_table(folder / "outside.csv");
  for (std::size_t i = 0; i < outside.at("agent").size(); ++i) {
    std::printf("| (%g, %g) | %.1f %% |\n", outside.at("start_x_m")[i], outside.at("start_y_m")[i],
                100 * outside.at("share")[i]);
  }
  std::printf("\n");
  write_curves(folder_of_curves / "theorem_2_mean_square.csv", curves);
}

}  // namespace ergocast::studies
