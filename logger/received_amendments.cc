// SPDX-License-Identifier: BSD-3-Clause
// Compares each list with the amendments of former lists.
#include "logger/received_amendments.h"

#include <algorithm>
#include <utility>

namespace ergocast {
namespace {

/// Whether they are one amendment. The contents of a list do not name the operator.
bool same(const Amendment& one, const Amendment& other) {
  return one.number == other.number && one.kind == other.kind && one.from == other.from &&
         one.hash == other.hash;
}

/// Appends a target or law. One that was replaced before its tick never holds.
template <class Change>
void push_over(std::vector<Change>& changes, const Change& change) {
  if (!changes.empty() && changes.back().from == change.from) changes.pop_back();
  changes.push_back(change);
}

}  // namespace

Tick cancelled_at(std::int32_t number, std::span<const Zone> listed,
                  std::span<const Amendment> known) {
  const auto zone = std::ranges::find(listed, number, &Zone::number);
  if (zone != listed.end()) return zone->cancelled;
  const auto cancels = [number](const Amendment& one) {
    return one.kind == AmendmentKind::kReopen && one.hash == static_cast<std::uint64_t>(number);
  };
  const auto named = std::ranges::find_if(known, cancels);
  return named == known.end() ? -1 : named->from;
}

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
  for (const LawChange& change : list.laws) {
    auto& known = add({change.number, AmendmentKind::kLaw, change.from, law_hash(change)}).law;
    if (!known) known = change;
  }
  for (const SearchNote& note : list.notes) take_in(note);
  note_cancelled(list);
}

/// A sighting belongs to the target of its number.
void ReceivedAmendments::take_in(const SearchNote& note) {
  if (!note.is_sighting()) {
    add({note.number, AmendmentKind::kDismiss, note.from, search_note_hash(note)}).note = note;
    return;
  }
  for (ReceivedAmendment& one : all_)
    if (one.amendment.number == note.number && !one.is_void) one.note = note;
}

/// Notes which zones are cancelled. An amendment that is void cancels nothing.
void ReceivedAmendments::note_cancelled(const Amendments& list) {
  std::vector<Amendment> known;
  for (const ReceivedAmendment& one : all_)
    if (!one.is_void) known.push_back(one.amendment);
  for (ReceivedAmendment& one : all_)
    if (one.zone && !one.is_void)
      one.zone->cancelled = cancelled_at(one.amendment.number, list.zones, known);
}

/// Marks what the list lacks. It names its newest amendments; older ones are as they were.
void ReceivedAmendments::compare(const Amendments& list) {
  const std::int32_t first = list.recent.empty() ? list.named : list.recent.front().number;
  for (ReceivedAmendment& one : all_) {
    if (one.amendment.number < first) continue;
    one.is_void = std::ranges::none_of(
        list.recent, [&one](const Amendment& listed) { return same(listed, one.amendment); });
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
                [&](ReceivedAmendment& one) { one.is_void = !same(one.amendment, amendment); });
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

std::vector<SearchNote> ReceivedAmendments::notes() const {
  std::vector<SearchNote> notes;
  for (const ReceivedAmendment& one : all_) {
    if (one.is_void) continue;
    if (one.amendment.kind == AmendmentKind::kTarget)
      std::erase_if(notes, [&one](const SearchNote& note) {
        return note.is_sighting() && note.from == one.amendment.from;
      });
    if (one.note) notes.push_back(*one.note);
  }
  return notes;
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
    const bool lacks_law = one.amendment.kind == AmendmentKind::kLaw && !one.law;
    const bool lacks_note = one.amendment.kind == AmendmentKind::kDismiss && !one.note;
    return (lacks_target || lacks_zone || lacks_law || lacks_note) && !one.is_void;
  });
  return found == all_.end() ? nullptr : &*found;
}

Amendments ReceivedAmendments::list() const {
  Amendments list;
  list.holds = holds_;
  list.ends = ends();
  list.notes = notes();
  for (const ReceivedAmendment& one : all_) {
    if (one.is_void) continue;
    list.named = one.amendment.number + 1;
    list.recent.push_back(one.amendment);
    if (one.zone) list.zones.push_back(*one.zone);
    if (one.target) push_over(list.targets, *one.target);
    if (one.law) push_over(list.laws, *one.law);
  }
  list.named = std::max({list.named, named_changes(holds_)});
  const auto spare = std::max<std::ptrdiff_t>(
      0, std::ssize(list.recent) - static_cast<std::ptrdiff_t>(kMaxRecentAmendments));
  list.recent.erase(list.recent.begin(), list.recent.begin() + spare);
  return list;
}

}  // namespace ergocast
