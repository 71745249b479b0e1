// SPDX-License-Identifier: BSD-3-Clause
// Flies one row of docs/announced_plans.md: a scenario with many seeds, under the shipped law or
// under announced plans. Adds the seeds that are missing to a CSV file of φ² at the end.
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <stdexcept>
#include <string>

#include "core/ideal_team.h"
#include "lab/studies/plans/plan_team.h"
#include "lab/studies/table.h"
#include "scenario/scenario.h"

namespace ergocast::studies {
namespace {

struct Row {
  std::string scenario;
  double duration_s = 600;
  int agents = 0;           // 0: as many as the scenario has
  int first = 1, last = 1;  // seeds
};

Mission mission_of(const Row& row, int seed) {
  Overrides overrides;
  overrides.seed = static_cast<std::uint64_t>(seed);
  overrides.duration_s = row.duration_s;
  if (row.agents > 0) overrides.agents = row.agents;
  auto loaded = Scenario::load(row.scenario, overrides);
  if (const auto* problems = std::get_if<std::vector<Problem>>(&loaded)) {
    throw std::runtime_error(to_string(problems->front()));
  }
  return std::get<Scenario>(loaded).mission();
}

/// As `ergocast study` flies it where no message is needed.
double fly_law(const Mission& mission) {
  if (!lab::IdealTeam::stands_for(mission)) throw std::runtime_error("the team is not ideal");
  lab::IdealTeam team(mission);
  while (team.tick() < mission.timing.tick_count) team.step();
  return team.metric();
}

double fly_plans(const Mission& mission, const PlanSetting& setting) {
  PlanTeam team(mission, setting);
  team.fly();
  return team.metric();
}

/// Sets what `word`, "name=value", names.
void set(const std::string& word, PlanSetting& setting, Row& row) {
  const std::size_t equals = word.find('=');
  if (equals == std::string::npos) throw std::runtime_error("no name=value: " + word);
  const double value = std::stod(word.substr(equals + 1));
  const std::map<std::string, std::function<void()>> fields = {
      {"first", [&] { row.first = static_cast<int>(value); }},
      {"last", [&] { row.last = static_cast<int>(value); }},
      {"agents", [&] { row.agents = static_cast<int>(value); }},
      {"duration_s", [&] { row.duration_s = value; }},
      {"nodes", [&] { setting.nodes = static_cast<int>(value); }},
      {"node_s", [&] { setting.node_s = value; }},
      {"points", [&] { setting.points = static_cast<int>(value); }},
      {"run_weight", [&] { setting.run_weight = value; }},
      {"trust", [&] { setting.trust = value; }},
      {"trust_from", [&] { setting.trust_from = value; }},
      {"step", [&] { setting.step = value; }},
      {"announced_every_s", [&] { setting.announced_every_s = value; }},
      {"loss", [&] { setting.loss = value; }},
  };
  const auto field = fields.find(word.substr(0, equals));
  if (field == fields.end()) throw std::runtime_error("unknown: " + word);
  field->second();
}

void run(const std::string& kind, Row row, const std::string& file, int words, char** word) {
  if (kind != "law" && kind != "plans") throw std::runtime_error("neither law nor plans: " + kind);
  PlanSetting setting;
  for (int i = 0; i < words; ++i) set(word[i], setting, row);
  if (std::filesystem::exists(file) && std::filesystem::file_size(file) > 0) {
    row.first = static_cast<int>(read_table(file).at("seed").back()) + 1;
  }
  std::ofstream out(file, std::ios::app);
  out.precision(17);
  for (int seed = row.first; seed <= row.last; ++seed) {
    const Mission mission = mission_of(row, seed);
    const double metric = kind == "law" ? fly_law(mission) : fly_plans(mission, setting);
    if (out.tellp() == 0) out << "seed,ergodic_metric\n";
    if (!(out << seed << ',' << metric << std::endl)) {
      throw std::runtime_error(file + " cannot be written");
    }
  }
}

}  // namespace
}  // namespace ergocast::studies

int main(int argc, char** argv) {
  if (argc < 4) {
    std::fprintf(stderr, "usage: studies-plans-fly law|plans SCENARIO FILE [NAME=VALUE]...\n");
    return 2;
  }
  try {
    ergocast::studies::run(argv[1], {.scenario = argv[2]}, argv[3], argc - 4, argv + 4);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "studies-plans-fly: %s\n", error.what());
    return 2;
  }
}
