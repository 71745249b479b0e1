// SPDX-License-Identifier: BSD-3-Clause
// Passes the logged statuses to a LiveTeam, and keeps samples of it. The clock stops while the log
// pauses.
#include "cli/team/recorded_team.h"

#include <chrono>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cli/team/agent_history.h"
#include "cli/team/live_team.h"
#include "lcmtypes/channels.h"
#include "lcmtypes/codec.h"
#include "runtime/record/event_log_reader.h"

namespace ergocast::cli {
namespace {

using namespace std::chrono_literals;
using Json = nlohmann::ordered_json;

constexpr auto kLook = 250ms;     // between two searches for incidents
constexpr auto kShortest = 50ms;  // between two states of the world
constexpr auto kPause = 1s;       // the statuses of a team come twice a second

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
  void look();

  const Mission& mission_;
  std::optional<std::chrono::microseconds> last_;
  Instant now_{1h}, next_state_{}, next_look_{};
  std::optional<LiveTeam> team_;
  AgentHistory history_;
  std::vector<std::byte> copy_;
};

void Listener::look() {
  const bool keeps = history_.due(now_);
  if (now_ < next_look_ && !keeps) return;
  next_look_ = now_ + kLook;
  const TeamPicture picture = team_->notice(now_);
  if (keeps) history_.add(picture, now_);
}

Json Listener::json() const {
  Json json = history_.json();
  if (json.is_null()) return json;
  json["incidents"] = Json::array();
  for (const Json& one : team_->incidents_json()) {
    if (!one["text"].get<std::string>().starts_with("logger ")) json["incidents"].push_back(one);
  }
  return json;
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
