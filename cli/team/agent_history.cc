// SPDX-License-Identifier: BSD-3-Clause
// Keeps the rows of each picture, and writes them as one list for each agent and value.
#include "cli/team/agent_history.h"

#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "cli/team/team_text.h"
#include "report/web_page.h"

namespace ergocast {
namespace {

using Json = nlohmann::ordered_json;

/// Limit (Page): statuses on the page. Beyond it: a live page keeps no newer ones; the page of a
/// record has fewer.
constexpr std::size_t kMost = 20'000;  // rows of agents that are kept
constexpr int kConditions = static_cast<int>(Condition::kGone) + 1;
constexpr int kPhases = static_cast<int>(AgentPhase::kResting) + 1;

void pad(Json& list, std::size_t size) {
  if (list.is_null()) list = Json::array();
  while (list.size() < size) list.push_back(nullptr);
}

/// The lists of one agent, padded up to the sample in which it appears.
Json& lists_of(Json& agents, AgentId id, std::size_t samples) {
  Json& lists = agents[std::to_string(id)];
  for (const char* key :
       {"state", "phase", "silent_s", "metric", "age_s", "lag_s", "lost", "drops", "waits_for"}) {
    pad(lists[key], samples);
  }
  return lists;
}

void add_block(Json& lists, const AgentRow& row, std::size_t samples) {
  for (const char* key : {"blocked_s", "blocked_by"}) pad(lists[key], samples);
  lists["blocked_s"].push_back(page_number(row.blocked_s, 3));
  const AgentId by = row.status->blocked_by;
  lists["blocked_by"].push_back(by == kUnassigned ? Json() : Json(by));
}

/// @param samples  before this one
void add_row(Json& lists, const AgentRow& row, std::size_t samples) {
  lists["state"].push_back(static_cast<int>(row.condition));
  lists["silent_s"].push_back(page_number(row.silent_s, 3));
  if (row.charge_ppm != kNoCharge) {
    pad(lists["charge"], samples);
    lists["charge"].push_back(page_number(share_of(row.charge_ppm), 3));
    pad(lists["charges"], samples);
    lists["charges"].push_back(row.charges);
  }
  if (!row.status) return;
  const AgentStatus& status = *row.status;
  lists["phase"].push_back(static_cast<int>(status.phase));
  if (status.answered_tick >= 0) lists["metric"].push_back(page_number(status.ergodic_metric, 4));
  lists["age_s"].push_back(page_number(status.max_staleness_s, 4));
  lists["lag_s"].push_back(page_number(status.loop_lag_s, 2));
  lists["lost"].push_back(status.contributions_lost);
  lists["drops"].push_back(status.kernel_drops);
  const bool waits = row.condition == Condition::kWaiting && status.waiting_for != kUnassigned;
  lists["waits_for"].push_back(waits ? Json(name_of(status.waiting_for)) : Json());
  if (row.blocked_s > 0) add_block(lists, row, samples);
}

}  // namespace

void AgentHistory::add(const TeamPicture& picture, Instant now) {
  if (!due(now) || picture.over || picture.agents.empty()) return;
  next_ = now + period_;
  const double t_s = static_cast<double>(picture.tick) * picture.dt_s;
  if (!samples_.empty() && samples_.back().t_s >= t_s) samples_.pop_back();
  samples_.push_back({t_s, picture.ergodic_metric, picture.agents});
  if (samples_.size() * picture.agents.size() < kMost) return;
  for (std::size_t i = 1; 2 * i < samples_.size(); ++i) samples_[i] = std::move(samples_[2 * i]);
  samples_.resize((samples_.size() + 1) / 2);
  period_ *= 2;
}

Json AgentHistory::json() const {
  if (samples_.empty()) return nullptr;
  Json t = Json::array(), metric = Json::array(), agents = Json::object(), words = Json::array(),
       phases = Json::array();
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    const Sample& sample = samples_[i];
    t.push_back(page_number(sample.t_s, 9));
    metric.push_back(sample.metric ? page_number(*sample.metric, 4) : Json());
    for (const AgentRow& row : sample.agents)
      add_row(lists_of(agents, row.author.agent, i), row, i);
  }
  for (auto& [id, lists] : agents.items()) {
    for (auto& [key, list] : lists.items()) pad(list, samples_.size());
  }
  for (int i = 0; i < kConditions; ++i) words.push_back(to_string(static_cast<Condition>(i)));
  for (int i = 0; i < kPhases; ++i) phases.push_back(to_string(static_cast<AgentPhase>(i)));
  return {{"t", std::move(t)},
          {"metric", std::move(metric)},
          {"agents", std::move(agents)},
          {"words", std::move(words)},
          {"phases", std::move(phases)}};
}

}  // namespace ergocast
