// SPDX-License-Identifier: BSD-3-Clause
// Corollary 1: how runs without noise satisfy its discrete form, and violate the continuous one.
#include <cmath>
#include <cstdio>

#include "studies/table.h"
#include "studies/theorems/bounds.h"
#include "studies/theorems/theorems.h"

namespace ergocast::studies {
namespace {

namespace fs = std::filesystem;
using lab::Edges;

constexpr int kMissionsPerSeed = 5;                       // they are short
constexpr double kSteps[] = {1e-4, 1e-3, 1e-2, 1e-1, 1};  // k·dt

void write_random(Edges edges, int seeds, std::ostream& out) {
  out << "checked,violations,largest_share,allowance_m\n";
  for (int seed = 1; seed <= kMissionsPerSeed * seeds; ++seed) {
    const Contraction found =
        contraction_of(random_mission(static_cast<std::uint64_t>(seed)), edges);
    out << found.checked << ',' << found.violations << ',' << found.largest_share << ','
        << found.allowance_m << '\n';
  }
}

/// An agent driven outward from the centre at speed u_max for three time constants. It reaches the
/// discrete bound.
Contraction worst_case(double k_dt) {
  ControlLaw law;
  law.u_max_mps = 10;
  law.contraction_gain_per_s = k_dt / 0.1;
  return contraction_of(driven_outward(law, 0.1, std::max(1.0, 3 / law.contraction_gain_per_s)),
                        Edges::kNone);
}

void write_worst(std::ostream& out) {
  out << "k_dt,violations,discrete_share,continuous_share\n";
  for (const double k_dt : kSteps) {
    const Contraction found = worst_case(k_dt);
    out << k_dt << ',' << found.violations << ',' << found.largest_share << ','
        << found.largest_continuous_share << '\n';
  }
}

void print_random(const char* edges, const Table& table) {
  double checked = 0, violations = 0, share = 0, allowance_m = 0;
  for (std::size_t i = 0; i < table.at("checked").size(); ++i) {
    checked += table.at("checked")[i];
    violations += table.at("violations")[i];
    share = std::max(share, table.at("largest_share")[i]);
    allowance_m = std::max(allowance_m, table.at("allowance_m")[i]);
  }
  std::printf("| %s | %zu | %.0f | %.0f | 1 %+.1e | %.1g |\n", edges, table.at("checked").size(),
              checked, violations, share - 1, allowance_m);
}

}  // namespace

std::vector<Part> corollary1_parts(int seeds) {
  return {
      {"contraction-reflected",
       [seeds](std::ostream& out) { write_random(Edges::kReflect, seeds, out); }},
      {"contraction-free", [seeds](std::ostream& out) { write_random(Edges::kNone, seeds, out); }},
      {"contraction-worst", write_worst}};
}

void report_corollary1(const fs::path& folder) {
  std::printf(
      "### Random missions without noise\n\n"
      "| edges | missions | agents × steps | violations | largest ‖x − c‖ / bound | largest "
      "allowance [m] |\n"
      "|---|---|---|---|---|---|\n");
  print_random("reflecting", read_table(folder / "contraction-reflected.csv"));
  print_random("none", read_table(folder / "contraction-free.csv"));
  const Table worst = read_table(folder / "contraction-worst.csv");
  std::printf(
      "\n### An agent driven outward from the centre\n\n"
      "| k·dt | ‖x − c‖ / discrete bound | ‖x − c‖ / continuous bound | over it by "
      "|\n|---|---|---|---|\n");
  for (std::size_t i = 0; i < worst.at("k_dt").size(); ++i) {
    const double share = worst.at("continuous_share")[i];
    std::printf("| %g | %.12f | %.6f | %.3f k·dt |\n", worst.at("k_dt")[i],
                worst.at("discrete_share")[i], share, (share - 1) / worst.at("k_dt")[i]);
  }
  std::printf("\n");
}

}  // namespace ergocast::studies
