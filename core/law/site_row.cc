// SPDX-License-Identifier: BSD-3-Clause
// Adds members' rows one after the other, so that equal rows give equal bits.
#include "core/law/site_row.h"

#include <algorithm>
#include <cmath>

#include "core/base/vectorized.h"

namespace ergocast {
namespace {

/// How far honest sums may exceed their time: rounding of all additions, relative.
constexpr double kRounding = 1e-6;

/// sums += factor · more.
ERGOCAST_VECTORIZED
void add_times(const double* more, double factor, int count, double* sums) {
  ERGOCAST_INDEPENDENT
  for (int k = 0; k < count; ++k) sums[k] += factor * more[k];
}

/// False also for what is not a number.
bool within(const double* numbers, int count, double limit) {
  return std::all_of(numbers, numbers + count,
                     [&](double number) { return std::abs(number) <= limit * (1 + kRounding); });
}

}  // namespace

SiteRow::SiteRow(int site, int modes)
    : site_(site), modes_(modes), numbers_(2 * static_cast<std::size_t>(modes)) {
  members_.reserve(kMostMemberRows);
}

void SiteRow::restart(std::int64_t revision, const Author& parent, Tick tick) {
  order_ = {.revision = revision, .parent = parent, .steps = 0, .tick = tick};
  members_.clear();
  std::ranges::fill(numbers_, 0);
  elapsed_s_ = rate_quality_ = lag_sum_s_ = 0;
  team_size_ = 0;
}

bool SiteRow::add(const MemberRow& member) {
  if (member.steps <= 0 || members_.size() == kMostMemberRows) return false;
  if (!members_.empty() && member.name <= members_.back().row) return false;
  members_.push_back({member.name, member.steps});
  order_.steps += member.steps;
  elapsed_s_ += member.quality * member.elapsed_s;
  add_times(member.sums, member.quality, modes_, numbers_.data());
  team_size_ += member.counts_in_team ? 1 : 0;
  if (member.gains == nullptr) return true;
  rate_quality_ += member.quality;
  lag_sum_s_ += member.quality * member.lag_s;
  add_times(member.gains, member.quality / member.gained_s, modes_, numbers_.data() + modes_);
  return true;
}

bool SiteRow::is_possible() const {
  return elapsed_s_ >= 0 && rate_quality_ >= 0 && lag_sum_s_ >= 0 && std::isfinite(lag_sum_s_) &&
         within(sums(), modes_, elapsed_s_) && within(rates(), modes_, rate_quality_);
}

}  // namespace ergocast
