// SPDX-License-Identifier: BSD-3-Clause
// How a coordinator comes by a mission that is already flying, and gives it up to another.
#include <algorithm>
#include <chrono>
#include <utility>

#include "coordinator/coordinator.h"

namespace ergocast {
namespace {

using namespace std::chrono_literals;

/// How long to look for a mission under way: longer than any agent is silent.
constexpr auto kLookAround = 3 * kAgentStatusPeriod / 2;
constexpr auto kQuestionPeriod = 250ms;
/// After the first answer, for newer revisions from agents that heard more of the predecessor.
constexpr auto kSecondOpinions = 600ms;
constexpr auto kTakeoverPatience = 30s;
/// The predecessor may have said some revisions that nobody has repeated to us.
constexpr std::int64_t kRevisionLead = 1000;

}  // namespace

void Coordinator::on(const MissionPart& part, const Arrival& arrival) {
  if (looking()) {
    if (arrival.mission_changed && !search_.found) search_.found = arrival.now;
    return;
  }
  // Of two that took over at once, one stays.
  if (std::pair(part.revision, part.header.incarnation) <= std::pair(revisions_.current, me_.incarnation())) return;
  if (rival_lives(arrival.now) && rival_->header.incarnation == part.header.incarnation) {
    return leave("another coordinator has taken the mission over", arrival.now);
  }
  // What a dead one said and an agent has repeated: the team has to listen to us again.
  revisions_.current = part.revision;
  change();
}

void Coordinator::on(const TeamStatus& theirs, const Arrival& arrival) {
  if (arrival.fresh) rival_ = theirs;
}

bool Coordinator::rival_lives(Instant now) const {
  return rival_ && !me_.silent({kCoordinator, rival_->header.incarnation}, now);
}

/// Whether a living one leads the mission that we would take over, or, while we know of none, any.
bool Coordinator::rival_leads(Instant now) const {
  const auto leads = [](MissionState state) {
    return state == MissionState::kWaiting || state == MissionState::kRunning;
  };
  return rival_lives(now) && leads(rival_->state) && (me_.run() == 0 || rival_->header.run == me_.run());
}

std::string Coordinator::led_by_rival() const {
  return "run " + to_hex(rival_->header.run) + " is led by the coordinator on " + rival_->host +
         ": leave it to that one, choose another URL, or take the mission over with --resume";
}

/// At once, without a word: the mission is not ours to end.
void Coordinator::leave(std::string reason, Instant now) {
  end(true, std::move(reason), now);
  ending_.finished = ending_.left = true;
}

void Coordinator::look_for_mission(Instant now, Outbox& out) {
  if (ending_.since) {
    ending_.finished = true;  // told to stop; the mission is not ours yet
    return;
  }
  if (!search_.since) search_.since = now;
  if (search_.found && now - *search_.found >= kSecondOpinions) return take_over(now);
  const auto looked = now - *search_.since;
  if (search_.takeover == Takeover::kIfRunning && me_.run() == 0 && looked >= kLookAround) {
    return rival_leads(now) ? leave(led_by_rival(), now) : begin_own();
  }
  if (looked >= kTakeoverPatience) {
    leave("no agent on this URL knows a mission that could be taken over", now);
  }
  if (now < search_.next_question) return;
  search_.next_question = now + kQuestionPeriod;
  if (me_.run() == 0) return;
  me_.publish(Bus::kSwarm, Hello{}, -1, out);
}

Instant Coordinator::next_look() const {
  if (!search_.since) return Instant{};
  return std::min(search_.next_question, search_.found ? *search_.found + kSecondOpinions : Instant::max());
}

void Coordinator::begin_own() {
  search_.takeover = Takeover::kNever;
  me_.set_run(me_.incarnation());
}

/// Why the mission under way cannot be taken over.
std::optional<std::string> Coordinator::not_ours(Instant now) const {
  const std::string run = "run " + to_hex(me_.run());
  if (me_.follower().plan_problem()) return run + ": " + *me_.follower().plan_problem();
  if (!flown_.plan.empty() && me_.follower().plan() != flown_.plan) {
    return run + " of another plan (" + me_.follower().mission()->name +
           ") is flying on this URL: choose another URL, or wait for its end";
  }
  if (search_.takeover == Takeover::kIfRunning && rival_leads(now)) return led_by_rival();
  return std::nullopt;
}

void Coordinator::take_over(Instant now) {
  const auto problem = not_ours(now);
  search_.takeover = Takeover::kNever;
  if (problem) return leave(*problem, now);
  flown_.taken_over = true;
  flown_.mission = me_.follower().mission();
  flown_.plan = me_.follower().plan();
  roster_ = me_.follower().roster();
  state_ = me_.follower().state();
  ending_.reason = me_.follower().reason();
  // The predecessor's or the agents', if the world has not spoken meanwhile: it may have died, too.
  for (const MissionPart& part : me_.follower().parts()) world_.tick = std::max(world_.tick, part.header.tick);
  team_tick_ = std::min(team_tick_, timing().tick_count);
  world_.tick = std::max(std::min(world_.tick, timing().tick_count), team_tick_);
  // Above all that former successors have said, also what only agents know that we do not hear: the
  // later a takeover, the higher its revisions.
  revisions_.current = std::max(me_.follower().revision() + kRevisionLead, (world_.tick + 1) * kRevisionLead);
  revisions_.who_may_join = revisions_.current;
  if (me_.follower().over()) ending_.since = now;
  world_.tick_since = now;
  for (const RosterEntry& entry : roster_) {
    members_[entry.author];
    me_.presume_alive(entry.author, now);
  }
}

}  // namespace ergocast
