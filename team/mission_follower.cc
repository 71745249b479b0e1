// SPDX-License-Identifier: BSD-3-Clause
// Collects the parts of a few revisions side by side, and commits a revision once its parts, new or
// unchanged, are complete.
#include "team/mission_follower.h"

#include <algorithm>
#include <utility>

#include "plan/amendment_list.h"
#include "plan/plan.h"

namespace ergocast {
namespace {

/// The maximum number of incomplete revisions.
/// Limit (Team): unfinished revisions of the mission that a process keeps. Beyond it: the oldest is
/// forgotten.
constexpr std::size_t kMostRevisions = 4;

/// Mixes `value` into `hash`: a multiplication spreads each bit upwards, a shift downwards.
std::uint64_t mixed(std::uint64_t hash, std::uint64_t value) {
  hash = (hash ^ value) * 0x9e3779b97f4a7c15;
  return hash ^ hash >> 29;
}

}  // namespace

std::uint64_t hash_of(const MissionPart& part) {
  std::uint64_t hash = mixed(1, static_cast<std::uint64_t>(part.part));
  const auto add = [&hash](auto value) { hash = mixed(hash, static_cast<std::uint64_t>(value)); };
  add(part.roster.size());
  for (const RosterEntry& entry : part.roster) {
    add(entry.author.agent), add(entry.author.incarnation);
    add(entry.active_from), add(entry.active_until);
    add(entry.forgotten), add(entry.since_tick), add(entry.since_revision);
    add(entry.kind);
    add(entry.recall_revision), add(entry.leaves);
  }
  add(part.plan.size());
  for (const std::byte byte : part.plan) add(byte);
  for (const std::byte byte : part.amendments) add(byte);
  return hash;
}

bool MissionFollower::receive(const MissionPart& part) {
  if (part.header.sender != kCoordinator || part.revision <= revision_ || part.parts < 1 ||
      part.parts > kMaxMissionParts || part.part < 0 || part.part >= part.parts) {
    return false;
  }
  Pages& pages = collected_[part.revision];
  if (pages.size() != static_cast<std::size_t>(part.parts)) {
    pages.assign(static_cast<std::size_t>(part.parts), std::nullopt);
  }
  pages[static_cast<std::size_t>(part.part)] = Page{part, hash_of(part)};
  // A newer revision may lack this part.
  for (auto at = collected_.rbegin(); at != collected_.rend() && at->first >= part.revision; ++at) {
    const auto any = std::find_if(at->second.begin(), at->second.end(),
                                  [](const auto& page) { return page.has_value(); });
    const MissionPart newest = at->first == part.revision ? part : (*any)->part;
    auto parts = completed(newest);
    if (!parts) continue;
    const bool committed = commit(newest, std::move(*parts));
    collected_.erase(newest.revision);
    while (!collected_.empty() && collected_.begin()->first <= revision_) forget_oldest();
    return committed;
  }
  // The rest of the newest revision may be lost with its coordinator, so several are kept.
  if (collected_.size() > kMostRevisions) forget_oldest();
  return false;
}

/// The newest received page of a part, from a revision up to `revision`; null: none.
const MissionFollower::Page* MissionFollower::newest_of(std::size_t part,
                                                        std::int64_t revision) const {
  for (auto at = collected_.upper_bound(revision); at != collected_.begin();) {
    const Pages& pages = (--at)->second;
    if (part < pages.size() && pages[part]) return &*pages[part];
  }
  return part < known_.size() && known_[part] ? &*known_[part] : nullptr;
}

/// The parts of the revision of `newest`, with older ones in place of those that are missing. Two
/// coordinators may give one number to two revisions: their parts are not mixed.
std::optional<std::vector<MissionPart>> MissionFollower::completed(
    const MissionPart& newest) const {
  const auto count = static_cast<std::size_t>(newest.parts);
  std::vector<const Page*> pages;
  std::uint64_t sum = 0;
  bool all_received = true;
  for (std::size_t p = 0; p < count; ++p) {
    const Page* const page = newest_of(p, newest.revision);
    if (page == nullptr) return std::nullopt;
    pages.push_back(page);
    all_received = all_received && page->part.revision == newest.revision &&
                   page->part.content_hash == newest.content_hash;
    sum += page->hash;
  }
  if (!all_received && sum != newest.content_hash) return std::nullopt;
  std::vector<MissionPart> parts;
  for (const Page* page : pages) parts.push_back(page->part);
  return parts;
}

/// Drops the oldest revision, but keeps its parts: a later revision may lack them.
void MissionFollower::forget_oldest() {
  const auto oldest = collected_.begin();
  if (known_.size() < oldest->second.size()) known_.resize(oldest->second.size());
  for (std::size_t p = 0; p < oldest->second.size(); ++p) {
    std::optional<Page>& page = oldest->second[p];
    const bool newer = page && (!known_[p] || known_[p]->part.revision < page->part.revision);
    if (newer) known_[p] = std::move(page);
  }
  collected_.erase(oldest);
}

/// The mission of a plan, or why this program cannot use it.
Result<Mission> MissionFollower::read(const std::vector<std::byte>& plan) const {
  if (!expected_plan_.empty() && plan != expected_plan_) return failure("another mission");
  return needs_table_ ? decode_plan_with_table(plan) : decode_plan(plan);
}

bool MissionFollower::commit(const MissionPart& newest, std::vector<MissionPart> parts) {
  std::vector<std::byte> plan, list;
  for (const MissionPart& part : parts) {
    plan.insert(plan.end(), part.plan.begin(), part.plan.end());
    list.insert(list.end(), part.amendments.begin(), part.amendments.end());
  }
  const bool first = !mission_ && !plan_problem_;
  if (!first && plan != plan_) {
    ++foreign_plans_;
    return false;
  }
  Result<Mission> read_first = first ? read(plan) : failure(std::string());
  const Mission* const mission = read_first ? &*read_first : mission_ ? &*mission_ : nullptr;
  auto amendments = mission != nullptr ? decode_amendments(list, *mission) : Amendments();
  if (!amendments) {
    ++foreign_plans_;
    return false;
  }
  if (first && !read_first) plan_problem_ = read_first.error();
  if (read_first) mission_ = *std::move(read_first);
  plan_ = std::move(plan);
  revision_ = newest.revision;
  state_ = newest.state;
  reason_ = newest.reason;
  amendments_ = *std::move(amendments);
  stand_by_revision_ = newest.stand_by_revision;
  roster_.clear();
  known_.resize(parts.size());
  for (std::size_t p = 0; p < parts.size(); ++p) {
    roster_.insert(roster_.end(), parts[p].roster.begin(), parts[p].roster.end());
    if (!known_[p] || known_[p]->part.revision < parts[p].revision) {
      known_[p] = Page{parts[p], hash_of(parts[p])};
    }
  }
  std::sort(roster_.begin(), roster_.end(),
            [](const RosterEntry& a, const RosterEntry& b) { return a.author < b.author; });
  by_incarnation_.clear();
  for (std::size_t i = 0; i < roster_.size(); ++i) {
    by_incarnation_.emplace_back(roster_[i].author.incarnation, i);
  }
  std::sort(by_incarnation_.begin(), by_incarnation_.end());
  parts_ = std::move(parts);
  return true;
}

const RosterEntry* MissionFollower::entry_of(Incarnation incarnation) const {
  const auto at = std::lower_bound(by_incarnation_.begin(), by_incarnation_.end(),
                                   std::pair(incarnation, std::size_t{0}));
  const bool known = at != by_incarnation_.end() && at->first == incarnation;
  return known ? &roster_[at->second] : nullptr;
}

}  // namespace ergocast
