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
/// A coordinator whose TEAM_STATUS, which nobody repeats, was heard within this time is alive.
constexpr auto kRivalLife = 1s;
/// After the first answer, for newer revisions from agents that heard more of the predecessor.
constexpr auto kSecondOpinions = 600ms;
constexpr auto kTakeoverPatience = 30s;
/// The predecessor may have said some revisions that nobody has repeated to us.
constexpr std::int64_t kRevisionLead = 1000;

}  // namespace

void Coordinator::on(const MissionPart& part, Instant now) {
  if (part.header.incarnation == incarnation_) return;
  if (takeover_ != Takeover::kNever) {
    if (follower_.receive(part) && !found_) found_ = now;
    return;
  }
  // Of two that took over at once, one stays.
  if (std::pair(part.revision, part.header.incarnation) <= std::pair(revision_, incarnation_)) return;
  if (rival_lives(now) && rival_->header.incarnation == part.header.incarnation) {
    return leave("another coordinator has taken the mission over", now);
  }
  // What a dead one said and an agent has repeated: the team has to listen to us again.
  revision_ = part.revision;
  change();
}

void Coordinator::on(const TeamStatus& theirs, Instant now) {
  if (theirs.header.incarnation == incarnation_ || !freshness_.is_news(theirs.header)) return;
  rival_ = theirs;
  rival_heard_ = now;
}

bool Coordinator::rival_lives(Instant now) const {
  return rival_ && now - rival_heard_ < kRivalLife;
}

/// Whether a living one leads the mission that we would take over, or, while we know of none, any.
bool Coordinator::rival_leads(Instant now) const {
  const auto leads = [](MissionState state) {
    return state == MissionState::kWaiting || state == MissionState::kRunning;
  };
  return rival_lives(now) && leads(rival_->state) && (run_ == 0 || rival_->header.run == run_);
}

std::string Coordinator::led_by_rival() const {
  return "run " + to_hex(rival_->header.run) + " is led by the coordinator on " + rival_->host +
         ": leave it to that one, choose another URL, or take the mission over with --resume";
}

/// At once, without a word: the mission is not ours to end.
void Coordinator::leave(std::string reason, Instant now) {
  end(true, std::move(reason), now);
  finished_ = left_ = true;
}

void Coordinator::look_for_mission(Instant now, Outbox& out) {
  if (ended_) {
    finished_ = true;  // told to stop; the mission is not ours yet
    return;
  }
  if (!looking_since_) looking_since_ = now;
  if (found_ && now - *found_ >= kSecondOpinions) return take_over(now);
  const auto looked = now - *looking_since_;
  if (takeover_ == Takeover::kIfFlying && run_ == 0 && looked >= kLookAround) {
    return rival_leads(now) ? leave(led_by_rival(), now) : begin_own();
  }
  if (looked >= kTakeoverPatience) {
    leave("no agent on this URL knows a mission that could be taken over", now);
  }
  if (now < next_question_) return;
  next_question_ = now + kQuestionPeriod;
  if (run_ == 0) return;
  Hello question;
  question.header = header(Bus::kSwarm);
  question.header.tick = -1;
  out.push_back({Bus::kSwarm, question});
}

Instant Coordinator::next_look() const {
  if (!looking_since_) return Instant{};
  return std::min(next_question_, found_ ? *found_ + kSecondOpinions : Instant::max());
}

void Coordinator::begin_own() {
  takeover_ = Takeover::kNever;
  run_ = incarnation_;
}

/// Why the mission under way cannot be taken over.
std::optional<std::string> Coordinator::not_ours(Instant now) const {
  const std::string run = "run " + to_hex(run_);
  if (follower_.plan_problem()) return run + ": " + *follower_.plan_problem();
  if (!plan_.empty() && follower_.plan() != plan_) {
    return run + " of another plan (" + follower_.mission()->name +
           ") is flying on this URL: choose another URL, or wait for its end";
  }
  if (takeover_ == Takeover::kIfFlying && rival_leads(now)) return led_by_rival();
  return std::nullopt;
}

void Coordinator::take_over(Instant now) {
  const auto problem = not_ours(now);
  takeover_ = Takeover::kNever;
  if (problem) return leave(*problem, now);
  took_over_ = true;
  mission_ = follower_.mission();
  plan_ = follower_.plan();
  roster_ = follower_.roster();
  state_ = follower_.state();
  reason_ = follower_.reason();
  // The predecessor's or the agents', if the world has not spoken meanwhile: it may have died, too.
  for (const MissionPart& part : follower_.parts()) tick_ = std::max(tick_, part.header.tick);
  team_tick_ = std::min(team_tick_, mission_->timing.tick_count);
  tick_ = std::max(std::min(tick_, mission_->timing.tick_count), team_tick_);
  // Above all that former successors have said, also what only agents know that we do not hear: the
  // later a takeover, the higher its revisions.
  revision_ = std::max(follower_.revision() + kRevisionLead, (tick_ + 1) * kRevisionLead);
  who_may_join_ = revision_;
  if (follower_.over()) ended_ = now;
  tick_since_ = now;
  for (const RosterEntry& entry : roster_) members_[entry.author].heard = now;
}

}  // namespace ergocast
