// SPDX-License-Identifier: BSD-3-Clause
// One table names every field. A seed draws how strong the faults are, and when each happens.
#include "lab/faults.h"

#include <algorithm>

#include "core/base/noise.h"
#include "core/base/portable_math.h"
#include "lab/random_stream.h"

namespace ergocast::lab {
namespace {

constexpr double kMostSites = 64;

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
    {"pauses_per_s", &Faults::pauses_per_s, 1},
    {"pause_max_s", &Faults::pause_max_s, 60},
    {"targets_per_s", &Faults::targets_per_s, 1},
    {"ends_per_s", &Faults::ends_per_s, 1},
    {"recalls_per_s", &Faults::recalls_per_s, 1},
    {"departure_share", &Faults::departure_share, 1},
    {"downtime_max_s", &Faults::downtime_max_s, 60},
    {"clock_rate_error", &Faults::clock_rate_error, 0.2},
    {"clock_offset_max_s", &Faults::clock_offset_max_s, 1e8},
    {"swarm_bus_only", &Faults::swarm_bus_only, 1},
    {"lasting_share", &Faults::lasting_share, 1},
    {"zones_per_s", &Faults::zones_per_s, 1},
    {"laws_per_s", &Faults::laws_per_s, 1},
    {"cancels_per_s", &Faults::cancels_per_s, 1},
    {"sites", &Faults::sites, kMostSites},
    {"link_delay_s", &Faults::link_delay_s, 60},
    {"link_jitter_s", &Faults::link_jitter_s, 60},
    {"link_loss", &Faults::link_loss, 1},
    {"site_cut_s", &Faults::site_cut_s, 600},
    {"site_cut_at_s", &Faults::site_cut_at_s, 1e6},
};

/// Random streams, so that one kind of fault does not change what another draws.
enum Stream : std::uint32_t {
  kSwarm = 1,
  kPartitions,
  kAgents,
  kCoordinators,
  kWorldProcess,
  kOperator,
  kRecalls,
  kTargets,
  kEnds,
  kZones,
  kLaws,
  kCancels,
  kSites
};

}  // namespace

std::span<const FaultField> fault_fields() { return kFields; }

Faults drawn(std::uint64_t seed) {
  RandomStream random(seed, kSwarm);
  Faults faults;
  if (random.coin()) faults.loss = 0.7 * portable::square(random.uniform());
  if (random.coin()) faults.duplication = 0.5 * portable::square(random.uniform());
  if (random.coin()) faults.corruption = 0.3 * portable::square(random.uniform());
  if (random.coin()) {
    faults.delay_mean_s = random.log_uniform(1e-3, 0.3);
    faults.delay_max_s = faults.delay_mean_s * random.log_uniform(1, 7);
  }
  if (random.coin()) {
    faults.reordering = 0.5 * random.uniform();
    faults.reordering_max_s = random.log_uniform(1e-3, 1);
  }
  if (random.coin()) {
    faults.clogging = random.log_uniform(1e-4, 1e-2);
    faults.clog_max_s = random.log_uniform(0.1, 4);
  }
  if (random.coin()) {
    faults.partitions_per_s = random.log_uniform(0.02, 0.3);
    faults.partition_max_s = random.log_uniform(0.2, 10);
    faults.one_way_share = random.uniform();
  }
  if (random.coin()) faults.agent_crashes_per_s = random.log_uniform(0.03, 0.3);
  if (random.coin()) faults.coordinator_crashes_per_s = random.log_uniform(0.03, 0.15);
  if (random.coin()) faults.world_crashes_per_s = random.log_uniform(0.03, 0.15);
  faults.downtime_max_s = random.log_uniform(0.1, 6);
  if (random.coin()) {
    faults.clock_rate_error = random.log_uniform(1e-5, 0.05);
    faults.clock_offset_max_s = random.log_uniform(1e-3, 1e6);
  }
  if (random.coin()) faults.swarm_bus_only = 1;
  if (random.coin()) {
    faults.replay = 0.3 * portable::square(random.uniform());
    faults.replay_max_s = random.log_uniform(0.1, 60);
  }
  // Last, so that a seed keeps its other faults.
  if (random.coin()) {
    faults.pauses_per_s = random.log_uniform(0.03, 0.15);
    faults.pause_max_s = random.log_uniform(0.1, 10);
  }
  if (random.coin()) {
    faults.recalls_per_s = random.log_uniform(0.02, 0.1);
    faults.departure_share = random.uniform();
  }
  if (random.coin()) faults.targets_per_s = random.log_uniform(0.03, 0.3);
  if (random.coin()) faults.ends_per_s = random.log_uniform(0.02, 0.1);
  if (random.coin()) faults.zones_per_s = random.log_uniform(0.03, 0.2);
  if (random.coin()) faults.laws_per_s = random.log_uniform(0.03, 0.3);
  if (random.coin()) faults.cancels_per_s = random.log_uniform(0.05, 0.5);
  return faults;
}

int site_count(const Faults& faults) { return std::max(1, static_cast<int>(faults.sites)); }

int site_of(int node, int agents, int sites) { return node < agents ? node * sites / agents : 0; }

