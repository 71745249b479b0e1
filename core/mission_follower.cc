#include "core/mission_follower.h"

#include <algorithm>

namespace ergocast {
namespace {

/// Incomplete revisions that are kept.
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
    commit(part.revision, parts);
    collected_.erase(collected_.begin(), collected_.upper_bound(revision_));
    return true;
  }
  // Several at once: the rest of the newest may have died with its coordinator.
  if (collected_.size() > kMostRevisions) collected_.erase(collected_.begin());
  return false;
}

void MissionFollower::commit(std::int64_t revision, Parts& parts) {
  revision_ = revision;
  state_ = parts.front()->state;
  reason_ = parts.front()->reason;
  roster_.clear();
  plan_.clear();
  parts_.clear();
  for (auto& part : parts) {
    roster_.insert(roster_.end(), part->roster.begin(), part->roster.end());
    plan_.insert(plan_.end(), part->plan.begin(), part->plan.end());
    parts_.push_back(std::move(*part));
  }
  // A run has one plan: it is decoded once, and later revisions change only roster and state.
  if (mission_ || plan_unreadable_) return;
  mission_ = decode_plan_(plan_);
  plan_unreadable_ = !mission_;
}

const RosterEntry* MissionFollower::entry_of(Incarnation incarnation) const {
  const auto at = std::find_if(roster_.begin(), roster_.end(), [&](const RosterEntry& entry) {
    return entry.author.incarnation == incarnation;
  });
  return at == roster_.end() ? nullptr : &*at;
}

}  // namespace ergocast
