// SPDX-License-Identifier: BSD-3-Clause
// One table names every field; a seed draws the strengths of the faults and the times of the
// incidents.
#include "lab/faults.h"

#include <algorithm>
#include <cmath>

#include "core/noise.h"
#include "lab/dice.h"

namespace ergocast::lab {
namespace {

constexpr FaultField kFields[] = {
    {"loss", &Faults::loss, 1},
    {"duplication", &Faults::duplication, 1},
    {"corruption", &Faults::corruption, 1},
    {"delay_mean_s", &Faults::delay_mean_s, 60},
    {"delay_max_s", &Faults::delay_max_s, 60},
    {"reordering", &Faults::reordering, 1},
    {"reordering_max_s", &Faults::reordering_max_s, 60},
    {"clogging", &Faults::clogging, 1},
    {"clog_max_s", &Faults::clog_max_s, 60},
    {"replay", &Faults::replay, 1},
    {"replay_max_s", &Faults::replay_max_s, 600},
    {"partitions_per_s", &Faults::partitions_per_s, 10},
    {"partition_max_s", &Faults::partition_max_s, 60},
    {"one_way_share", &Faults::one_way_share, 1},
    {"agent_crashes_per_s", &Faults::agent_crashes_per_s, 1},
    {"coordinator_crashes_per_s", &Faults::coordinator_crashes_per_s, 1},
    {"world_crashes_per_s", &Faults::world_crashes_per_s, 1},
    {"downtime_max_s", &Faults::downtime_max_s, 60},
    {"clock_rate_error", &Faults::clock_rate_error, 0.2},
    {"clock_offset_max_s", &Faults::clock_offset_max_s, 1e8},
    {"swarm_bus_only", &Faults::swarm_bus_only, 1},
    {"lasting_share", &Faults::lasting_share, 1},
};

/// Streams of dice, so that one kind of fault does not change what another draws.
enum Stream : std::uint32_t { kSwarm = 1, kPartitions, kAgents, kCoordinator, kWorldProcess };

}  // namespace

std::span<const FaultField> fault_fields() { return kFields; }

Faults drawn(std::uint64_t seed) {
  Dice dice(seed, kSwarm);
  Faults faults;
  if (dice.coin()) faults.loss = 0.7 * std::pow(dice.uniform(), 2);
  if (dice.coin()) faults.duplication = 0.5 * std::pow(dice.uniform(), 2);
  if (dice.coin()) faults.corruption = 0.3 * std::pow(dice.uniform(), 2);
  if (dice.coin()) {
    faults.delay_mean_s = dice.log_uniform(1e-3, 0.3);
    faults.delay_max_s = faults.delay_mean_s * dice.log_uniform(1, 7);
  }
  if (dice.coin()) {
    faults.reordering = 0.5 * dice.uniform();
    faults.reordering_max_s = dice.log_uniform(1e-3, 1);
  }
  if (dice.coin()) {
    faults.clogging = dice.log_uniform(1e-4, 1e-2);
    faults.clog_max_s = dice.log_uniform(0.1, 4);
  }
  if (dice.coin()) {
    faults.partitions_per_s = dice.log_uniform(0.02, 0.3);
    faults.partition_max_s = dice.log_uniform(0.2, 10);
    faults.one_way_share = dice.uniform();
  }
  if (dice.coin()) faults.agent_crashes_per_s = dice.log_uniform(0.03, 0.3);
  if (dice.coin()) faults.coordinator_crashes_per_s = dice.log_uniform(0.03, 0.15);
  if (dice.coin()) faults.world_crashes_per_s = dice.log_uniform(0.03, 0.15);
  faults.downtime_max_s = dice.log_uniform(0.1, 6);
  if (dice.coin()) {
    faults.clock_rate_error = dice.log_uniform(1e-5, 0.05);
    faults.clock_offset_max_s = dice.log_uniform(1e-3, 1e6);
  }
  if (dice.coin()) faults.swarm_bus_only = 1;
  if (dice.coin()) {
    faults.replay = 0.3 * std::pow(dice.uniform(), 2);
    faults.replay_max_s = dice.log_uniform(0.1, 60);
  }
  return faults;
}

bool spares_the_record(const Faults& f) {
  const bool messages = f.loss > 0 || f.duplication > 0 || f.corruption > 0 || f.delay_mean_s > 0 ||
                        f.reordering > 0 || f.clogging > 0 || f.replay > 0;
  return f.partitions_per_s <= 0 && f.world_crashes_per_s <= 0 &&
         (!messages || f.swarm_bus_only > 0);
}

bool hinders(const Faults& f, double patience_s) {
  // Whoever is waited for may lack four messages in a row, each said again once a second.
  constexpr int kInARow = 4;
  constexpr double kNever = 1e-6;
  const double arrives = std::pow(std::max(0.0, 1 - f.loss - f.corruption), kInARow);
  const double latest_s = kInARow * (f.delay_max_s + f.reordering_max_s + f.clog_max_s);
  return std::pow(1 - arrives, patience_s / 2) > kNever || latest_s > patience_s / 2;
}

std::vector<Incident> incidents(const Faults& faults, std::uint64_t seed, int agents,
                                double horizon_s) {
  std::vector<Incident> all;
  const auto draw = [&](Stream stream, double per_s, double max_s, auto kind_and_who) {
    Dice dice(seed, stream);
    double at_s = 0;
    while (per_s > 0 && (at_s += dice.exponential(1 / per_s)) < horizon_s) {
      const double lasts_s = max_s * dice.uniform();
      const auto [kind, who] = kind_and_who(dice);
      all.push_back({kind, at_s, lasts_s, who});
    }
  };
  using enum Incident::Kind;
  const auto one_of_one = [](Incident::Kind kind) {
    return [kind](Dice&) { return std::pair(kind, std::uint64_t{0}); };
  };
  draw(kPartitions, faults.partitions_per_s, faults.partition_max_s, [&](Dice& dice) {
    const auto kind = dice.uniform() < faults.one_way_share ? kOneWayCut : kSplit;
    return std::pair(kind, dice.word());
  });
  draw(kAgents, faults.agent_crashes_per_s, faults.downtime_max_s, [&](Dice& dice) {
    return std::pair(kAgentCrash, dice.word() % static_cast<std::uint64_t>(agents));
  });
  draw(kCoordinator, faults.coordinator_crashes_per_s, faults.downtime_max_s,
       one_of_one(kCoordinatorCrash));
  draw(kWorldProcess, faults.world_crashes_per_s, faults.downtime_max_s, one_of_one(kWorldCrash));
  std::stable_sort(all.begin(), all.end(),
                   [](const Incident& a, const Incident& b) { return a.at_s < b.at_s; });
  return all;
}

}  // namespace ergocast::lab
