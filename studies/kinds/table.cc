// SPDX-License-Identifier: BSD-3-Clause
// Teams of several kinds under three laws: the figures of docs/kinds.md. All laws of a team run
// with the same seeds. One judge compares them with the target: φ² of what the true sensors have
// seen.
#include <cstdio>
#include <exception>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/mission/kinds.h"
#include "lab/ideal_team.h"
#include "report/statistics.h"
#include "scenario/rules/footprint_reach.h"
#include "scenario/scenario.h"

namespace ergocast::studies {
namespace {

struct Target {
  const char *name, *text;
};
constexpr Target kTargets[] = {
    {"four Gaussians of 150 m",
     "gaussians { mean_x_m: 500 mean_y_m: 500 sigma_m: 150 } "
     "gaussians { mean_x_m: 1500 mean_y_m: 500 sigma_m: 150 } "
     "gaussians { mean_x_m: 500 mean_y_m: 1500 sigma_m: 150 } "
     "gaussians { mean_x_m: 1500 mean_y_m: 1500 sigma_m: 150 }"},
    {"a wide one and two of 60 m",
     "gaussians { weight: 2 mean_x_m: 1000 mean_y_m: 1000 sigma_m: 300 } "
     "gaussians { weight: 1 mean_x_m: 400 mean_y_m: 1500 sigma_m: 60 } "
     "gaussians { weight: 1 mean_x_m: 1600 mean_y_m: 500 sigma_m: 60 }"},
    {"six of 60 m",
     "gaussians { mean_x_m: 300 mean_y_m: 400 sigma_m: 60 } "
     "gaussians { mean_x_m: 1000 mean_y_m: 250 sigma_m: 60 } "
     "gaussians { mean_x_m: 1700 mean_y_m: 500 sigma_m: 60 } "
     "gaussians { mean_x_m: 400 mean_y_m: 1600 sigma_m: 60 } "
     "gaussians { mean_x_m: 1100 mean_y_m: 1400 sigma_m: 60 } "
     "gaussians { mean_x_m: 1700 mean_y_m: 1700 sigma_m: 60 }"},
};

struct Kind {
  const char* name;
  int count;
  double u_max_mps, sigma_m;
  const char* band;
};
struct Team {
  const char* name;
  std::vector<Kind> kinds;
};
const Team kTeams[] = {
    {"2 fast coarse, 2 slow fine", {{"fast", 2, 20, 150, "to: 6"}, {"slow", 2, 5, 15, "from: 4"}}},
    {"8 fast coarse, 2 slow fine", {{"fast", 8, 20, 150, "to: 6"}, {"slow", 2, 5, 15, "from: 4"}}},
    {"4 alike", {{"alike", 4, 12.5, 82.5, ""}}},
};

enum class Law { kUnaware, kAware, kBands };

/// The mission of a team under a law. Speeds and starts are the same for each law; unaware agents
/// assume that they see points.
Mission mission_of(const Target& target, const Team& team, Law law, std::uint64_t seed) {
  std::string kinds;
  for (const Kind& kind : team.kinds) {
    kinds += std::string("kind { name: \"") + kind.name +
             "\" count: " + std::to_string(kind.count) +
             " u_max_mps: " + std::to_string(kind.u_max_mps);
    if (law != Law::kUnaware) kinds += " footprint_sigma_m: " + std::to_string(kind.sigma_m);
    if (law == Law::kBands) kinds += std::string(" band { ") + kind.band + " }";
    kinds += " } ";
  }
  const std::string text =
      std::string("domain { size_x_m: 2000 size_y_m: 2000 } target { ") + target.text +
      " } law { u_max_mps: 20 } time { dt_s: 0.5 duration_s: 600 } agents { " + kinds + "}";
  auto parsed = Scenario::parse(text, "study", {.seed = seed});
  if (!parsed) throw std::runtime_error(to_string(parsed.error().front()));
  return parsed->mission();
}

struct Outcome {
  double seen, thought;  ///< φ² of what the sensors saw, and of what the team believes
};

Outcome simulated(const Mission& mission, const Mission& truth) {
  const Sensors sensors(truth);
  Coefficients sums = Coefficients::Zero(mission.basis.mode_count());
  double time_s = 0;
  lab::IdealTeam team(mission);
  while (team.tick() < mission.timing.tick_count) {
    for (std::size_t i = 0; i < team.size(); ++i) {
      const int kind = planned_kind(truth, static_cast<AgentId>(i));
      time_s += sensors.of(kind).sample(CosinesAt(team.x_m(i), mission.domain, mission.basis),
                                        mission.basis, mission.timing.dt_s, sums.data());
    }
    team.step();
  }
  const Coefficients weights = sobolev_weights(mission.basis, mission.domain);
  return {ergodic_metric(sums / time_s, mission.target_coefficients, weights), team.metric()};
}

std::string text(const Estimate& estimate) {
  char text[80];
  std::snprintf(text, sizeof text, "%.3g (%.3g to %.3g)", estimate.value, estimate.low,
                estimate.high);
  return text;
}

void row(const Target& target, const Team& team, int seeds) {
  const bool banded = team.kinds.size() > 1;
  std::vector<double> seen[3], thought;
  for (int seed = 1; seed <= seeds; ++seed) {
    const auto number = static_cast<std::uint64_t>(seed);
    const Mission truth = mission_of(target, team, Law::kAware, number);
    for (const Law law : {Law::kUnaware, Law::kAware, Law::kBands}) {
      if (law == Law::kBands && !banded) continue;
      const Outcome metrics = simulated(mission_of(target, team, law, number), truth);
      seen[static_cast<int>(law)].push_back(metrics.seen);
      if (law == Law::kUnaware) thought.push_back(metrics.thought);
    }
  }
  const FootprintReach reach = footprint_reach(mission_of(target, team, Law::kAware, 1), 0);
  const auto against = [&](int law) {
    return seen[law].empty() ? std::string("–") : text(ratio_of(seen[law], seen[0]));
  };
  std::printf("| %s | %s | %.2g to %.2g | %s | %s | %s | %s | %s | %s |\n", target.name, team.name,
              reach.low, reach.high, text(median_of(thought)).c_str(),
              text(median_of(seen[0])).c_str(), text(median_of(seen[1])).c_str(),
              banded ? text(median_of(seen[2])).c_str() : "–", against(1).c_str(),
              against(2).c_str());
  std::fflush(stdout);
}

/// @param only  the number of a row from 1, or 0 for all
void study(int seeds, int only) {
  std::printf(
      "| target | team | least possible | unaware: believed | unaware | aware | bands | aware / "
      "unaware | bands / unaware |\n|---|---|---|---|---|---|---|---|---|\n");
  int number = 0;
  for (const Target& target : kTargets) {
    for (const Team& team : kTeams) {
      if (++number == only || only == 0) row(target, team, seeds);
    }
  }
}

}  // namespace
}  // namespace ergocast::studies

int main(int argc, char** argv) try {
  ergocast::studies::study(argc > 1 ? std::stoi(argv[1]) : 400, argc > 2 ? std::stoi(argv[2]) : 0);
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
