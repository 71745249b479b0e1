// SPDX-License-Identifier: BSD-3-Clause
// Stores the last message of every process of a run, and detects by silence that a process has
// ended.
#include "cli/team_monitor.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "scenario/scenario.h"

namespace ergocast::cli {
namespace {

/// The maximum number of members. Members of former incarnations are removed when the roster ends
/// them.
constexpr std::size_t kMostLives = std::size_t{kMaxAgents} * kMaxIncarnationsPerAgent;
constexpr AgentId kProcesses[] = {kLogger, kWorld, kCoordinator};

std::string name_of(AgentId sender) {
  if (sender >= 0) return "agent " + std::to_string(sender);
  return sender == kCoordinator ? "the coordinator" : sender == kWorld ? "the world" : "the logger";
}

}  // namespace

std::variant<std::unique_ptr<Transport>, std::string> listen_to_teams(const BusOptions& options,
                                                                      Hear hear, Hear hear_replay) {
  return Transport::open(options.url, options.run, options.seal, subscriptions_of(Role::kMonitor),
                         {.on_message = std::move(hear), .on_replayed = std::move(hear_replay)});
}

MonitoredRun::MonitoredRun(RunId run) : me_(kRole, {run, kUnassigned, 0}) {}

void MonitoredRun::receive(const Message& message, Bus bus, AgentId transmitter, Instant now) {
  const auto arrival = me_.accept(message, bus, transmitter, now);
  if (!arrival) return;
  tick_ = std::max(tick_, arrival->from.tick);
  std::visit([&](const auto& m) { on(m, *arrival); }, message);
}

/// An agent may repeat a part long after the coordinator exited; a repetition changes nothing.
void MonitoredRun::on(const MissionPart& part, const Arrival&) {
  over_ = over_ || part.state == MissionState::kEnded || part.state == MissionState::kFailed;
  if (over_ && !part.reason.empty()) reason_ = part.reason;
  for (const RosterEntry& entry : part.roster) {
    if (agents_.size() < kMostLives) agents_.try_emplace(entry.author);
    if (entry.active_until >= 0) agents_.erase(entry.author);
  }
}

void MonitoredRun::on(const AgentStatus& status, const Arrival& arrival) {
  const Author author{status.header.sender, status.header.incarnation};
  if (!arrival.fresh || author.agent < 0) return;
  if (agents_.size() >= kMostLives && !agents_.contains(author)) return;
  agents_[author] = status.phase == AgentPhase::kFinished;
}

void MonitoredRun::on(const WorldState& world, const Arrival& arrival) {
  const Tick tick = world.header.tick;
  if (!arrival.fresh || tick < world_tick_) return;
  if (tick > world_tick_) velocities_mps_.clear();
  world_tick_ = tick;
  for (int i = 0; i < world.vehicle_count; ++i) {
    const Vehicle& vehicle = world.vehicles[static_cast<std::size_t>(i)];
    velocities_mps_[vehicle.id] = vehicle.velocity_mps;
  }
}

bool MonitoredRun::unheard() const {
  return agents_.empty() && !over_ &&
         std::none_of(std::begin(kProcesses), std::end(kProcesses),
                      [this](AgentId process) { return heard(process); });
}

bool MonitoredRun::stands_still() const {
  return std::all_of(velocities_mps_.begin(), velocities_mps_.end(),
                     [](const auto& one) { return one.second.isZero(0); });
}

std::vector<std::string> MonitoredRun::still_there(Instant now) const {
  std::vector<std::string> names;
  for (const auto& [author, finished] : agents_) {
    if (!finished && !me_.silent(author, now)) names.push_back(name_of(author.agent));
  }
  for (const AgentId process : kProcesses) {
    if (heard(process) && !me_.silent(process, now)) names.push_back(name_of(process));
  }
  return names;
}

std::vector<std::string> MonitoredRun::lost(Instant now) const {
  std::vector<std::string> names;
  for (const auto& [author, finished] : agents_) {
    if (!finished && me_.silent(author, now)) names.push_back(name_of(author.agent));
  }
  return names;
}

std::string choice_of(const std::map<RunId, MonitoredRun>& runs) {
  std::string text = "several runs are heard on this URL; choose one with --run-id:";
  for (const auto& [run, team] : runs) {
    text += "\n  --run-id " + to_hex(run) + "  " + std::to_string(team.agents()) +
            " agents, tick " + std::to_string(team.tick());
  }
  return text;
}

std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) {
    text += (i == 0 ? "" : i + 1 == names.size() ? " and " : ", ") + names[i];
  }
  return text;
}

}  // namespace ergocast::cli
