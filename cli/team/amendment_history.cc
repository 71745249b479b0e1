// SPDX-License-Identifier: BSD-3-Clause
// Replaces what it knows by a newer list from that list's first amendment on. A target is known by
// its hash.
#include "cli/team/amendment_history.h"

#include <algorithm>
#include <span>
#include <utility>

#include "logger/received_amendments.h"
#include "report/page_mission.h"

namespace ergocast {
namespace {

/// Takes in the newest zones, and forgets those whose amendments are not known any more.
void replace_zones(std::span<const Zone> listed, std::span<const Amendment> known,
                   std::vector<Zone>& zones) {
  std::erase_if(zones, [&](const Zone& zone) {
    const bool in_list = std::ranges::find(listed, zone.number, &Zone::number) != listed.end();
    const auto amendment = std::ranges::find(known, zone.number, &Amendment::number);
    return in_list || amendment == known.end() || amendment->hash != zone_hash(zone);
  });
  zones.insert(zones.end(), listed.begin(), listed.end());
  std::ranges::sort(zones, {}, &Zone::number);
  for (Zone& zone : zones) zone.cancelled = cancelled_at(zone.number, listed, known);
}

/// Replaces those from the amendment `first` on, and forgets those before `oldest`.
void replace_from(std::int32_t first, std::int32_t oldest, const auto& listed, auto& known) {
  std::erase_if(known, [&](const auto& one) { return one.number >= first || one.number < oldest; });
  for (const auto& one : listed)
    if (one.number >= first) known.push_back(one);
}

}  // namespace

void AmendmentHistory::note(const Amendments& list) {
  for (const TargetChange& change : list.targets) keep(change);
  const std::int32_t first = list.recent.empty() ? list.named : list.recent.front().number;
  std::vector<Amendment> all = amendments_;
  std::erase_if(all, [first](const Amendment& one) { return one.number >= first; });
  all.insert(all.end(), list.recent.begin(), list.recent.end());
  if (all.size() > kMost) all.erase(all.begin(), all.end() - kMost);
  if (all == amendments_) return;
  amendments_ = std::move(all);
  const std::int32_t oldest = amendments_.empty() ? first : amendments_.front().number;
  replace_zones(list.zones, amendments_, zones_);
  replace_from(first, oldest, list.laws, laws_);
  replace_from(first, oldest, list.notes, notes_);
  ++changes_;
}

void AmendmentHistory::keep(const TargetChange& change) {
  const std::uint64_t hash = target_hash(change);
  if (std::ranges::find(targets_, hash, &Target::hash) != targets_.end()) return;
  targets_.push_back({hash, page_target(change)});
  ++targets_ever_;
  if (targets_.size() > kMostTargets) targets_.pop_front();
}

void AmendmentHistory::add_new(Cursor& cursor, const Mission& mission,
                               nlohmann::ordered_json& frame) const {
  if (cursor.changes == changes_) return;
  auto& targets = frame["targets"] = nlohmann::ordered_json::object();
  const auto fresh = std::min<std::uint64_t>(targets_ever_ - cursor.targets, targets_.size());
  for (auto at = targets_.end() - static_cast<std::ptrdiff_t>(fresh); at != targets_.end(); ++at)
    targets[page_target_name(at->hash)] = at->coefficients;
  frame["amendments"] = page_amendments(amendments_, laws_, notes_, mission);
  frame["zones"] = page_zones(zones_, mission.domain);
  cursor = {changes_, targets_ever_};
}

}  // namespace ergocast
