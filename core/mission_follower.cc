#include "core/mission_follower.h"

#include <algorithm>

namespace ergocast {

bool MissionFollower::receive(const MissionPart& part) {
  if (part.header.sender != kCoordinator || part.revision <= revision_ ||
      part.revision < collecting_revision_ || part.parts < 1 || part.parts > kMaxPlanParts ||
      part.part < 0 || part.part >= part.parts) {
    return false;
  }
  if (part.revision > collecting_revision_ ||
      collected_.size() != static_cast<std::size_t>(part.parts)) {
    collecting_revision_ = part.revision;
    collected_.assign(static_cast<std::size_t>(part.parts), std::nullopt);
  }
  collected_[static_cast<std::size_t>(part.part)] = part;
  if (!std::all_of(collected_.begin(), collected_.end(), [](const auto& p) { return p.has_value(); })) {
    return false;
  }
  commit();
  return true;
}

void MissionFollower::commit() {
  revision_ = collecting_revision_;
  state_ = collected_.front()->state;
  reason_ = collected_.front()->reason;
  roster_.clear();
  plan_.clear();
  parts_.clear();
  for (auto& part : collected_) {
    roster_.insert(roster_.end(), part->roster.begin(), part->roster.end());
    plan_.insert(plan_.end(), part->plan.begin(), part->plan.end());
    parts_.push_back(std::move(*part));
  }
  collected_.clear();
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
