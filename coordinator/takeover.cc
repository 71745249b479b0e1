// SPDX-License-Identifier: BSD-3-Clause
// How a coordinator takes over a mission that is under way, and yields it to another.
#include <algorithm>
#include <chrono>
#include <utility>

#include "coordinator/coordinator.h"

namespace ergocast {
namespace {

using namespace std::chrono_literals;

/// How long to search for a mission under way: longer than any agent is silent.
constexpr auto kLookAround = 3 * kAgentStatusPeriod / 2;
constexpr auto kQuestionPeriod = 250ms;
/// After the first answer, waits for newer revisions from other agents.
constexpr auto kSecondOpinions = 600ms;
/// How long it asks for the newest revision that any message named. If no agent has all its parts,
/// no agent uses it.
constexpr auto kNewestPatience = 3s;
constexpr auto kTakeoverPatience = 30s;
/// The predecessor may have sent some revisions that no agent has repeated to us.
constexpr std::int64_t kRevisionLead = 1000;

}  // namespace

void Coordinator::on(const MissionPart& part, const Arrival& arrival) {
  if (looking()) {
    if (arrival.mission_changed && !search_.found) search_.found = arrival.now;
    return;
  }
  // If two coordinators took over at once, one stays.
  if (std::pair(part.revision, part.header.incarnation) <=
      std::pair(revisions_.current, me_.incarnation()))
    return;
  if (other_coordinator_alive(arrival.now) &&
      other_coordinator_->header.incarnation == part.header.incarnation) {
    return leave("another coordinator has taken the mission over", arrival.now);
  }
  // An agent repeated a revision of a coordinator that is gone. The team must accept our revisions
  // again. What it paused stays paused: agents may have gone by it.
  const auto known = me_.follower().holds();
  if (arrival.mission_changed && named_changes(known) > named_changes(holds_))
    holds_.assign(known.begin(), known.end());
  revisions_.current = part.revision;
  change();
}

/// The world may name a revision of a predecessor that no agent received. The team then waits for
/// that roster or a newer one, so we send a higher revision. But the world may also be the first to
/// name a revision of a running coordinator that took over from us. So we first wait for messages
/// of that coordinator.
void Coordinator::supersede_dead_coordinator(Instant now) {
  if (world_.newest_revision <= revisions_.current) return world_.newer_since.reset();
  if (other_coordinator_alive(now) || now - *world_.newer_since <= silence_of(kCoordinator)) return;
  revisions_.current = world_.newest_revision;
  world_.newer_since.reset();
  change();
}

void Coordinator::on(const TeamStatus& theirs, const Arrival& arrival) {
  if (arrival.fresh) other_coordinator_ = theirs;
}

bool Coordinator::other_coordinator_alive(Instant now) const {
  return other_coordinator_ &&
         !me_.silent({kCoordinator, other_coordinator_->header.incarnation}, now);
}

/// Whether a live coordinator leads the mission that we would take over. While we know of none, any
/// live coordinator counts.
bool Coordinator::other_coordinator_leads(Instant now) const {
  const auto leads = [](MissionState state) {
    return state == MissionState::kWaiting || state == MissionState::kRunning;
  };
  return other_coordinator_alive(now) && leads(other_coordinator_->state) &&
         (me_.run() == 0 || other_coordinator_->header.run == me_.run());
}

std::string Coordinator::led_by_other_coordinator() const {
  return "run " + to_hex(other_coordinator_->header.run) + " is led by the coordinator on " +
         other_coordinator_->host +
         ": leave it to that one, choose another URL, or take the mission over with --resume";
}

/// Finishes at once and silently: the mission is not ours to end.
void Coordinator::leave(std::string reason, Instant now) {
  end(true, std::move(reason), now);
  ending_.finished = ending_.left = true;
}

void Coordinator::look_for_mission(Instant now, Outbox& out) {
  if (ending_.since) {
    ending_.finished = true;  // the operator stops it before it leads a mission
    return;
  }
  if (!search_.since) search_.since = now;
  if (search_.found && now >= end_of_search()) return take_over(now);
  const auto looked = now - *search_.since;
  if (search_.takeover == Takeover::kIfRunning && me_.run() == 0 && looked >= kLookAround) {
    return other_coordinator_leads(now) ? leave(led_by_other_coordinator(), now) : begin_own();
  }
  if (looked >= kTakeoverPatience && !search_.found) {
    leave("no agent on this URL knows a mission to take over", now);
  }
  if (now < search_.next_question) return;
  search_.next_question = now + kQuestionPeriod;
  if (me_.run() == 0) return;
  me_.publish(Bus::kSwarm, Hello{}, -1, out);
}

/// The world and the agents may use a revision whose parts we lack. It may pause ticks that an
/// older one does not.
Instant Coordinator::end_of_search() const {
  const MissionFollower& known = me_.follower();
  const bool newer = std::max(known.newest_heard(), world_.newest_revision) > known.revision();
  return *search_.found + (newer ? Instant::duration(kNewestPatience) : kSecondOpinions);
}

Instant Coordinator::next_look() const {
  if (!search_.since) return Instant{};
  return search_.found ? std::min(search_.next_question, end_of_search()) : search_.next_question;
}

void Coordinator::begin_own() {
  search_.takeover = Takeover::kNever;
  me_.set_run(me_.incarnation());
}

/// Why the mission under way cannot be taken over; nothing if it can.
std::optional<std::string> Coordinator::not_ours(Instant now) const {
  const std::string run = "run " + to_hex(me_.run());
  if (me_.follower().plan_problem()) return run + ": " + *me_.follower().plan_problem();
  if (!led_.plan.empty() && me_.follower().plan() != led_.plan) {
    return run + " of another plan (" + me_.follower().mission()->name +
           ") is running on this URL: choose another URL, or wait for its end";
  }
  if (search_.takeover == Takeover::kIfRunning && other_coordinator_leads(now))
    return led_by_other_coordinator();
  return std::nullopt;
}

void Coordinator::take_over(Instant now) {
  const auto problem = not_ours(now);
  search_.takeover = Takeover::kNever;
  if (problem) return leave(*problem, now);
  led_.taken_over = true;
  led_.mission = me_.follower().mission();
  led_.plan = me_.follower().plan();
  roster_ = me_.follower().roster();
  state_ = me_.follower().state();
  ending_.reason = me_.follower().reason();
  // The world may have stopped, too. Then the tick of the predecessor or of the agents counts.
  for (const MissionPart& part : me_.follower().parts())
    world_.tick = std::max(world_.tick, part.header.tick);
  holds_.assign(me_.follower().holds().begin(), me_.follower().holds().end());
  team_tick_ = std::min(team_tick_, end_tick());
  world_.tick = std::max(std::min(world_.tick, end_tick()), team_tick_);
  // Our revision must exceed those of former successors, also those that only unreachable agents
  // know. So a later takeover gets higher revisions.
  revisions_.current =
      std::max(me_.follower().revision() + kRevisionLead, (world_.tick + 1) * kRevisionLead);
  revisions_.who_may_join = revisions_.current;
  // The world stands by for us at its next tick, the first under our revision.
  if (me_.follower().stand_by_revision() >= 0) stand_by_revision_ = revisions_.current;
  if (me_.follower().over()) ending_.since = now;
  world_.tick_since = now;
  for (const RosterEntry& entry : roster_) {
    members_[entry.author];
    admissions_.emplace(entry.author, admissions_.size());
    me_.presume_alive(entry.author, now);
  }
}

}  // namespace ergocast
