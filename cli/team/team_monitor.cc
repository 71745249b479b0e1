// SPDX-License-Identifier: BSD-3-Clause
// Stores the last message of every process of a run. A process that is silent for long has ended.
#include "cli/team/team_monitor.h"

#include <algorithm>
#include <cstdio>
#include <iterator>
#include <utility>

#include "core/motion/vehicle.h"
#include "core/motion/zones.h"

namespace ergocast::cli {
namespace {

/// The maximum number of members. Members of former incarnations are removed when the roster ends
/// them.
constexpr std::size_t kMaxIncarnations = std::size_t{kMaxAgents} * kMaxIncarnationsPerAgent;
constexpr AgentId kProcesses[] = {kLogger, kWorld, kCoordinator};

std::string name_of(AgentId sender) {
  if (sender >= 0) return "agent " + std::to_string(sender);
  return sender == kCoordinator ? "the coordinator" : sender == kWorld ? "the world" : "the logger";
}

}  // namespace

Result<std::unique_ptr<Transport>> listen_to_teams(const BusOptions& options, OnMessage on_message,
                                                   OnMessage on_replayed, Role role) {
  Subscriptions subscriptions = subscriptions_of(role);
  // HELLO names the version of an agent that wants to join.
  if (role == Role::kMonitor) subscriptions[static_cast<std::size_t>(Bus::kSwarm)] |= kTypes<Hello>;
  return Transport::open(
      options.url, options.run, options.authenticator, subscriptions,
      {.on_message = std::move(on_message), .on_replayed = std::move(on_replayed)});
}

MonitoredRun::MonitoredRun(RunId run, Instant since)
    : me_(kRole, {run, kUnassigned, 0}), since_(since) {}

void MonitoredRun::receive(const Message& message, Bus bus, AgentId transmitter, Instant now) {
  const auto arrival = me_.accept(message, bus, transmitter, now);
  if (!arrival) return;
  tick_ = std::max(tick_, arrival->from.tick);
  std::visit([&](const auto& m) { on(m, *arrival); }, message);
}

/// An agent may repeat a part long after the coordinator exited; a repetition changes nothing.
void MonitoredRun::on(const MissionPart& part, const Arrival&) {
  over_ = over_ || is_over(part.state);
  if (over_ && !part.reason.empty()) reason_ = part.reason;
  for (const RosterEntry& entry : part.roster) {
    if (agents_.size() < kMaxIncarnations) agents_.try_emplace(entry.author);
    if (entry.active_until >= 0) agents_.erase(entry.author);
  }
}

void MonitoredRun::on(const AgentStatus& status, const Arrival& arrival) {
  const Author author{status.header.sender, status.header.incarnation};
  if (!arrival.fresh || author.agent < 0) return;
  if (agents_.size() >= kMaxIncarnations && !agents_.contains(author)) return;
  agents_[author] = status.phase;
}

/// Each robot may have its own driver, which has its own ticks.
void MonitoredRun::on(const WorldState& world, const Arrival& arrival) {
  if (!arrival.fresh) return;
  note_end(arrival, world.last);
  for (const Vehicle& vehicle : world.vehicles_in_part()) {
    VehicleSeen& seen = vehicles_[vehicle.id];
    if (world.header.tick >= seen.tick)
      seen = {world.header.tick, vehicle.velocity_mps, vehicle.position_m};
  }
}

void MonitoredRun::on(const RecordAck& ack, const Arrival& arrival) {
  if (!arrival.fresh) return;
  note_end(arrival, ack.last);
  recorded_ = ack;
}

/// A process's last message may be read before earlier messages on another bus.
void MonitoredRun::note_end(const Arrival& arrival, bool ended) {
  const Author author{arrival.from.sender, arrival.from.incarnation};
  if (processes_.size() >= kMaxIncarnations && !processes_.contains(author)) return;
  bool& known = processes_[author];
  known = known || ended;
}

bool MonitoredRun::unheard() const {
  return agents_.empty() && !over_ &&
         std::none_of(std::begin(kProcesses), std::end(kProcesses),
                      [this](AgentId process) { return seen(process); });
}

bool MonitoredRun::stands_still() const {
  const Standing vehicles = standing();
  return vehicles.standing == vehicles.all;
}

std::vector<AgentPlace> MonitoredRun::places() const {
  std::vector<AgentPlace> agents;
  for (const RosterEntry& entry : roster()) {
    const auto seen = vehicles_.find(entry.author.agent);
    if (entry.active_until < 0 && seen != vehicles_.end())
      agents.push_back({entry.author.agent, seen->second.position_m});
  }
  return agents;
}

std::map<AgentId, Eigen::Vector3d> MonitoredRun::places_m() const {
  std::map<AgentId, Eigen::Vector3d> places;
  for (const auto& [id, vehicle] : vehicles_) places[id] = vehicle.position_m;
  return places;
}

MonitoredRun::Standing MonitoredRun::standing() const {
  Standing found;
  found.all = static_cast<int>(vehicles_.size());
  for (const auto& [id, vehicle] : vehicles_) {
    const Motion motion = knows_mission() ? motion_of(me_.mission(), id) : Motion{};
    const bool leaves_zone =
        knows_mission() &&
        must_leave(amendments().zones, tick_, mission(), motion,
                   holding_way(motion, vehicle.position_m, vehicle.velocity_mps));
    const bool circles = motion.vehicle.min_speed_mps > 0 && me_.is_held(tick_) && !leaves_zone;
    if (stands(motion, vehicle.velocity_mps)) {
      ++found.standing;
    } else if (circles) {
      ++found.circling;
    } else {
      found.moving.push_back(name_of(id));
      found.speed_mps += vehicle.velocity_mps.norm();
      found.leaves_zone = found.leaves_zone || leaves_zone;
    }
  }
  return found;
}

bool MonitoredRun::silent(const Author& agent, Instant now) const {
  return me_.silent(agent, now) && now - since_ >= silence_of(agent.agent);
}

/// Whether it still sends and has not reported its end. A coordinator that has reported the
/// mission's end exits by itself.
bool MonitoredRun::there(AgentId process, Instant now) const {
  if (!seen(process) || me_.silent(process, now)) return false;
  if (process == kCoordinator) return !over_;
  return std::any_of(processes_.begin(), processes_.end(), [process](const auto& one) {
    return one.first.agent == process && !one.second;
  });
}

std::vector<std::string> MonitoredRun::agents_there(Instant now) const {
  std::vector<std::string> names;
  for (const auto& [author, phase] : agents_) {
    if (phase != AgentPhase::kFinished && !silent(author, now))
      names.push_back(name_of(author.agent));
  }
  return names;
}

std::vector<std::string> MonitoredRun::still_there(Instant now) const {
  std::vector<std::string> names = agents_there(now);
  for (const AgentId process : kProcesses) {
    if (there(process, now)) names.push_back(name_of(process));
  }
  return names;
}

std::vector<std::string> MonitoredRun::still_moving(Instant now) const {
  std::vector<std::string> names = agents_there(now);
  if (there(kWorld, now) && !stands_still()) names.push_back(name_of(kWorld));
  if (there(kCoordinator, now)) names.push_back(name_of(kCoordinator));
  return names;
}

std::vector<std::string> MonitoredRun::lost(Instant now) const {
  std::vector<std::string> names;
  for (const auto& [author, phase] : agents_) {
    if (phase != AgentPhase::kFinished && silent(author, now))
      names.push_back(name_of(author.agent));
  }
  return names;
}

const RosterEntry* MonitoredRun::present_member(AgentId id) const {
  const auto at = std::ranges::find_if(roster(), [id](const RosterEntry& entry) {
    return entry.author.agent == id && entry.active_until < 0;
  });
  return at == roster().end() ? nullptr : &*at;
}

AgentPhase MonitoredRun::phase_of(const Author& author) const {
  const auto at = agents_.find(author);
  return at == agents_.end() ? AgentPhase::kJoining : at->second;
}

std::string MonitoredRun::mission_time(Tick tick) const {
  const Tick counted = me_.counted(tick);
  std::string text = "tick " + std::to_string(counted);
  if (!knows_mission()) return text;
  char time[32];
  std::snprintf(time, sizeof time, ", t = %.1f s",
                static_cast<double>(counted) * me_.timing().dt_s);
  return text + time;
}

double MonitoredRun::seconds_until(Tick tick) const {
  const Timing& timing = me_.timing();
  if (timing.pace == Pace::kLockstep || tick <= tick_) return 0;
  return static_cast<double>(tick - tick_) * timing.dt_s / timing.realtime_factor;
}

std::string choice_of(const std::map<RunId, MonitoredRun>& runs) {
  std::string text = "several runs are on this URL; choose one with --run-id:";
  for (const auto& [run, team] : runs) {
    text += "\n  --run-id " + to_hex(run) + "  " + std::to_string(team.agents()) + " agents, " +
            team.mission_time(team.tick());
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
