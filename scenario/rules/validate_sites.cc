// SPDX-License-Identifier: BSD-3-Clause
// Compares the sites with the team, and names the first field that they exclude.
#include "scenario/rules/validate_sites.h"

#include <string>

#include "core/law/site_row.h"
#include "core/mission/sites.h"
#include "scenario/parse/convert.h"

namespace ergocast {

void validate_sites(const proto::Scenario& scenario, Checks& checks) {
  if (!checks.sound("team")) return;
  const proto::Team& team = scenario.team();
  if (team.sites() == 0) {
    const int usual = TeamSites().row_period_ticks;
    if (team.has_site_row_period_ticks() && team.site_row_period_ticks() != usual)
      checks.problem("team.site_row_period_ticks", "has no effect without sites",
                     "remove it, or add sites");
    return;
  }
  if (!checks.nothing_found()) return;  // the rest depends on almost all blocks
  const int size = scenario.agents().starts_size() + scenario.agents().random_count();
  const int members = (size + team.sites() - 1) / team.sites();
  const int most = static_cast<int>(kMostMemberRows);
  if (team.sites() > size) {
    checks.problem("team.sites",
                   std::to_string(team.sites()) + " is above the limit, the team's size " +
                       std::to_string(size),
                   "write at most that");
  } else if (members > most) {
    checks.problem(
        "team.sites",
        std::to_string(members) + " agents of a site are above the limit " + std::to_string(most),
        "write at least " + std::to_string((size + most - 1) / most));
  } else if (const NoSites* const no = why_no_sites(mission_of(scenario))) {
    checks.problem(no->field, std::string("cannot be with team.sites: ") + no->why,
                   std::string(no->remedy) + ", or remove team.sites");
  }
}

}  // namespace ergocast
