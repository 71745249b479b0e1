// SPDX-License-Identifier: BSD-3-Clause
// The rows of all other sites as one agent knows them, and what they add to c_k and ĉ_k.
//
//   c_k = (Σ_own q S + Σ_s S_s) / (Σ_own q T + Σ_s T_s)
//   ĉ_k = (… + Σ_s (S_s + w_s R_s)) / (… + Σ_s (T_s + w_s Q_s)),   w_s = h + age_s + ℓ_s
//
// "Own" are the members' rows of the agent's own site, which another table has. The greatest row of
// each site by SiteRowOrder is held. So order of arrival and repetition have no effect. Sums are
// added in ascending order of sites.
#pragma once

#include <cstddef>
#include <vector>

#include "core/base/ids.h"
#include "core/base/line_aligned.h"
#include "core/law/look_ahead.h"
#include "core/law/site_row.h"

namespace ergocast {

enum class SiteMerge {
  kNewer,
  kStale,
  kRefusedRange,  ///< another number of modes, a site that does not exist, or impossible numbers
};

class SiteTable {
 public:
  /// Allocates all that it will need. It is for one block of modes.
  /// @param row_period_ticks  between two rows of a site, as planned
  SiteTable(int sites, int own_site, int modes, Tick row_period_ticks);

  /// The agent belongs to this site from now on: its row is held but does not count.
  void set_own_site(int site) { own_site_ = site; }
  int own_site() const { return own_site_; }

  /// Takes over a row that is greater than the held one of its site.
  SiteMerge merge(const SiteRow& theirs);

  /// Which row of a site is held; one without steps if none is.
  const SiteRowOrder& held(int site) const { return rows_[static_cast<std::size_t>(site)].order; }

  /// What the rows that count add to n of the horizon: Σ m_s, members, not rows.
  int team_size() const;

  /// sums += Σ S_s. @return Σ T_s
  double add_coverage(double* sums) const;

  /// sums += Σ (S_s + w_s R_s), where w_s = 0 if the row is too old for a forecast.
  /// @return Σ (T_s + w_s Q_s)
  double add_forecast(const LookAhead& look_ahead, double horizon_s, Tick tick, double* sums) const;

 private:
  struct Row {
    SiteRowOrder order;
    double elapsed_s = 0, rate_quality = 0, lag_s = 0;
    int team_size = 0;
  };

  bool counts(std::size_t site) const {
    return static_cast<int>(site) != own_site_ && rows_[site].order.steps > 0;
  }
  double* numbers(std::size_t site) {
    return numbers_.data() + 2 * site * static_cast<std::size_t>(modes_);
  }
  const double* numbers(std::size_t site) const {
    return numbers_.data() + 2 * site * static_cast<std::size_t>(modes_);
  }

  int own_site_, modes_;
  Tick row_period_ticks_;
  std::vector<Row> rows_;   // by site
  AlignedDoubles numbers_;  // by site: S_s, then R_s
};

}  // namespace ergocast
