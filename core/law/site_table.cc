// SPDX-License-Identifier: BSD-3-Clause
// Holds the greatest row of each site, all numbers in one array.
#include "core/law/site_table.h"

#include <algorithm>

#include "core/base/vectorized.h"

namespace ergocast {
namespace {

/// sums += S.
ERGOCAST_VECTORIZED
void add(const double* more, int count, double* sums) {
  ERGOCAST_INDEPENDENT
  for (int k = 0; k < count; ++k) sums[k] += more[k];
}

/// sums += S + w R.
ERGOCAST_VECTORIZED
void add_with_rates(const double* more, const double* rates, double weight_s, int count,
                    double* sums) {
  ERGOCAST_INDEPENDENT
  for (int k = 0; k < count; ++k) sums[k] += more[k] + weight_s * rates[k];
}

}  // namespace

SiteTable::SiteTable(int sites, int own_site, int modes, Tick row_period_ticks)
    : own_site_(own_site),
      modes_(modes),
      row_period_ticks_(row_period_ticks),
      rows_(static_cast<std::size_t>(sites)),
      numbers_(2 * rows_.size() * static_cast<std::size_t>(modes)) {}

SiteMerge SiteTable::merge(const SiteRow& theirs) {
  const auto site = static_cast<std::size_t>(theirs.site());
  if (theirs.site() < 0 || site >= rows_.size() || theirs.modes() != modes_ ||
      !theirs.is_possible())
    return SiteMerge::kRefusedRange;
  Row& row = rows_[site];
  if (theirs.order() <= row.order) return SiteMerge::kStale;
  row = {.order = theirs.order(),
         .elapsed_s = theirs.elapsed_s(),
         .rate_quality = theirs.rate_quality(),
         .lag_s = theirs.lag_s(),
         .team_size = theirs.team_size()};
  std::copy_n(theirs.sums(), modes_, numbers(site));
  std::copy_n(theirs.rates(), modes_, numbers(site) + modes_);
  return SiteMerge::kNewer;
}

int SiteTable::team_size() const {
  int members = 0;
  for (std::size_t site = 0; site < rows_.size(); ++site)
    members += counts(site) ? rows_[site].team_size : 0;
  return members;
}

double SiteTable::add_coverage(double* sums) const {
  double elapsed_s = 0;
  for (std::size_t site = 0; site < rows_.size(); ++site) {
    if (!counts(site)) continue;
    add(numbers(site), modes_, sums);
    elapsed_s += rows_[site].elapsed_s;
  }
  return elapsed_s;
}

double SiteTable::add_forecast(const LookAhead& look_ahead, double horizon_s, Tick tick,
                               double* sums) const {
  double time_s = 0;
  for (std::size_t site = 0; site < rows_.size(); ++site) {
    if (!counts(site)) continue;
    const Row& row = rows_[site];
    const Tick age = std::max<Tick>(0, tick - row.order.tick);
    const double weight_s =
        look_ahead.weight_with_lag_s(horizon_s, row.lag_s, age, row_period_ticks_);
    add_with_rates(numbers(site), numbers(site) + modes_, weight_s, modes_, sums);
    time_s += row.elapsed_s + weight_s * row.rate_quality;
  }
  return time_s;
}

}  // namespace ergocast
