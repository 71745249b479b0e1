// SPDX-License-Identifier: BSD-3-Clause
// Sums up each site once a tick; an agent's coverage is that sum without its own forecast.
#include "lab/site_exchange.h"

#include <algorithm>

#include "core/base/noise.h"

namespace ergocast::lab {

SiteExchange::SiteExchange(const Mission& mission, const SiteRules& rules)
    : rules_(rules), look_ahead_(mission), seed_(mission.seed) {
  const int modes = mission.basis.mode_count();
  for (int s = 0; s < rules.sites; ++s) {
    sites_.push_back({.members = {},
                      .row = SiteRow(s, modes),
                      .others = SiteTable(rules.sites, s, modes, rules.row_period_ticks),
                      .sums = std::vector<double>(static_cast<std::size_t>(modes))});
  }
  for (std::size_t i = 0; i < mission.starts_m.size(); ++i)
    sites_[i % sites_.size()].members.push_back(i);
}

void SiteExchange::update(Tick tick) {
  for (std::size_t s = 0; s < sites_.size(); ++s) {
    const auto turn = static_cast<Tick>(s) * rules_.row_period_ticks / rules_.sites;
    if (tick == 0 || tick % rules_.row_period_ticks == turn) send(s, tick);
  }
  for (Site& site : sites_) sum_up(site, tick);
}

void SiteExchange::send(std::size_t from, Tick tick) {
  Site& site = sites_[from];
  site.row.restart(1, rows_[site.members.front()].name.author, tick);
  for (const std::size_t member : site.members) site.row.add(rows_[member]);
  for (std::size_t to = 0; to < sites_.size(); ++to) {
    if (to != from && !is_lost(from, to, tick)) sites_[to].others.merge(site.row);
  }
}

bool SiteExchange::is_lost(std::size_t from, std::size_t to, Tick tick) const {
  constexpr std::size_t kCutSite = 1;
  if (tick >= rules_.cut_from && tick < rules_.cut_until && (from == kCutSite || to == kCutSite))
    return true;
  if (rules_.loss <= 0) return false;
  const auto link = static_cast<std::uint32_t>(from * sites_.size() + to);
  return uniform_pair(seed_, Purpose::kFault, link, static_cast<std::uint64_t>(tick)).x() <
         rules_.loss;
}

void SiteExchange::sum_up(Site& site, Tick tick) const {
  std::ranges::fill(site.sums, 0);
  const int n = static_cast<int>(site.members.size()) + site.others.team_size();
  const double horizon_s = look_ahead_.horizon_s(n, tick);
  site.time_s = site.others.add_forecast(look_ahead_, horizon_s, tick, site.sums.data());
  site.weight_s = horizon_s + rows_[site.members.front()].lag_s;
  for (const std::size_t i : site.members) {
    const MemberRow& member = rows_[i];
    const double share = site.weight_s / member.gained_s;
    for (std::size_t k = 0; k < site.sums.size(); ++k)
      site.sums[k] += member.quality * (member.sums[k] + share * member.gains[k]);
    site.time_s += member.quality * (member.elapsed_s + site.weight_s);
  }
}

void SiteExchange::foresee(std::size_t agent, Coefficients& coverage) const {
  const Site& site = sites_[agent % sites_.size()];
  const MemberRow& own = rows_[agent];
  const double share = own.quality * site.weight_s / own.gained_s;
  const double per_second = 1 / (site.time_s - own.quality * site.weight_s);
  for (std::size_t k = 0; k < site.sums.size(); ++k)
    coverage[static_cast<Eigen::Index>(k)] = (site.sums[k] - share * own.gains[k]) * per_second;
}

}  // namespace ergocast::lab
