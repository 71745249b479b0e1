// SPDX-License-Identifier: BSD-3-Clause
// What it costs a team that agents receive one row of each other site instead of all members' rows,
// for docs/network.md: φ² at the end against the same seeds where every agent receives all.
#include <cmath>
#include <cstdio>
#include <exception>
#include <stdexcept>
#include <string>
#include <vector>

#include "lab/ideal_team.h"
#include "lab/site_exchange.h"
#include "report/statistics.h"
#include "scenario/scenario.h"

namespace ergocast::studies {
namespace {

struct Division {
  lab::SiteRules rules;
  const char* exchange;
};

Mission mission_of(const char* file, const std::string& agents, int seed) {
  Overrides overrides;
  overrides.seed = static_cast<std::uint64_t>(seed);
  overrides.fields = {{"agents.random_count", agents, "AGENTS"}, {"time.pace", "LOCKSTEP", "PACE"}};
  auto loaded = Scenario::load(file, overrides);
  if (!loaded) throw std::runtime_error(to_string(loaded.error().front()));
  return loaded->mission();
}

/// φ² at the end of each seed.
std::vector<double> metrics_of(const std::vector<Mission>& missions, const lab::SiteRules* rules) {
  std::vector<double> metrics;
  for (const Mission& mission : missions) {
    lab::IdealTeam team(mission);
    if (rules != nullptr) team.divide(*rules);
    while (team.tick() < mission.timing.tick_count) team.step();
    metrics.push_back(team.metric());
  }
  return metrics;
}

/// Rows of each step without loss give agents all that the others know.
std::vector<Division> divisions_of(int sites) {
  std::vector<Division> all;
  for (const Tick period : {1, 2, 4, 10}) all.push_back({{sites, period, 0}, "all arrive"});
  for (const Tick period : {1, 4}) all.push_back({{sites, period, 0.3}, "30 % lost"});
  return all;
}

void print(int agents, const char* sites, const std::string& period_s, const char* exchange,
           const std::vector<double>& metrics, const std::vector<double>& all_receive_all) {
  const Estimate mean = ratio_of(metrics, std::vector<double>(metrics.size(), 1.0));
  const Estimate ratio = ratio_of(metrics, all_receive_all);
  std::printf("| %d | %s | %s | %s | %zu | %.2e (%.2e to %.2e) | %.2f (%.2f to %.2f) |\n", agents,
              sites, period_s.c_str(), exchange, metrics.size(), mean.value, mean.low, mean.high,
              ratio.value, ratio.low, ratio.high);
  std::fflush(stdout);
}

void run(const char* file, int seeds, const std::string& agents, const std::vector<int>& sites) {
  std::vector<Mission> missions;
  for (int seed = 1; seed <= seeds; ++seed) missions.push_back(mission_of(file, agents, seed));
  const int count = std::stoi(agents);
  const std::vector<double> all_receive_all = metrics_of(missions, nullptr);
  print(count, "–", "–", "–", all_receive_all, all_receive_all);
  const double dt_s = missions.front().timing.dt_s;
  for (const int one : sites) {
    for (const auto& [rules, exchange] : divisions_of(one)) {
      char period_s[16];
      std::snprintf(period_s, sizeof period_s, "%g",
                    static_cast<double>(rules.row_period_ticks) * dt_s);
      print(count, std::to_string(one).c_str(), period_s, exchange, metrics_of(missions, &rules),
            all_receive_all);
    }
  }
}

/// φ² of each seed at the end of a cut, and at the end of the mission.
void run_cut(const char* file, int seeds, const std::string& agents, int sites, double from_s,
             double until_s) {
  std::vector<double> whole[2], divided[2];
  for (int seed = 1; seed <= seeds; ++seed) {
    const Mission mission = mission_of(file, agents, seed);
    const auto tick_of = [&](double t_s) { return std::lround(t_s / mission.timing.dt_s); };
    for (const bool cut : {false, true}) {
      lab::IdealTeam team(mission);
      team.divide({sites, 1, 0, cut ? tick_of(from_s) : 0, cut ? tick_of(until_s) : 0});
      auto& metrics = cut ? divided : whole;
      for (const int end : {0, 1}) {
        while (team.tick() < (end == 0 ? tick_of(until_s) : mission.timing.tick_count)) team.step();
        metrics[end].push_back(team.metric());
      }
    }
  }
  for (const int end : {0, 1}) {
    print(std::stoi(agents), std::to_string(sites).c_str(), end == 0 ? "cut ends" : "mission ends",
          "site 1 cut off", divided[end], whole[end]);
  }
}

}  // namespace
}  // namespace ergocast::studies

int main(int argc, char** argv) {
  if (argc < 5) {
    std::fprintf(stderr,
                 "usage: studies-network-sites SCENARIO SEEDS AGENTS SITES…\n"
                 "       studies-network-sites cut SCENARIO SEEDS AGENTS SITES FROM_S UNTIL_S\n");
    return 2;
  }
  try {
    std::printf(
        "| agents | sites | a row every [s] | rows | seeds | φ² (95 %%) | φ² against "
        "all-receive-all "
        "(95 %%) |\n|---|---|---|---|---|---|---|\n");
    if (std::string(argv[1]) == "cut" && argc == 8) {
      ergocast::studies::run_cut(argv[2], std::stoi(argv[3]), argv[4], std::stoi(argv[5]),
                                 std::stod(argv[6]), std::stod(argv[7]));
      return 0;
    }
    std::vector<int> sites;
    for (int i = 4; i < argc; ++i) sites.push_back(std::stoi(argv[i]));
    ergocast::studies::run(argv[1], std::stoi(argv[2]), argv[3], sites);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "studies-network-sites: %s\n", error.what());
    return 2;
  }
}
