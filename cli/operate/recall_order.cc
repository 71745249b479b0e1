// SPDX-License-Identifier: BSD-3-Clause
// Repeats RECALL until the roster contains the recall. The agent's status then shows the effect.
#include "cli/operate/recall_order.h"

#include <algorithm>
#include <chrono>

#include "runtime/bus/random_identity.h"

namespace ergocast::cli {
namespace {

using namespace std::chrono_literals;
using State = OrderReport::State;

constexpr auto kSendPeriod = 100ms;

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

RecallOrder::RecallOrder(AgentId agent, bool leaves, Instant now)
    : recall_{{0, kOperator, random_identity(), 0, 0}, agent, leaves, {}}, since_(now) {}

std::string RecallOrder::name() const { return "agent " + std::to_string(recall_.agent); }

/// Whether the agent has left the mission.
bool RecallOrder::is_gone(const MonitoredRun& team) const {
  const RosterEntry* const entry = team.present_member(recall_.agent);
  return entry == nullptr || team.phase_of(entry->author) == AgentPhase::kFinished;
}

bool RecallOrder::is_returning(const MonitoredRun& team) const {
  const RosterEntry* const entry = team.present_member(recall_.agent);
  return entry != nullptr && !recall_.leaves &&
         team.phase_of(entry->author) == AgentPhase::kReturning;
}

/// Whether the roster in MISSION contains the recall.
bool RecallOrder::is_named(const MonitoredRun& team) const {
  const RosterEntry* const entry = team.present_member(recall_.agent);
  if (entry == nullptr) return recall_.leaves;
  return entry->recalled() && (entry->leaves || !recall_.leaves);
}

std::optional<std::string> RecallOrder::why_impossible(const MonitoredRun& team) const {
  if (!has_had(team, recall_.agent))
    return "there is no " + name() + ": the mission has " + present_members(team);
  if (team.present_member(recall_.agent) == nullptr)
    return name() + " has left the mission already";
  const auto stays = [&](const RosterEntry& entry) {
    return entry.active_until < 0 && !entry.leaves && entry.author.agent != recall_.agent;
  };
  if (recall_.leaves && std::ranges::none_of(team.roster(), stays))
    return name() + " is the last one in the mission: end the mission with ergocast stop";
  return std::nullopt;
}

void RecallOrder::send(const MonitoredRun& team, Instant now, Outbox& out) {
  if (!team.is_running()) return;
  if (!checked_) {
    checked_ = true;
    problem_ = why_impossible(team);
    since_ = now;
  }
  was_on_its_way_ = was_on_its_way_ || is_returning(team);
  if (problem_ || is_named(team) || now < next_) return;
  next_ = now + kSendPeriod;
  ++recall_.header.sequence;
  recall_.header.run = team.run();
  recall_.header.tick = team.tick();
  out.push_back({Bus::kSwarm, recall_});
}

OrderReport RecallOrder::report(const MonitoredRun& team, Instant now) const {
  if (problem_) return {State::kFailed, *problem_};
  if (team.over()) return {State::kFailed, "the mission has ended: " + team.reason()};
  if (!checked_) return waiting_for_mission(team, now - since_);
  return is_named(team) ? named(team, now) : unnamed(team, now);
}

OrderReport RecallOrder::unnamed(const MonitoredRun& team, Instant now) const {
  if (now - since_ < kAnswerPatience) return {State::kSent, "the coordinator has not answered yet"};
  if (!team.coordinator_seen())
    return {State::kFailed,
            "no coordinator answers, and only a coordinator recalls agents: start one with "
            "ergocast-coordinator --resume"};
  return {State::kFailed,
          "the coordinator does not recall " + name() + ": it may have another key"};
}

OrderReport RecallOrder::named(const MonitoredRun& team, Instant now) const {
  if (recall_.leaves && is_gone(team)) return {State::kDone, name() + " has left the mission"};
  const RosterEntry* const entry = team.present_member(recall_.agent);
  if (!recall_.leaves && entry != nullptr) {
    const AgentPhase phase = team.phase_of(entry->author);
    if (phase == AgentPhase::kResting) return {State::kDone, name() + " rests at home"};
    if (phase == AgentPhase::kReturning) return {State::kObeyed, name() + " is on its way home"};
  }
  if (was_on_its_way_)
    return {State::kObeyed, name() + " does not report; it goes on home once it runs again"};
  if (now - since_ < kAnswerPatience)
    return {State::kAnswered, "the coordinator has recalled " + name()};
  return {State::kFailed,
          "the coordinator has recalled " + name() +
              ", but the agent does not report it: it obeys once it receives MISSION"};
}

}  // namespace ergocast::cli
