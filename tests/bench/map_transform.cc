// SPDX-License-Identifier: BSD-3-Clause
// Times the transform of a map against its size. The lower bound is reading as many doubles from
// memory once.
#include <benchmark/benchmark.h>

#include <vector>

#include "target/raster_integral.h"

namespace ergocast::bench {
namespace {

constexpr int kRowsHeld = 64;  // repeated, so that the largest map need not fit in memory

std::vector<double> some_rows(int columns) {
  std::vector<double> values(static_cast<std::size_t>(columns) * kRowsHeld);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<double>(1 + i % 251);
  return values;
}

std::span<const double> row_of(const std::vector<double>& rows, int columns, int row) {
  return std::span(rows).subspan(static_cast<std::size_t>(row % kRowsHeld) * columns, columns);
}

void report(benchmark::State& state, int side) {
  state.counters["cells_per_s"] = benchmark::Counter(static_cast<double>(side) * side,
                                                     benchmark::Counter::kIsIterationInvariantRate);
}

/// A square map of range(0)² cells into range(1)² modes.
void MapTransform(benchmark::State& state) {
  const int side = static_cast<int>(state.range(0)), modes = static_cast<int>(state.range(1));
  const std::vector<double> rows = some_rows(side);
  const Rectangle domain{{0, 0}, {1000, 1000}};
  Basis basis;
  basis.modes_x = basis.modes_y = modes;
  for (auto _ : state) {
    RasterIntegral integral({domain, side, side}, domain.size_m, basis,
                            free_area(domain.size_m, {}));
    for (int row = 0; row < side; ++row) integral.add_row(row, row_of(rows, side, row));
    benchmark::DoNotOptimize(integral.shares());
  }
  report(state, side);
}

/// range(0)² doubles from memory, added up once in eight sums.
void MemoryFloor(benchmark::State& state) {
  const int side = static_cast<int>(state.range(0));
  const std::vector<double> map(static_cast<std::size_t>(side) * side, 1.0);
  for (auto _ : state) {
    double sums[8] = {};
    for (std::size_t i = 0; i < map.size(); i += 8) {
      for (std::size_t k = 0; k < 8; ++k) sums[k] += map[i + k];
    }
    benchmark::DoNotOptimize(sums);
  }
  report(state, side);
}

BENCHMARK(MapTransform)
    ->ArgNames({"side", "modes"})
    ->Args({256, 16})
    ->Args({1024, 16})
    ->Args({4096, 16})
    ->Args({8192, 16})
    ->Args({8192, 64})
    ->Unit(benchmark::kMillisecond);
BENCHMARK(MemoryFloor)
    ->ArgName("side")
    ->Arg(256)
    ->Arg(1024)
    ->Arg(4096)
    ->Arg(8192)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace ergocast::bench

BENCHMARK_MAIN();
