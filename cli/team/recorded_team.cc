// SPDX-License-Identifier: BSD-3-Clause
// Passes the logged statuses to a LiveTeam, and keeps samples of it. The clock stops while the log
// pauses. A longer mission has samples at longer intervals.
#include "cli/team/recorded_team.h"

#include <algorithm>
#include <chrono>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cli/team/live_team.h"
#include "cli/team/team_text.h"
#include "lcmtypes/channels.h"
#include "lcmtypes/codec.h"
#include "report/web_page.h"
#include "runtime/record/event_log_reader.h"

namespace ergocast::cli {
namespace {

using namespace std::chrono_literals;
using Json = nlohmann::ordered_json;

constexpr auto kLook = 250ms;     // between two searches for incidents
constexpr auto kShortest = 50ms;  // between two samples that are kept
constexpr auto kPause = 1s;       // the statuses of a team come twice a second
/// Limit (Page): statuses on the page. Beyond it: a live page keeps no newer ones; the page of a
/// record has fewer.
constexpr std::size_t kMost = 20'000;  // rows of agents that are kept
constexpr int kConditions = static_cast<int>(Condition::kGone) + 1;
constexpr int kPhases = static_cast<int>(AgentPhase::kResting) + 1;

using Keys = std::vector<const char*>;

struct Look {
  double t_s = 0;
  std::optional<double> metric;
  std::vector<AgentRow> agents;
};

/// The logger accepted the message with the team's key, which a reader need not have. The tag is
/// replaced by the keyless one, so that the codec can check everything else.
std::optional<Message> accepted(std::span<const std::byte> bytes, std::vector<std::byte>& copy) {
  if (bytes.size() < kHeaderEnd || bytes.size() > kMaxDatagramBytes) return {};
  copy.assign(bytes.begin(), bytes.end());
  MessageAuthenticator().close(copy, false, {});
  auto decoded = decode(copy, 0);
  return decoded ? std::optional(*std::move(decoded)) : std::nullopt;
}

class Listener {
 public:
  explicit Listener(const Mission& mission) : mission_(mission) {}

  bool wants(std::string_view channel, std::int64_t time_us) {
    advance(std::chrono::microseconds(time_us));
    if (is_channel_of(kTypes<AgentStatus, TeamStatus, MissionPart>, channel)) return true;
    // The world sends many states; a few are enough to show that it runs.
    if (!is_channel_of(kTypes<WorldState>, channel) || now_ < next_state_) return false;
    next_state_ = now_ + kShortest;
    return true;
  }

  void receive(const LoggedEvent& event) {
    const auto message = accepted(event.bytes, copy_);
    const auto transmitter = message ? transmitter_of(*message, event.channel) : std::nullopt;
    if (!transmitter) return;
    const bool world = std::holds_alternative<WorldState>(*message);
    const RunId run = std::visit([](const auto& m) { return m.header.run; }, *message);
    if (!team_) {
      team_.emplace(run, now_, false);
      team_->begin(mission_, {});
    }
    if (run != team_->run()) return;
    team_->receive(*message, world ? Bus::kWorld : Bus::kSwarm, *transmitter, now_);
    look();
  }

  Json json() const;

 private:
  void advance(std::chrono::microseconds time) {
    if (last_ && time > *last_ && time - *last_ < kPause) now_ += time - *last_;
    last_ = time;
  }
  Keys keys() const;
  void look();
  void keep(const TeamPicture& picture);