bool has_bad_links(const Faults& f) {
  return site_count(f) > 1 &&
         (f.link_delay_s > 0 || f.link_jitter_s > 0 || f.link_loss > 0 || f.site_cut_s > 0);
}

bool spares_the_record(const Faults& f) {
  const bool messages = f.loss > 0 || f.duplication > 0 || f.corruption > 0 || f.delay_mean_s > 0 ||
                        f.reordering > 0 || f.clogging > 0 || f.replay > 0 || has_bad_links(f);
  return f.partitions_per_s <= 0 && f.world_crashes_per_s <= 0 &&
         (!messages || f.swarm_bus_only > 0);
}

bool only_wishes(const Faults& f) {
  const bool messages = f.loss > 0 || f.duplication > 0 || f.corruption > 0 || f.delay_mean_s > 0 ||
                        f.reordering > 0 || f.clogging > 0 || f.replay > 0 || has_bad_links(f);
  const bool processes = f.partitions_per_s > 0 || f.agent_crashes_per_s > 0 ||
                         f.coordinator_crashes_per_s > 0 || f.world_crashes_per_s > 0;
  const bool clocks = f.clock_rate_error > 0 || f.clock_offset_max_s > 0;
  return !messages && !processes && !clocks && !(f.departure_share > 0);
}

bool hinders(const Faults& f, double patience_s) {
  // The awaited process may lack four messages in a row, each repeated once a second.
  constexpr int kInARow = 4;
  constexpr double kNever = 1e-6;
  const double link_loss = has_bad_links(f) ? f.link_loss : 0;
  const double link_s = has_bad_links(f) ? f.link_delay_s + f.link_jitter_s : 0;
  const double arrives =
      portable::pow(std::max(0.0, 1 - f.loss - f.corruption) * (1 - link_loss), kInARow);
  const double latest_s = kInARow * (f.delay_max_s + f.reordering_max_s + f.clog_max_s + link_s);
  return portable::pow(1 - arrives, patience_s / 2) > kNever || latest_s > patience_s / 2;
}

std::vector<FaultEvent> fault_events(const Faults& faults, std::uint64_t seed, int agents,
                                     double horizon_s) {
  std::vector<FaultEvent> all;
  const auto draw = [&](Stream stream, double per_s, double max_s, auto kind_and_who) {
    RandomStream random(seed, stream);
    double at_s = 0;
    while (per_s > 0 && (at_s += random.exponential(1 / per_s)) < horizon_s) {
      const double lasts_s = max_s * random.uniform();
      const auto [kind, who] = kind_and_who(random);
      all.push_back({kind, at_s, lasts_s, who});
    }
  };
  using enum FaultEvent::Kind;
  const auto one_of_one = [](FaultEvent::Kind kind) {
    return [kind](RandomStream&) { return std::pair(kind, std::uint64_t{0}); };
  };
  draw(kPartitions, faults.partitions_per_s, faults.partition_max_s, [&](RandomStream& random) {
    const auto kind = random.uniform() < faults.one_way_share ? kOneWayCut : kSplit;
    return std::pair(kind, random.word());
  });
  draw(kAgents, faults.agent_crashes_per_s, faults.downtime_max_s, [&](RandomStream& random) {
    return std::pair(kAgentCrash, random.word() % static_cast<std::uint64_t>(agents));
  });
  draw(kCoordinators, faults.coordinator_crashes_per_s, faults.downtime_max_s,
       one_of_one(kCoordinatorCrash));
  draw(kWorldProcess, faults.world_crashes_per_s, faults.downtime_max_s, one_of_one(kWorldCrash));
  draw(kOperator, faults.pauses_per_s, faults.pause_max_s, one_of_one(kPause));
  draw(kRecalls, faults.recalls_per_s, 0, [&](RandomStream& random) {
    const auto kind = random.uniform() < faults.departure_share ? kDeparture : kRecall;
    return std::pair(kind, random.word() % static_cast<std::uint64_t>(agents));
  });
  draw(kTargets, faults.targets_per_s, 0,
       [](RandomStream& random) { return std::pair(kTarget, random.word()); });
  draw(kEnds, faults.ends_per_s, 0,
       [](RandomStream& random) { return std::pair(kEnd, random.word()); });
  draw(kZones, faults.zones_per_s, 0,
       [](RandomStream& random) { return std::pair(kZone, random.word()); });
  draw(kLaws, faults.laws_per_s, 0,
       [](RandomStream& random) { return std::pair(kLaw, random.word()); });
  draw(kCancels, faults.cancels_per_s, 0,
       [](RandomStream& random) { return std::pair(kCancel, random.word()); });
  if (const int sites = site_count(faults); sites > 1 && faults.site_cut_s > 0) {
    const auto which = RandomStream(seed, kSites).word() % static_cast<std::uint64_t>(sites - 1);
    all.push_back({kSiteCut, faults.site_cut_at_s, faults.site_cut_s, 1 + which});
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const FaultEvent& a, const FaultEvent& b) { return a.at_s < b.at_s; });
  return all;
}

}  // namespace ergocast::lab
