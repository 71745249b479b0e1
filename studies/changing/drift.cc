// SPDX-License-Identifier: BSD-3-Clause
// Peaks that drift round the centre. The target is renewed every two seconds.
#include <cstdio>
#include <string>
#include <vector>

#include "core/mission/amendments.h"
#include "lab/ideal_team.h"
#include "studies/changing/changing.h"
#include "studies/changing/judge.h"
#include "studies/changing/missions.h"

namespace ergocast::studies {
namespace {

constexpr Tick kRenewal = 20, kWindow = 1000, kFirstWindow = 3000, kEnd = 20'000;
constexpr double kSpeeds_mps[] = {1, 3, 10};

/// How a team remembers.
struct Memory {
  const char* name;
  const char* law;
};
constexpr Memory kMemories[] = {{"for ever", ""}, {"half-life 100 s", "memory_half_life_s: 100"}};

/// The targets of a whole mission, one for each renewal.
std::vector<Coefficients> drifting_targets(double speed_mps) {
  std::vector<Coefficients> targets;
  for (Tick tick = 0; tick < kEnd; tick += kRenewal)
    targets.push_back(
        target_turned_by(speed_mps * static_cast<double>(tick) * 0.1 / kPeakRadius_m));
  return targets;
}

/// φ² of a window, in the mean of all windows of a mission.
double mean_metric(const std::vector<Coefficients>& targets, const Memory& memory,
                   std::uint64_t seed) {
  const Mission mission =
      mission_of({.agents = 16, .duration_s = 2100, .law = memory.law}, Peaks::kCorners, seed);
  lab::IdealTeam team(mission);
  Judge judge(mission);
  Amendments list;
  double sum = 0;
  while (team.tick() < kEnd) {
    const Tick tick = team.tick();
    const Coefficients& target = targets[static_cast<std::size_t>(tick / kRenewal)];
    if (tick % kRenewal == 0) {
      name_target(list, tick, {.target = target, .cosine = {}});
      team.note(list);
    }
    if (tick % kWindow == 0 && tick > kFirstWindow) sum += judge.metric();
    if (tick % kWindow == 0) judge.begin();
    for (std::size_t i = 0; i < team.size(); ++i) judge.see(team.x_m(i), target);
    team.step();
  }
  constexpr Tick kWindows = (kEnd - kFirstWindow) / kWindow;
  return (sum + judge.metric()) / static_cast<double>(kWindows);
}

}  // namespace

void study_drifts(int seeds, Results& results) {
  std::printf("| peaks drift at | the team remembers | φ² of a window of 100 s |\n|---|---|---|\n");
  for (const double speed_mps : kSpeeds_mps) {
    const std::vector<Coefficients> targets = drifting_targets(speed_mps);
    char name[40];
    std::snprintf(name, sizeof name, "%g m/s", speed_mps);
    for (const Memory& memory : kMemories) {
      const CaseName one(std::string(name) + ", " + memory.name, "window of 100 s");
      for (int seed = 1; seed <= seeds; ++seed)
        results.add(one, mean_metric(targets, memory, static_cast<std::uint64_t>(seed)));
      std::printf("| %s | %s | %s |\n", name, memory.name, to_string(results.mean(one)).c_str());
      std::fflush(stdout);
    }
  }
}

}  // namespace ergocast::studies
