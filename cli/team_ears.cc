#include "cli/team_ears.h"

#include <algorithm>
#include <chrono>
#include <utility>

namespace ergocast::cli {
namespace {

using namespace std::chrono_literals;

/// Three of an agent's statuses; a world in real time may be slower, but STOP finds it all the
/// same.
constexpr auto kSilence = 3 * kAgentStatusPeriod;
constexpr std::size_t kMostLives = std::size_t{kMaxAgents} * kMaxIncarnationsPerAgent;

std::string name_of(AgentId sender) {
  if (sender >= 0) return "agent " + std::to_string(sender);
  return sender == kCoordinator ? "the coordinator" : sender == kWorld ? "the world" : "the logger";
}

}  // namespace

std::variant<std::unique_ptr<Transport>, std::string> listen_to_teams(
    const BusOptions& options, Hear hear) {
  return Transport::open(options.url, options.run, options.seal, subscriptions_of(Role::kMonitor),
                         {.on_message = std::move(hear)});
}

void RunHeard::receive(const Message& message, Bus, AgentId, Instant now) {
  const Header& from = header_of(message);
  tick_ = std::max(tick_, from.tick);
  if (const auto* part = std::get_if<MissionPart>(&message)) {
    // An agent may repeat it long after the coordinator's death, and says nothing new by it.
    over_ = over_ || part->state == MissionState::kEnded || part->state == MissionState::kFailed;
    if (over_ && !part->reason.empty()) reason_ = part->reason;
    for (const RosterEntry& entry : part->roster) {
      if (agents_.size() < kMostLives) agents_.try_emplace(entry.author);
      if (entry.active_until >= 0) agents_.erase(entry.author);
    }
    return;
  }
  if (!freshness_.is_news(from)) return;
  if (const auto* status = std::get_if<AgentStatus>(&message)) {
    const Author author{from.sender, from.incarnation};
    if (from.sender < 0 || (agents_.size() >= kMostLives && !agents_.contains(author))) return;
    agents_[author] = {now, status->phase == AgentPhase::kFinished};
    return;
  }
  if (from.sender == kCoordinator || from.sender == kWorld || from.sender == kLogger) {
    processes_[from.sender] = now;
  }
  if (const auto* world = std::get_if<WorldState>(&message); world && from.tick >= world_tick_) {
    if (from.tick > world_tick_) velocities_mps_.clear();
    world_tick_ = from.tick;
    for (int i = 0; i < world->vehicle_count; ++i) {
      const Vehicle& vehicle = world->vehicles[static_cast<std::size_t>(i)];
      velocities_mps_[vehicle.id] = vehicle.velocity_mps;
    }
  }
}

bool RunHeard::stands_still() const {
  return std::all_of(velocities_mps_.begin(), velocities_mps_.end(),
                     [](const auto& one) { return one.second.isZero(0); });
}

std::vector<std::string> RunHeard::still_there(Instant now) const {
  std::vector<std::string> names;
  for (const auto& [author, seen] : agents_) {
    if (!seen.finished && now - seen.heard < kSilence) names.push_back(name_of(author.agent));
  }
  for (const auto& [sender, heard] : processes_) {
    if (now - heard < kSilence) names.push_back(name_of(sender));
  }
  return names;
}

std::vector<std::string> RunHeard::lost(Instant now) const {
  std::vector<std::string> names;
  for (const auto& [author, seen] : agents_) {
    if (!seen.finished && now - seen.heard >= kSilence) names.push_back(name_of(author.agent));
  }
  return names;
}

std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) {
    text += (i == 0 ? "" : i + 1 == names.size() ? " and " : ", ") + names[i];
  }
  return text;
}

}  // namespace ergocast::cli
