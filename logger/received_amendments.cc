// SPDX-License-Identifier: BSD-3-Clause
// Compares each list with the amendments of former lists.
#include "logger/received_amendments.h"

#include <algorithm>
#include <utility>

namespace ergocast {

ReceivedAmendments::ReceivedAmendments(std::vector<ReceivedAmendment> all, std::vector<Hold> holds)
    : all_(std::move(all)), holds_(std::move(holds)) {}

void ReceivedAmendments::note(const Amendments& list) {
  if (list == newest_) return;
  newest_ = list;
  holds_ = list.holds;
  compare(list);
  for (const Amendment& amendment : list.recent) add(amendment);
  // Those with numbers of their own may be older than what the list names.
  for (const TargetChange& change : list.targets) {
    auto& target =
        add({change.number, AmendmentKind::kTarget, change.from, target_hash(change)}).target;
    if (!target) target = change;
  }
  for (const EndChange& change : list.ends)
    add({change.number, AmendmentKind::kEnd, change.from,
         static_cast<std::uint64_t>(change.tick_count)});
  for (const Zone& zone : list.zones) {
    auto& known = add({zone.number, AmendmentKind::kZone, zone.from, zone_hash(zone)}).zone;
    if (!known) known = zone;
  }
}

/// Marks what the list lacks. It names its newest amendments; older ones are as they were.
void ReceivedAmendments::compare(const Amendments& list) {
  const std::int32_t first = list.recent.empty() ? list.named : list.recent.front().number;
  for (ReceivedAmendment& one : all_) {
    if (one.amendment.number < first) continue;
    one.is_void = std::ranges::find(list.recent, one.amendment) == list.recent.end();
  }
}

/// The entry of an amendment, which is added if it is not known. Others of its number are then
/// void.
ReceivedAmendment& ReceivedAmendments::add(const Amendment& amendment) {
  const auto precedes = [](const ReceivedAmendment& one, const ReceivedAmendment& other) {
    return one.amendment.number < other.amendment.number;
  };
  const auto [begin, end] =
      std::equal_range(all_.begin(), all_.end(), ReceivedAmendment{amendment}, precedes);
  std::for_each(begin, end,
                [&](ReceivedAmendment& one) { one.is_void = one.amendment != amendment; });
  const auto known = std::find_if(begin, end, [](const auto& one) { return !one.is_void; });
  return known != end ? *known : *all_.insert(end, ReceivedAmendment{amendment});
}

std::vector<EndChange> ReceivedAmendments::ends() const {
  std::vector<EndChange> ends;
  for (const ReceivedAmendment& one : all_) {
    const Amendment& amendment = one.amendment;
    if (amendment.kind == AmendmentKind::kEnd && !one.is_void)
      ends.push_back({amendment.number, amendment.from, static_cast<Tick>(amendment.hash)});
  }
  return ends;
}

const ReceivedAmendment* ReceivedAmendments::target_at(Tick tick) const {
  const auto holds = [tick](const ReceivedAmendment& one) {
    return one.target && !one.is_void && one.amendment.from <= tick;
  };
  const auto found = std::find_if(all_.rbegin(), all_.rend(), holds);
  return found == all_.rend() ? nullptr : &*found;
}

const ReceivedAmendment* ReceivedAmendments::unknown_content() const {
  const auto found = std::ranges::find_if(all_, [](const ReceivedAmendment& one) {
    const bool lacks_target = one.amendment.kind == AmendmentKind::kTarget && !one.target;
    const bool lacks_zone = one.amendment.kind == AmendmentKind::kZone && !one.zone;
    return (lacks_target || lacks_zone) && !one.is_void;
  });
  return found == all_.end() ? nullptr : &*found;
}

Amendments ReceivedAmendments::list() const {
  Amendments list;
  list.holds = holds_;
  list.ends = ends();
  for (const ReceivedAmendment& one : all_) {
    if (one.is_void) continue;
    list.named = one.amendment.number + 1;
    list.recent.push_back(one.amendment);
    if (one.zone) list.zones.push_back(*one.zone);
    if (!one.target) continue;
    // A target that was replaced before its tick never holds.
    if (!list.targets.empty() && list.targets.back().from == one.target->from)
      list.targets.pop_back();
    list.targets.push_back(*one.target);
  }
  list.named = std::max({list.named, named_changes(holds_)});
  const auto spare = std::max<std::ptrdiff_t>(
      0, std::ssize(list.recent) - static_cast<std::ptrdiff_t>(kMaxRecentAmendments));
  list.recent.erase(list.recent.begin(), list.recent.begin() + spare);
  return list;
}

}  // namespace ergocast
