// SPDX-License-Identifier: BSD-3-Clause
// Appends to a mission's list of amendments, and checks lists that have arrived.
#include "core/mission/amendments.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "core/base/require.h"

namespace ergocast {
namespace {

/// |∫ f ρ| ≤ 1, up to the rounding of the quadrature.
bool are_target(const Coefficients& numbers, int mode_count) {
  return numbers.size() == mode_count && numbers[0] == 1 &&
         std::ranges::all_of(numbers, [](double value) { return std::abs(value) <= 1 + 1e-9; });
}

bool equal(const Coefficients& a, const Coefficients& b) {
  return a.size() == b.size() && std::ranges::equal(a, b);
}

void name(Amendments& list, Amendment amendment) {
  ERGOCAST_REQUIRE(list.named < kMaxAmendments);
  amendment.number = list.named++;
  if (list.recent.size() == kMaxRecentAmendments) list.recent.erase(list.recent.begin());
  list.recent.push_back(std::move(amendment));
}

/// Whether numbers ascend below `named`, and ticks are possible.
bool ascend(const auto& entries, std::int32_t named) {
  std::int32_t next = 0;
  for (const auto& entry : entries) {
    if (entry.number < next || entry.number >= named || entry.from < 0) return false;
    next = entry.number + 1;
  }
  return true;
}

/// Whether each holds later than the one before.
bool follow(const auto& changes) {
  for (std::size_t i = 1; i < changes.size(); ++i)
    if (changes[i].from <= changes[i - 1].from) return false;
  return true;
}

bool are_laws(std::span<const LawChange> laws, const Mission& mission) {
  return laws.size() <= kMaxLaws && follow(laws) &&
         std::ranges::all_of(
             laws, [&mission](const LawChange& one) { return bounded_by_plan(one, mission); });
}

bool are_ends(std::span<const EndChange> ends) {
  if (ends.size() > kMaxEnds) return false;
  Tick from = 0;
  return std::ranges::all_of(ends, [&from](const EndChange& change) {
    return change.tick_count >= 1 && change.from >= std::exchange(from, change.from);
  });
}

}  // namespace

const char* to_string(AmendmentKind kind) {
  constexpr const char* kNames[] = {"pause", "resume", "target", "end",
                                    "zone",  "law",    "reopen", "dismiss"};
  return kNames[static_cast<int>(kind)];
}

bool is_operator_name(std::string_view name) {
  return name.size() <= kMaxOperatorNameLength &&
         std::ranges::all_of(name, [](char c) { return c >= ' ' && c <= '~'; });
}

std::string operator_name_of(std::string_view text) {
  std::string name(text.substr(0, kMaxOperatorNameLength));
  std::ranges::replace_if(
      name, [](char c) { return c < ' ' || c > '~'; }, '?');
  return name;
}

bool TargetChange::operator==(const TargetChange& other) const {
  return number == other.number && from == other.from && equal(target, other.target) &&
         equal(cosine, other.cosine);
}

std::uint64_t target_hash(const TargetChange& change) {
  std::uint64_t hash = 1;
  for (const Coefficients* numbers : {&change.target, &change.cosine}) {
    for (const double value : *numbers) {
      hash = (hash ^ std::bit_cast<std::uint64_t>(value)) * 0x9e3779b97f4a7c15;
      hash ^= hash >> 29;
    }
  }
  return hash;
}

bool is_target(const Coefficients& target, const Coefficients& cosine, const Mission& mission) {
  const int count = mission.basis.mode_count();
  if (!are_target(target, count)) return false;
  return mission.basis.free_domain ? are_target(cosine, count) : cosine.size() == 0;
}

bool are_amendments(const Amendments& list, const Mission& mission) {
  return list.named >= 0 && list.named <= kMaxAmendments && are_holds(list.holds) &&
         named_changes(list.holds) <= list.named && list.recent.size() <= kMaxRecentAmendments &&
         ascend(list.recent, list.named) && ascend(list.targets, list.named) &&
         follow(list.targets) && ascend(list.ends, list.named) && are_ends(list.ends) &&
         std::ranges::all_of(list.targets,
                             [&mission](const TargetChange& change) {
                               return is_target(change.target, change.cosine, mission);
                             }) &&
         ascend(list.zones, list.named) && are_zones(list.zones, mission.domain) &&
         ascend(list.laws, list.named) && are_laws(list.laws, mission) &&
         ascend(list.notes, list.named) && are_search_notes(list.notes, mission) &&
         std::ranges::all_of(list.recent, is_operator_name, &Amendment::by);
}

Amendments only_pauses(std::vector<Hold> holds) {
  Amendments list;
  for (const Hold& hold : holds) {
    name(list, {.kind = AmendmentKind::kPause, .from = hold.from});
    if (!hold.open()) name(list, {.kind = AmendmentKind::kResume, .from = hold.until});
  }
  list.holds = std::move(holds);
  return list;
}

const TargetChange* target_at(std::span<const TargetChange> targets, Tick tick) {
  const auto found =
      std::find_if(targets.rbegin(), targets.rend(),
                   [tick](const TargetChange& change) { return change.from <= tick; });
  return found == targets.rend() ? nullptr : &*found;
}

Tick notice_ticks(const Timing& timing) {
  constexpr double kNotice_s = 2;
  if (timing.pace == Pace::kLockstep) return 0;
  return static_cast<Tick>(kNotice_s * timing.realtime_factor / timing.dt_s);
}

void name_pause(Amendments& list, Tick tick) {
  if (is_open(list.holds)) {
    // Real time: the operator may resume before the hold has begun.
    Hold& last = list.holds.back();
    last.until = std::max(tick, last.from + 1);
    return name(list, {.kind = AmendmentKind::kResume, .from = last.until});
  }
  ERGOCAST_REQUIRE(list.holds.size() < kMaxHolds);
  list.holds.push_back({list.holds.empty() ? tick : std::max(tick, list.holds.back().until)});
  name(list, {.kind = AmendmentKind::kPause, .from = list.holds.back().from});
}

void add_target(Amendments& list, Tick tick, TargetChange change) {
  change.from = list.targets.empty() ? tick : std::max(tick, list.targets.back().from + 1);
  change.number = list.named;
  name(list, {.kind = AmendmentKind::kTarget, .from = change.from, .hash = target_hash(change)});
  list.targets.push_back(std::move(change));
}

void name_target(Amendments& list, Tick tick, TargetChange change) {
  // The second newest holds until the newest one does.
  if (list.targets.size() > 1) list.targets.erase(list.targets.begin(), list.targets.end() - 1);
  add_target(list, tick, std::move(change));
}

void replace_target(Amendments& list, TargetChange change) {
  ERGOCAST_REQUIRE(!list.targets.empty());
  std::erase_if(list.notes, [number = list.targets.back().number](const SearchNote& note) {
    return note.number == number;
  });
  change.from = list.targets.back().from;
  change.number = list.named;
  name(list, {.kind = AmendmentKind::kTarget, .from = change.from, .hash = target_hash(change)});
  list.targets.back() = std::move(change);
}

void name_end(Amendments& list, Tick tick, Tick tick_count) {
  ERGOCAST_REQUIRE(list.ends.size() < kMaxEnds);
  if (!list.ends.empty()) tick = std::max(tick, list.ends.back().from);
  list.ends.push_back({list.named, tick, tick_count});
  name(list,
       {.kind = AmendmentKind::kEnd, .from = tick, .hash = static_cast<std::uint64_t>(tick_count)});
}

void add_zone(Amendments& list, Tick closed, Tick notice, Zone zone) {
  const Tick lasts = zone.until - zone.from;
  zone.number = list.named;
  zone.closed = closed;
  zone.from = closed + notice;
  zone.until = zone.from + lasts;
  name(list, {.kind = AmendmentKind::kZone, .from = zone.from, .hash = zone_hash(zone)});
  list.zones.push_back(std::move(zone));
}

void name_zone(Amendments& list, Tick now, Tick closed, Tick notice, Zone zone) {
  list.zones = not_ended(list.zones, now);
  ERGOCAST_REQUIRE(list.zones.size() < kMaxZones);
  add_zone(list, closed, notice, std::move(zone));
}

bool can_reopen(const Amendments& list, std::int32_t number, Tick tick) {
  const auto zone = std::ranges::find(list.zones, number, &Zone::number);
  return zone != list.zones.end() && zone->cancelled < 0 && tick < zone->until;
}

void name_reopening(Amendments& list, Tick tick, std::int32_t number) {
  ERGOCAST_REQUIRE(can_reopen(list, number, tick));
  Zone& zone = *std::ranges::find(list.zones, number, &Zone::number);
  zone.cancelled = std::max(tick, zone.closed);
  name(list, {.kind = AmendmentKind::kReopen,
              .from = zone.cancelled,
              .hash = static_cast<std::uint64_t>(number)});
}

void name_law(Amendments& list, Tick tick, LawChange change) {
  change.from = list.laws.empty() ? tick : std::max(tick, list.laws.back().from + 1);
  change.number = list.named;
  name(list, {.kind = AmendmentKind::kLaw, .from = change.from, .hash = law_hash(change)});
  // The second newest holds until the newest one does.
  if (list.laws.size() > 1) list.laws.erase(list.laws.begin(), list.laws.end() - 1);
  list.laws.push_back(std::move(change));
}

void replace_law(Amendments& list, LawChange change) {
  ERGOCAST_REQUIRE(!list.laws.empty());
  change.from = list.laws.back().from;
  change.number = list.named;
  name(list, {.kind = AmendmentKind::kLaw, .from = change.from, .hash = law_hash(change)});
  list.laws.back() = std::move(change);
}

void note_sighting(Amendments& list, SearchNote sighting) {
  ERGOCAST_REQUIRE(list.notes.size() < kMaxSearchNotes && !list.targets.empty());
  sighting.number = list.targets.back().number;
  sighting.from = list.targets.back().from;
  list.notes.push_back(sighting);
}

void name_dismissal(Amendments& list, Tick tick, SearchNote dismissal) {
  ERGOCAST_REQUIRE(list.notes.size() < kMaxSearchNotes);
  dismissal.number = list.named;
  dismissal.from = tick;
  name(list, {.kind = AmendmentKind::kDismiss, .from = tick, .hash = search_note_hash(dismissal)});
  list.notes.push_back(dismissal);
}

std::size_t zones_at(const Amendments& list, Tick tick) {
  return not_ended(list.zones, tick).size();
}

}  // namespace ergocast
