// SPDX-License-Identifier: BSD-3-Clause
// Times what a searching agent does each second: it adds up what is left, and solves for the
// potential on 64 × 64 cells.
#include <benchmark/benchmark.h>

#include <cmath>
#include <vector>

#include "core/base/noise.h"
#include "core/law/searcher.h"

namespace ergocast::bench {
namespace {

Mission mission_with(bool false_alarms) {
  Mission mission;
  mission.domain.size_m = {2000, 2000, 0};
  mission.basis.modes_x = mission.basis.modes_y = 16;
  mission.target_coefficients = Coefficients::Zero(256);
  mission.target_coefficients[0] = 1;
  mission.target_coefficients[2] = 0.5;
  mission.law.kind = LawKind::kSearch;
  mission.law.u_max_mps = 20;
  mission.timing.dt_s = 0.1;
  mission.sensor.radius_m = 31;  // 64 cells along a side
  mission.sensor.false_alarms_per_s = false_alarms ? 0.01 : 0;
  return mission;
}

void Renewal(benchmark::State& state) {
  const Mission mission = mission_with(state.range(1) != 0);
  Searcher law(mission);
  Efforts efforts(mission);
  std::vector<AgentId> team;
  std::vector<TeamPlace> places;
  for (AgentId id = 0; id < state.range(0); ++id) {
    efforts.add_row({id, 1});
    for (Tick tick = 0; tick < 6000; ++tick) {
      const Eigen::Vector3d x_m(1000 + 900 * std::sin(0.003 * static_cast<double>(tick) + id),
                                1000 + 900 * std::cos(0.0017 * static_cast<double>(tick) + id), 0);
      efforts.look({id, 1}, tick, x_m);
      if (tick % 1000 != 500) continue;
      efforts.report({id, 1}, tick, static_cast<std::int32_t>(efforts.cells().cells.cell_of(x_m)));
    }
    team.push_back(id);
    places.push_back(
        {id, uniform_in(mission.domain, 1, Purpose::kStart, static_cast<std::uint32_t>(id), 0)});
  }
  const Eigen::Vector3d x_m = places.front().x_m;
  const BasisAt at(x_m, mission.domain, mission.basis);
  Tick tick = 6000;
  for (auto _ : state) {
    benchmark::DoNotOptimize(law.wanted_mps({0, tick, x_m, at, team, places, &efforts}));
    tick += std::llround(1 / mission.timing.dt_s);
  }
  state.counters["cells"] = static_cast<double>(efforts.cells().cells.total());
}
BENCHMARK(Renewal)
    ->ArgNames({"agents", "false_alarms"})
    ->ArgsProduct({{4, 16, 64}, {0, 1}})
    ->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace ergocast::bench

BENCHMARK_MAIN();