  const Mission& mission_;
  std::optional<std::chrono::microseconds> last_;
  Instant now_{1h}, next_state_{}, next_look_{}, next_kept_{};
  PacingClock::duration period_ = kShortest;
  std::optional<LiveTeam> team_;
  std::vector<Look> looks_;
  std::vector<std::byte> copy_;
};

void Listener::look() {
  const bool keeps = now_ >= next_kept_;
  if (now_ < next_look_ && !keeps) return;
  next_look_ = now_ + kLook;
  const TeamPicture picture = team_->notice(now_);
  if (!keeps || picture.over || picture.agents.empty()) return;
  next_kept_ = now_ + period_;
  keep(picture);
}

void Listener::keep(const TeamPicture& picture) {
  const double t_s = static_cast<double>(picture.tick) * picture.dt_s;
  if (!looks_.empty() && looks_.back().t_s >= t_s) looks_.pop_back();
  looks_.push_back({t_s, picture.ergodic_metric, picture.agents});
  if (looks_.size() * picture.agents.size() < kMost) return;
  for (std::size_t i = 1; 2 * i < looks_.size(); ++i) looks_[i] = std::move(looks_[2 * i]);
  looks_.resize((looks_.size() + 1) / 2);
  period_ *= 2;
}

/// The lists of one agent, padded up to the sample in which it appears.
Json& lists_of(Json& agents, AgentId id, const Keys& keys, std::size_t looks) {
  Json& lists = agents[std::to_string(id)];
  for (const char* key : keys) {
    Json& list = lists[key];
    if (list.is_null()) list = Json::array();
    while (list.size() < looks) list.push_back(nullptr);
  }
  return lists;
}

void add(Json& lists, const AgentRow& row) {
  lists["state"].push_back(static_cast<int>(row.condition));
  lists["silent_s"].push_back(page_number(row.silent_s, 3));
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
  if (!lists.contains("blocked_s")) return;
  lists["blocked_s"].push_back(page_number(row.blocked_s, 3));
  const bool by_an_agent = status.blocked_by != kUnassigned;
  lists["blocked_by"].push_back(by_an_agent ? Json(status.blocked_by) : Json());
}

/// The lists that the record needs: those of blocks only if an agent was blocked.
Keys Listener::keys() const {
  Keys keys{"state", "phase", "silent_s", "metric", "age_s", "lag_s", "lost", "drops", "waits_for"};
  const auto is_blocked = [](const AgentRow& row) { return row.blocked_s > 0; };
  if (std::ranges::any_of(
          looks_, [&](const Look& look) { return std::ranges::any_of(look.agents, is_blocked); })) {
    keys.insert(keys.end(), {"blocked_s", "blocked_by"});
  }
  return keys;
}

Json Listener::json() const {
  if (looks_.empty()) return nullptr;
  const Keys keys = this->keys();
  Json t = Json::array(), metric = Json::array(), agents = Json::object(), words = Json::array(),
       phases = Json::array();
  for (std::size_t i = 0; i < looks_.size(); ++i) {
    t.push_back(page_number(looks_[i].t_s, 9));
    metric.push_back(looks_[i].metric ? page_number(*looks_[i].metric, 4) : Json());
    for (const AgentRow& row : looks_[i].agents)
      add(lists_of(agents, row.author.agent, keys, i), row);
  }
  for (auto& [id, unused] : agents.items()) lists_of(agents, std::stoi(id), keys, looks_.size());
  for (int i = 0; i < kConditions; ++i) words.push_back(to_string(static_cast<Condition>(i)));
  for (int i = 0; i < kPhases; ++i) phases.push_back(to_string(static_cast<AgentPhase>(i)));
  Json incidents = Json::array();
  for (const Json& one : team_->incidents_json()) {
    if (!one["text"].get<std::string>().starts_with("logger ")) incidents.push_back(one);
  }
  return {{"t", std::move(t)},           {"metric", std::move(metric)},
          {"agents", std::move(agents)}, {"words", std::move(words)},
          {"phases", std::move(phases)}, {"incidents", std::move(incidents)}};
}

}  // namespace

Json recorded_team(const std::filesystem::path& run_dir, const Mission& mission,
                   std::string* problem) {
  auto log = EventLogReader::open(run_dir);
  if (!log) return nullptr;
  Listener listener(mission);
  while (const LoggedEvent* event = log->next()) {
    if (listener.wants(event->channel, event->time_us)) listener.receive(*event);
  }
  if (problem != nullptr) *problem = log->problem().value_or("");
  return listener.json();
}

}  // namespace ergocast::cli
