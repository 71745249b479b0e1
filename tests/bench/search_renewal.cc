// SPDX-License-Identifier: BSD-3-Clause
// Times what a searching agent does each second: it adds up what is left, and solves for the
// potential on 64 × 64 cells.
#include <benchmark/benchmark.h>

#include <Eigen/SparseCholesky>
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

/// As much as counts, in every cell.
void report_most(Efforts& efforts, const Author& author) {
  const auto cells = static_cast<std::int32_t>(efforts.cells().cells.total());
  for (Tick tick = 0; tick < cells * Tick{kMaxReports}; ++tick)
    efforts.report(author, tick, static_cast<std::int32_t>(tick % cells));
}

/// false_alarms: 0, none; 1, some; 2, the most that count, everywhere.
void Renewal(benchmark::State& state) {
  const Mission mission = mission_with(state.range(1) != 0);
  Searcher law(mission);
  Efforts efforts(mission);
  std::vector<AgentId> team;
  std::vector<TeamPlace> places;
  for (AgentId id = 0; id < state.range(0); ++id) {
    efforts.add_row({id, 1});
    if (state.range(1) == 2) report_most(efforts, {id, 1});
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
/// The same sums and the same solution by bare loops: what is left of each cell, a Gaussian for
/// each teammate, and two passes over the factors of the equation.
void RenewalFloor(benchmark::State& state) {
  constexpr int kSide = 64, kCells = kSide * kSide;
  const double exchange = std::pow(3.2 * 31 / (2000.0 / kSide), 2);
  std::vector<Eigen::Triplet<double>> entries;
  for (int cell = 0; cell < kCells; ++cell) {
    entries.emplace_back(cell, cell, 1);
    for (const int step : {1, kSide}) {
      if (step == 1 ? cell % kSide == kSide - 1 : cell + kSide >= kCells) continue;
      for (const int end : {cell, cell + step}) entries.emplace_back(end, end, exchange);
      entries.emplace_back(cell, cell + step, -exchange);
      entries.emplace_back(cell + step, cell, -exchange);
    }
  }
  Eigen::SparseMatrix<double> equation(kCells, kCells);
  equation.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors(equation);
  Eigen::SparseMatrix<double> lower = factors.matrixL();
  lower.prune([](int row, int column, double) { return row > column; });
  const Eigen::VectorXd diagonal = factors.vectorD();
  const double* value = lower.valuePtr();
  const int *index = lower.innerIndexPtr(), *first = lower.outerIndexPtr();
  const std::vector<double> efforts(kCells, 0.5), along(kSide, 0.1);
  Eigen::VectorXd u(kCells);
  for (auto _ : state) {
    for (int cell = 0; cell < kCells; ++cell)
      u[cell] = -std::exp(-efforts[static_cast<std::size_t>(cell)]);
    for (int mate = 1; mate < state.range(0); ++mate) {
      benchmark::DoNotOptimize(along.data());
      for (int i = 0; i < kSide; ++i)
        for (int j = 0; j < kSide; ++j)
          u[i * kSide + j] +=
              along[static_cast<std::size_t>(i)] * along[static_cast<std::size_t>(j)];
    }
    for (int i = 0; i < kCells; ++i)
      for (int at = first[i]; at < first[i + 1]; ++at) u[index[at]] -= value[at] * u[i];
    for (int i = kCells - 1; i >= 0; --i) {
      u[i] /= diagonal[i];
      for (int at = first[i]; at < first[i + 1]; ++at) u[i] -= value[at] * u[index[at]];
    }
    benchmark::DoNotOptimize(u.data());
    benchmark::ClobberMemory();
  }
  state.counters["factors"] = static_cast<double>(lower.nonZeros());
}
BENCHMARK(RenewalFloor)->ArgName("agents")->Arg(4)->Arg(16)->Arg(64)->Unit(benchmark::kMicrosecond);

/// Each agent has reported as much as counts in every cell.
void MostReports(benchmark::State& state) {
  const Mission mission = mission_with(true);
  Efforts efforts(mission);
  const auto cells = static_cast<std::int32_t>(efforts.cells().cells.total());
  for (AgentId id = 0; id < state.range(0); ++id) {
    efforts.add_row({id, 1});
    report_most(efforts, {id, 1});
  }
  Contacts contacts(mission);
  std::vector<double> prior(efforts.cells().cells.total(), 1.0 / cells);
  for (std::size_t cell = 0; state.range(1) != 0 && cell < prior.size(); ++cell)
    prior[cell] *= 2 * uniform_pair(1, Purpose::kStart, 0, cell).x();
  contacts.set_prior(prior);
  for (auto _ : state) contacts.renew(efforts);
  state.counters["confirmed"] = static_cast<double>(contacts.confirmed_contacts().size());
}
BENCHMARK(MostReports)
    ->ArgNames({"agents", "uneven"})
    ->ArgsProduct({{1, 64}, {0, 1}})
    ->Unit(benchmark::kMicrosecond);

BENCHMARK(Renewal)
    ->ArgNames({"agents", "false_alarms"})
    ->ArgsProduct({{4, 16, 64}, {0, 1, 2}})
    ->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace ergocast::bench

BENCHMARK_MAIN();
