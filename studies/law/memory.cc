// SPDX-License-Identifier: BSD-3-Clause
// What forgetting buys a team that watches a constant target for long, for docs/law.md: φ² of what
// the team covers within windows of some minutes, in the second half of the mission, whatever it
// remembers itself.
#include <cmath>
#include <cstdio>
#include <exception>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/basis/basis.h"
#include "lab/ideal_team.h"
#include "report/statistics.h"
#include "scenario/scenario.h"

namespace ergocast::studies {
namespace {

constexpr double kWindow_s = 300;

Mission mission_of(const char* file, const char* agents, const char* half_life_s, int seed) {
  Overrides overrides;
  overrides.seed = static_cast<std::uint64_t>(seed);
  overrides.duration_s = 20000;
  overrides.fields = {{"agents.random_count", agents, "AGENTS"},
                      {"law.memory_half_life_s", half_life_s, "HALF_LIVES"}};
  auto loaded = Scenario::load(file, overrides);
  if (!loaded) throw std::runtime_error(to_string(loaded.error().front()));
  return loaded->mission();
}

/// The geometric mean of φ² over all windows of the second half.
double windowed(const Mission& mission) {
  const double dt_s = mission.timing.dt_s;
  const auto window = static_cast<Tick>(std::lround(kWindow_s / dt_s));
  const Coefficients weights = sobolev_weights(mission.basis, mission.domain);
  lab::IdealTeam team(mission);
  Coefficients sums = Coefficients::Zero(mission.basis.mode_count());
  double logs = 0;
  int windows = 0;
  while (team.tick() < mission.timing.tick_count) {
    if (team.tick() >= mission.timing.tick_count / 2) {
      for (std::size_t i = 0; i < team.size(); ++i)
        accumulate_basis(BasisAt(team.x_m(i), mission.domain, mission.basis), mission.basis, dt_s,
                         sums.data());
    }
    team.step();
    if (team.tick() <= mission.timing.tick_count / 2 || team.tick() % window != 0) continue;
    if (sums[0] > 0.99 * kWindow_s * static_cast<double>(team.size())) {
      logs += std::log(ergodic_metric(sums / sums[0], mission.target_coefficients, weights));
      ++windows;
    }
    sums.setZero();
  }
  return std::exp(logs / windows);
}

void run(const char* file, const char* agents, int seeds, const std::vector<const char*>& lives) {
  std::vector<double> never;
  for (const char* half_life_s : lives) {
    std::vector<double> values;
    for (int seed = 1; seed <= seeds; ++seed)
      values.push_back(windowed(mission_of(file, agents, half_life_s, seed)));
    if (never.empty()) never = values;
    const Estimate mean = ratio_of(values, std::vector<double>(values.size(), 1.0));
    const Estimate ratio = ratio_of(values, never);
    std::printf("| %s | %s | %d | %.2e (%.2e to %.2e) | %.2f (%.2f to %.2f) |\n", agents,
                half_life_s, seeds, mean.value, mean.low, mean.high, ratio.value, ratio.low,
                ratio.high);
    std::fflush(stdout);
  }
}

}  // namespace
}  // namespace ergocast::studies

int main(int argc, char** argv) {
  if (argc < 5) {
    std::fprintf(stderr, "usage: studies-law-memory SCENARIO AGENTS SEEDS HALF_LIFE_S…\n");
    return 2;
  }
  try {
    std::printf(
        "| agents | half-life [s] | seeds | φ² of 300 s, mean (95 %%) | against the first (95 %%) "
        "|\n|---|---|---|---|---|\n");
    ergocast::studies::run(argv[1], argv[2], std::stoi(argv[3]), {argv + 4, argv + argc});
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "studies-law-memory: %s\n", error.what());
    return 2;
  }
}
