// SPDX-License-Identifier: BSD-3-Clause
// Waits for the newest revision that any process has named, within limits of time.
#include "coordinator/takeover.h"

#include <algorithm>
#include <chrono>

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

std::int64_t first_revision(const MissionFollower& known, Tick tick) {
  return std::max(known.revision() + kRevisionLead, (tick + 1) * kRevisionLead);
}

void MissionSearch::note_mission(Instant now) {
  if (!found_) found_ = now;
}

MissionSearch::Outcome MissionSearch::look(const OtherCoordinator& other,
                                           const SignsOfLife& signs) {
  const Instant now = signs.now;
  if (!since_) since_ = now;
  if (found_ && now >= end_of_search(other, signs.me.follower())) return Outcome::kFound;
  const auto looked = now - *since_;
  if (takeover_ == Takeover::kIfRunning && signs.me.run() == 0 && looked >= kLookAround) {
    return other.leads(signs) ? Outcome::kLedByOther : Outcome::kNoMission;
  }
  return looked >= kTakeoverPatience && !found_ ? Outcome::kNoAnswer : Outcome::kNone;
}

bool MissionSearch::is_question_due(Instant now) {
  if (now < next_question_) return false;
  next_question_ = now + kQuestionPeriod;
  return true;
}

/// The world and the agents may use a revision whose parts we lack. It may pause ticks that an
/// older one does not.
Instant MissionSearch::end_of_search(const OtherCoordinator& other,
                                     const MissionFollower& known) const {
  const bool newer = std::max(known.newest_heard(), other.newest_of_world()) > known.revision();
  return *found_ + (newer ? Instant::duration(kNewestPatience) : kSecondOpinions);
}

Instant MissionSearch::next_look(const OtherCoordinator& other,
                                 const MissionFollower& known) const {
  if (!since_) return Instant{};
  return found_ ? std::min(next_question_, end_of_search(other, known)) : next_question_;
}

std::optional<std::string> MissionSearch::why_not(const std::vector<std::byte>& plan,
                                                  const OtherCoordinator& other,
                                                  const SignsOfLife& signs) const {
  const MissionFollower& known = signs.me.follower();
  const std::string run = "run " + to_hex(signs.me.run());
  if (known.plan_problem()) return run + ": " + *known.plan_problem();
  if (!plan.empty() && known.plan() != plan) {
    return run + " of another plan (" + known.mission()->name +
           ") is running on this URL: choose another URL, or wait for its end";
  }
  if (takeover_ == Takeover::kIfRunning && other.leads(signs)) return other.why_not_ours();
  return std::nullopt;
}

}  // namespace ergocast
