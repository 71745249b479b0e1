// SPDX-License-Identifier: BSD-3-Clause
// Lists what sums of rows do not carry: a site's row has sums and rates of f alone, at fresh
// places.
#include "core/mission/sites.h"

#include "core/mission/station.h"

namespace ergocast {
namespace {

struct Rule {
  bool (*breaks)(const Mission&);
  NoSites no_sites;
};

constexpr Rule kRules[] = {
    {[](const Mission& m) { return m.law.kind != LawKind::kCover; },
     {"law.kind", "sites sum up coverage, and this law needs more of each agent", "write COVER"}},
    {[](const Mission& m) { return m.law.anticipation <= 0; },
     {"law.anticipation", "sites send what their members will cover", "write a number above 0"}},
    {[](const Mission& m) { return m.law.memory_half_life_s > 0; },
     {"law.memory_half_life_s", "rows of sites forget nothing", "write 0"}},
    {[](const Mission& m) { return !m.dead_reckoning; },
     {"agents.dead_reckoning", "members of a site know each other's places", "write true"}},
    {[](const Mission& m) { return m.timing.pace != Pace::kLockstep; },
     {"time.pace", "a team of sites is simulated in lockstep", "write LOCKSTEP"}},
    {[](const Mission& m) {
       return m.timing.contribution_encoding != ContributionEncoding::kDouble;
     },
     {"time.contribution_encoding", "rows of sites are not rounded", "write DOUBLE"}},
    {[](const Mission& m) { return m.radio_range_m > 0; },
     {"world.radio_range_m", "all members of a site receive each other", "write 0"}},
    {[](const Mission& m) { return !m.walls.empty(); },
     {"world.walls", "a team of sites goes round no walls", "remove them"}},
    {[](const Mission& m) { return m.separation.distance_m > 0; },
     {"separation", "an agent does not know the bodies of other sites", "remove it"}},
    {[](const Mission& m) { return any_station(m); },
     {"agents.kind", "a site does not know which members rest at stations", "remove the stations"}},
    {[](const Mission& m) { return m.objects.end_when_found > 0; },
     {"world.objects.end_when_found", "no coordinator ends a team of sites", "remove it"}},
};

}  // namespace

int most_members(const Mission& mission) {
  const auto agents = static_cast<int>(mission.starts_m.size());
  return mission.sites.any() ? (agents + mission.sites.count - 1) / mission.sites.count : agents;
}

const NoSites* why_no_sites(const Mission& mission) {
  for (const Rule& rule : kRules) {
    if (rule.breaks(mission)) return &rule.no_sites;
  }
  return nullptr;
}

}  // namespace ergocast
