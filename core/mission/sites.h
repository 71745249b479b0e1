// SPDX-License-Identifier: BSD-3-Clause
// A team that is divided into sites. Agent i belongs to site i mod S.
//
// An agent receives the rows of its own site's members, and of each other site one row for all its
// members (core/law/site_row.h). No process sends such rows yet, so only a simulation has sites.
#pragma once

#include "core/mission/mission.h"

namespace ergocast {

/// What processes other than a simulation say of such a mission.
inline constexpr const char* kSitesAreSimulated =
    "a team of sites runs in ergocast simulate and study only, because no process sends rows of "
    "sites yet: leave out team.sites";

/// The greatest number of members of a site.
int most_members(const Mission& mission);

/// A field of the scenario that a team of sites cannot have, and what it needs.
struct NoSites {
  const char* field;
  const char* why;
  const char* remedy;
};

/// Why a mission cannot have sites, apart from their number; null if it can.
const NoSites* why_no_sites(const Mission& mission);

}  // namespace ergocast
