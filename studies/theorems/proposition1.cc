// SPDX-License-Identifier: BSD-3-Clause
// Proposition 1: how well it holds with rounding, and how fast rounding alone drives agents off.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "lab/manifolds.h"
#include "studies/curves.h"
#include "studies/table.h"
#include "studies/theorems/escape.h"
#include "studies/theorems/invariance.h"
#include "studies/theorems/theorems.h"

namespace ergocast::studies {
namespace {

namespace fs = std::filesystem;

constexpr double kUntil_s = 600;

void write_set(const InvariantSet& set, int seeds, std::ostream& out) {
  out << "units,share_of_b,escape_s\n";
  const Mission paper = paper_mission();
  const int places = set.is_point ? 1 : seeds;
  for (int seed = 1; seed <= places; ++seed) {
    const Mission mission = classical(set, paper, static_cast<std::uint64_t>(seed));
    const NormalResidual residual = normal_residual(mission);
    out << residual.units << ',' << residual.share_of_b << ','
        << escape_time_s(mission, lab::escape_distance_m(mission.domain), kUntil_s)
               .value_or(std::numeric_limits<double>::infinity())
        << '\n';
  }
}

double quantile(std::vector<double> values, double p) {
  std::sort(values.begin(), values.end());
  return values[std::min(values.size() - 1,
                         static_cast<std::size_t>(p * static_cast<double>(values.size())))];
}

std::string seconds_text(double t_s) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f", t_s);
  return std::isfinite(t_s) ? text : "never";
}

double share_by(const std::vector<double>& times_s, double t_s) {
  return static_cast<double>(std::count_if(times_s.begin(), times_s.end(),
                                           [t_s](double t) { return t <= t_s + 1e-9; })) /
         static_cast<double>(times_s.size());
}

void print(const InvariantSet& set, const Table& table) {
  const auto& times_s = table.at("escape_s");
  const auto exact = std::count(table.at("units").begin(), table.at("units").end(), 0.0);
  std::printf("| %s | %zu | %ld | %.2g | %.2g | %.2g | %s | %s | %.1f %% |\n", set.text.c_str(),
              times_s.size(), static_cast<long>(exact), quantile(table.at("units"), 0.5),
              quantile(table.at("units"), 1), quantile(table.at("share_of_b"), 1),
              seconds_text(quantile(times_s, 0)).c_str(),
              seconds_text(quantile(times_s, 0.5)).c_str(), 100 * share_by(times_s, kUntil_s));
}

void add_shares(const InvariantSet& set, const std::vector<double>& times_s,
                std::vector<CurvePoint>& curves) {
  for (int second = 0; second <= kUntil_s; ++second)
    curves.emplace_back("", set.text, "measured", second, share_by(times_s, second));
}

}  // namespace

std::vector<Part> proposition1_parts(int seeds) {
  std::vector<Part> parts;
  for (const InvariantSet& set : invariant_sets()) {
    parts.push_back({"invariant-" + set.name,
                     [&set, seeds](std::ostream& out) { write_set(set, seeds, out); }});
  }
  return parts;
}

void report_proposition1(const fs::path& folder, const fs::path& folder_of_curves) {
  std::printf(
      "### The classical law on the sets of Proposition 1\n\n"
      "| set | places | exactly 0 | median units | largest | largest share of ‖B‖ | first out [s] "
      "| median | out by 600 s |\n"
      "|---|---|---|---|---|---|---|---|---|\n");
  std::vector<CurvePoint> curves;
  for (const InvariantSet& set : invariant_sets()) {
    const Table table = read_table(folder / ("invariant-" + set.name + ".csv"));
    print(set, table);
    const bool drawn = set.symmetric_team && set.name != "origin" && set.name != "far-corner" &&
                       (set.name.ends_with("-x") || set.name.starts_with("diagonal") ||
                        set.name == "midline-pair");
    if (drawn) add_shares(set, table.at("escape_s"), curves);
  }
  std::printf("\n");
  write_curves(folder_of_curves / "theorem_p1_rounding.csv", curves);
}

}  // namespace ergocast::studies
