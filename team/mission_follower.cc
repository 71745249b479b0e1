// SPDX-License-Identifier: BSD-3-Clause
// Collects the parts of a few revisions side by side, and commits a revision once all its parts
// agree.
#include "team/mission_follower.h"

#include <algorithm>
#include <utility>
#include <variant>

#include "team/plan.h"

namespace ergocast {
namespace {

/// The maximum number of incomplete revisions.
constexpr std::size_t kMostRevisions = 4;

}  // namespace

bool MissionFollower::receive(const MissionPart& part) {
  if (part.header.sender != kCoordinator || part.revision <= revision_ || part.parts < 1 ||
      part.parts > kMaxPlanParts || part.part < 0 || part.part >= part.parts) {
    return false;
  }
  Parts& parts = collected_[part.revision];
  if (parts.size() != static_cast<std::size_t>(part.parts)) {
    parts.assign(static_cast<std::size_t>(part.parts), std::nullopt);
  }
  parts[static_cast<std::size_t>(part.part)] = part;
  if (std::all_of(parts.begin(), parts.end(), [](const auto& p) { return p.has_value(); })) {
    const bool committed = commit(part.revision, parts);
    collected_.erase(part.revision);
    collected_.erase(collected_.begin(), collected_.upper_bound(revision_));
    return committed;
  }
  // The rest of the newest revision may be lost with its coordinator, so several are kept.
  if (collected_.size() > kMostRevisions) collected_.erase(collected_.begin());
  return false;
}

bool MissionFollower::commit(std::int64_t revision, Parts& parts) {
  std::vector<std::byte> plan;
  for (const auto& part : parts) plan.insert(plan.end(), part->plan.begin(), part->plan.end());
  const bool first = !mission_ && !plan_problem_;
  if (!first && plan != plan_) {
    ++foreign_plans_;
    return false;
  }
  plan_ = std::move(plan);
  revision_ = revision;
  state_ = parts.front()->state;
  reason_ = parts.front()->reason;
  roster_.clear();
  parts_.clear();
  for (auto& part : parts) {
    roster_.insert(roster_.end(), part->roster.begin(), part->roster.end());
    parts_.push_back(std::move(*part));
  }
  by_incarnation_.clear();
  for (std::size_t i = 0; i < roster_.size(); ++i) {
    by_incarnation_.emplace_back(roster_[i].author.incarnation, i);
  }
  std::sort(by_incarnation_.begin(), by_incarnation_.end());
  if (!first) return true;
  if (!expected_plan_.empty() && plan_ != expected_plan_) {
    plan_problem_ = "another mission";
    return true;
  }
  auto decoded = decode_plan(plan_);
  if (auto* mission = std::get_if<Mission>(&decoded)) mission_ = std::move(*mission);
  if (auto* problem = std::get_if<std::string>(&decoded)) plan_problem_ = std::move(*problem);
  return true;
}

const RosterEntry* MissionFollower::entry_of(Incarnation incarnation) const {
  const auto at = std::lower_bound(by_incarnation_.begin(), by_incarnation_.end(),
                                   std::pair(incarnation, std::size_t{0}));
  const bool known = at != by_incarnation_.end() && at->first == incarnation;
  return known ? &roster_[at->second] : nullptr;
}

}  // namespace ergocast
