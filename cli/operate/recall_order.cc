// SPDX-License-Identifier: BSD-3-Clause
// Repeats RECALL, and reads roster and statuses for its effect.
#include "cli/operate/recall_order.h"

#include <algorithm>
#include <chrono>

#include "runtime/bus/random_identity.h"

namespace ergocast::cli {
namespace {

using namespace std::chrono_literals;

constexpr auto kPeriod = 100ms;
/// How long a coordinator and the agent may take to obey.
constexpr auto kPatience = 5s;

/// "0, 1 and 3": the numbers of the present members.
std::string present_members(const MonitoredRun& team) {
  std::vector<std::string> numbers;
  for (const RosterEntry& entry : team.roster()) {
    if (entry.active_until < 0) numbers.push_back(std::to_string(entry.author.agent));
  }
  return listed(numbers);
}

bool has_had(const MonitoredRun& team, AgentId id) {
  return std::ranges::any_of(team.roster(),
                             [id](const RosterEntry& entry) { return entry.author.agent == id; });
}

}  // namespace

RecallOrder::RecallOrder(AgentId agent, bool leaves, Instant since)
    : recall_{{0, kOperator, random_identity(), 0, 0}, agent, leaves, {}}, since_(since) {}

std::string RecallOrder::name() const { return "agent " + std::to_string(recall_.agent); }

/// Whether the agent has left the mission.
bool RecallOrder::is_gone(const MonitoredRun& team) const {
  const RosterEntry* const entry = team.present_member(recall_.agent);
  return entry == nullptr || team.phase_of(entry->author) == AgentPhase::kFinished;
}

/// Whether MISSION has what was ordered.
bool RecallOrder::is_obeyed(const MonitoredRun& team) const {
  const RosterEntry* const entry = team.present_member(recall_.agent);
  if (entry == nullptr) return recall_.leaves;
  return entry->recalled() && (entry->leaves || !recall_.leaves);
}

std::string RecallOrder::why_impossible(const MonitoredRun& team) const {
  if (!has_had(team, recall_.agent))
    return "there is no " + name() + ": the mission has " + present_members(team);
  if (team.present_member(recall_.agent) == nullptr)
    return name() + " has left the mission already";
  const auto stays = [&](const RosterEntry& entry) {
    return entry.active_until < 0 && !entry.leaves && entry.author.agent != recall_.agent;
  };
  if (recall_.leaves && std::ranges::none_of(team.roster(), stays))
    return name() + " is the last one in the mission: end the mission with ergocast stop";
  return "";
}

OrderProgress RecallOrder::advance(const MonitoredRun& team, Transport& transport, Instant now) {
  using enum OrderProgress::State;
  if (team.over()) return {kFailed, "the mission had already ended: " + team.reason()};
  if (!team.is_running()) return {};
  if (!checked_) {
    if (std::string why = why_impossible(team); !why.empty()) return {kFailed, std::move(why)};
    checked_ = true;
    since_ = now;
  }
  if (is_obeyed(team)) return report(team, now);
  if (now - since_ >= kPatience) return {kFailed, why_not(team)};
  send(team, transport, now);
  return {};
}

OrderProgress RecallOrder::report(const MonitoredRun& team, Instant now) {
  using enum OrderProgress::State;
  if (recall_.leaves && is_gone(team)) return {kDone, name() + " has left the mission"};
  const RosterEntry* const entry = team.present_member(recall_.agent);
  if (!recall_.leaves && entry != nullptr) {
    const AgentPhase phase = team.phase_of(entry->author);
    if (phase == AgentPhase::kResting) return {kDone, name() + " rests at home"};
    if (phase == AgentPhase::kReturning) return {kDone, name() + " is on its way home"};
  }
  if (now - since_ < kPatience) return {};
  return {kFailed, "the coordinator has recalled " + name() +
                       ", but the agent does not report it: it obeys once it receives MISSION"};
}

void RecallOrder::send(const MonitoredRun& team, Transport& transport, Instant now) {
  if (now < next_) return;
  next_ = now + kPeriod;
  ++recall_.header.sequence;
  recall_.header.run = team.run();
  recall_.header.tick = team.tick();
  transport.publish({Bus::kSwarm, recall_});
}

std::string RecallOrder::why_not(const MonitoredRun& team) const {
  if (!team.coordinator_seen())
    return "no coordinator answers, and only a coordinator recalls agents: start one with "
           "ergocast-coordinator --resume";
  return "the coordinator does not recall " + name() + ": it may have another key";
}

}  // namespace ergocast::cli
