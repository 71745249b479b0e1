// SPDX-License-Identifier: BSD-3-Clause
// Peaks that jump once: the team of this code, a fresh team, and a team with law.history KEEP.
#include <cstdio>
#include <string>

#include "core/mission/amendments.h"
#include "lab/ideal_team.h"
#include "studies/changing/changing.h"
#include "studies/changing/judge.h"
#include "studies/changing/missions.h"

namespace ergocast::studies {
namespace {

constexpr Tick kJump = 3000;  // after 300 s
/// Plans end later, so that no team ends with its plan.
constexpr double kPlan_s = 2000;

const char* const kHistories[] = {"BY_TIME", "fresh", "KEEP"};

struct Jump {
  const char* name;
  Peaks to;
};
constexpr Jump kJumps[] = {{"one peak", Peaks::kOneInside}, {"all peaks", Peaks::kTurned}};

Amendments jump_to(const Coefficients& target) {
  Amendments list;
  name_target(list, kJump, {.target = target, .cosine = {}});
  return list;
}

/// Measures a team from its present tick on.
void measure(lab::IdealTeam& team, const Coefficients& target, const std::string& name,
             const std::string& history, Results& results) {
  Judge judge(team.mission());
  const Tick from = team.tick();
  for (const int at_s : kMeasured_s) {
    while (team.tick() < from + 10 * at_s) {
      for (std::size_t i = 0; i < team.size(); ++i) judge.see(team.x_m(i), target);
      team.step();
    }
    results.add({name, history + ' ' + measured_at(at_s)}, judge.metric());
  }
}

void run_jump(int agents, const Jump& jump, std::uint64_t seed, Results& results) {
  const MissionOptions options{.agents = agents, .duration_s = kPlan_s};
  const Mission mission = mission_of(options, Peaks::kCorners, seed);
  Mission after = mission_of(options, jump.to, seed);
  const Coefficients target = after.target_coefficients;
  const std::string name = std::to_string(agents) + " agents: " + jump.name;

  Mission kept = mission;
  kept.law.history = TargetHistory::kKeep;

  lab::IdealTeam team(mission), all_time(kept);
  while (team.tick() < kJump) {
    team.step();
    all_time.step();
  }
  for (std::size_t i = 0; i < team.size(); ++i) after.starts_m[i] = team.x_m(i);
  lab::IdealTeam fresh(after);
  team.note(jump_to(target));
  all_time.note(jump_to(target));
  measure(team, target, name, kHistories[0], results);
  measure(fresh, target, name, kHistories[1], results);
  measure(all_time, target, name, kHistories[2], results);
}

void print(const Results& results) {
  std::printf("| agents, what jumps | history |");
  for (const int at_s : kMeasured_s) std::printf(" φ² after %d s |", at_s);
  std::printf("\n|---|---|---|---|---|\n");
  for (const int agents : {4, 16}) {
    for (const Jump& jump : kJumps) {
      const std::string name = std::to_string(agents) + " agents: " + jump.name;
      for (const std::string history : kHistories) {
        std::printf("| %s | %s |", name.c_str(), history.c_str());
        for (const int at_s : kMeasured_s) {
          const CaseName one(name, history + ' ' + measured_at(at_s));
          std::printf(" %s |", to_string(results.mean(one)).c_str());
        }
        std::printf("\n");
      }
    }
  }
}

}  // namespace

void study_jumps(int seeds, Results& results) {
  for (const int agents : {4, 16}) {
    for (const Jump& jump : kJumps) {
      for (int seed = 1; seed <= seeds; ++seed)
        run_jump(agents, jump, static_cast<std::uint64_t>(seed), results);
    }
  }
  print(results);
}

}  // namespace ergocast::studies
