// SPDX-License-Identifier: BSD-3-Clause
// What the agents of a team of sites know of each other (core/law/site_row.h): of their own site
// each member's fresh row, and of each other site the newest of its rows that has arrived.
//
// All members of a site receive the same. Agent i belongs to site i mod the number of sites.
#pragma once

#include <cstdint>
#include <vector>

#include "core/basis/basis.h"
#include "core/law/look_ahead.h"
#include "core/law/site_row.h"
#include "core/law/site_table.h"
#include "core/mission/mission.h"

namespace ergocast::lab {

struct SiteRules {
  int sites = 1;
  /// Between two rows of a site. Site s of S sends at tick 0 and whenever
  /// tick ≡ ⌊s · period / S⌋ (mod period); others have the row in the same tick.
  Tick row_period_ticks = 1;
  double loss = 0;  ///< the share of rows that a receiving site loses
  /// Site 1 is cut off: from the first of these ticks on, and before the second, no row passes
  /// between it and another.
  Tick cut_from = 0, cut_until = 0;
};

class SiteExchange {
 public:
  SiteExchange(const Mission& mission, const SiteRules& rules);

  /// The rows of all agents, by number, each with a forecast. The caller sets them before update().
  std::vector<MemberRow>& rows() { return rows_; }

  /// Takes in the rows at `tick`, and lets the sites that are due send theirs.
  void update(Tick tick);

  /// ĉ of an agent, as core/law/forecast.h has it: of its own row without a forecast.
  void foresee(std::size_t agent, Coefficients& coverage) const;

 private:
  struct Site {
    std::vector<std::size_t> members;  // ascending
    SiteRow row;
    SiteTable others;
    /// Σ (S + w r) over the own members and all other rows, and the time that this covers.
    std::vector<double> sums;
    double time_s = 0;
    double weight_s = 0;  // w of an own member
  };

  void send(std::size_t site, Tick tick);
  bool is_lost(std::size_t from, std::size_t to, Tick tick) const;
  void sum_up(Site& site, Tick tick) const;

  SiteRules rules_;
  LookAhead look_ahead_;
  std::uint64_t seed_;
  std::vector<Site> sites_;
  std::vector<MemberRow> rows_;
};

}  // namespace ergocast::lab
