// SPDX-License-Identifier: BSD-3-Clause
// Summarises the statuses of each call in one row. Removes every second row when there are too
// many.
#include "cli/team/team_history.h"

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>

#include "report/web_page.h"

namespace ergocast {

TeamHistory::Row TeamHistory::row_of(const TeamPicture& picture) {
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  Row row{.t_s = static_cast<double>(picture.tick) * picture.dt_s,
          .phi = picture.ergodic_metric.value_or(kUnknown),
          .spread = kUnknown,
          .age_s = kUnknown};
  double least = std::numeric_limits<double>::infinity(), most = -least, oldest_s = -1;
  for (const AgentRow& agent : picture.agents) {
    if (!agent.status) continue;
    const AgentStatus& status = *agent.status;
    oldest_s = std::max(oldest_s, status.max_staleness_s);
    row.received += status.contributions_received;
    row.lost += status.contributions_lost;
    if (status.answered_tick < 0) continue;
    least = std::min(least, status.ergodic_metric);
    most = std::max(most, status.ergodic_metric);
  }
  if (most >= least) row.spread = most - least;
  if (oldest_s >= 0) row.age_s = oldest_s;
  return row;
}

void TeamHistory::add(const TeamPicture& picture) {
  const Row row = row_of(picture);
  if (!picture.ergodic_metric || row.t_s <= newest_s_) return;
  newest_s_ = row.t_s;
  if (offered_++ % every_ != 0) return;
  rows_.push_back(row);
  if (rows_.size() < kMostRows) return;
  for (std::size_t i = 1; 2 * i < rows_.size(); ++i) rows_[i] = rows_[2 * i];
  rows_.resize((rows_.size() + 1) / 2);
  every_ *= 2;
}

nlohmann::ordered_json TeamHistory::json() const {
  nlohmann::ordered_json lists;
  for (const char* key : {"t", "phi", "spread", "age", "received", "lost"})
    lists[key] = nlohmann::ordered_json::array();
  for (const Row& row : rows_) {
    lists["t"].push_back(page_number(row.t_s, 9));
    lists["phi"].push_back(page_number(row.phi));
    lists["spread"].push_back(page_number(row.spread, 3));
    lists["age"].push_back(page_number(row.age_s, 4));
    lists["received"].push_back(row.received);
    lists["lost"].push_back(row.lost);
  }
  return lists;
}

}  // namespace ergocast
