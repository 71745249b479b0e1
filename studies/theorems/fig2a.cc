// SPDX-License-Identifier: BSD-3-Clause
// Fig. 2(a): how far its agents are from their sets at its end.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "lab/ideal_team.h"
#include "lab/manifolds.h"
#include "studies/table.h"
#include "studies/theorems/theorems.h"

namespace ergocast::studies {
namespace {

constexpr double kEnd_s = 150;

/// How far off the agents of Fig. 2(a) are from the sets that they start on, at its end: from the
/// origin, the two edges, and the diagonal that the last one runs down.
void write_ends(int seeds, std::ostream& out) {
  out << "origin_m,lower_edge_m,left_edge_m,diagonal_m\n";
  Mission mission = paper_mission();
  for (int seed = 1; seed <= seeds; ++seed) {
    mission.seed = static_cast<std::uint64_t>(seed);
    lab::IdealTeam team(mission);
    team.run_until(kEnd_s);
    out << team.x_m(0).norm() << ',' << team.x_m(1).y() << ',' << team.x_m(2).x() << ','
        << std::abs(team.x_m(3).x() - team.x_m(3).y()) / std::sqrt(2.0) << '\n';
  }
}

}  // namespace

std::vector<Part> fig2a_parts(int seeds) {
  return {{"fig2a", [seeds](std::ostream& out) { write_ends(seeds, out); }}};
}

void report_fig2a(const std::filesystem::path& folder) {
  const Table table = read_table(folder / "fig2a.csv");
  constexpr std::pair<const char*, const char*> kAgents[] = {
      {"(0, 0), from the origin", "origin_m"},
      {"(2000, 0), from the lower edge", "lower_edge_m"},
      {"(0, 2000), from the left edge", "left_edge_m"},
      {"(2000, 2000), from the diagonal", "diagonal_m"}};
  const double escaped_m = lab::escape_distance_m(paper_mission().domain);
  std::printf(
      "## Fig. 2(a) at 150 s\n\n| agent from | least [m] | median | most | within 20 m "
      "|\n|---|---|---|---|---|\n");
  for (const auto& [text, column] : kAgents) {
    std::vector<double> off_m = table.at(column);
    std::sort(off_m.begin(), off_m.end());
    const auto near = std::upper_bound(off_m.begin(), off_m.end(), escaped_m) - off_m.begin();
    std::printf("| %s | %.2g | %.3g | %.3g | %.1f %% |\n", text, off_m.front(),
                off_m[off_m.size() / 2], off_m.back(),
                100 * static_cast<double>(near) / static_cast<double>(off_m.size()));
  }
  std::printf("\n");
}

}  // namespace ergocast::studies
