// SPDX-License-Identifier: BSD-3-Clause
// Repeats all parts of AMEND until MISSION names an amendment of its number, then looks whose it
// is.
#include "cli/operate/amend_order.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <limits>
#include <utility>

#include "core/motion/end_rules.h"
#include "core/motion/zones.h"
#include "plan/amendment_list.h"
#include "runtime/bus/random_identity.h"
#include "team/amend_parts.h"

namespace ergocast::cli {
namespace {

using State = OrderReport::State;

/// As many bytes are sent in one period; more are sent less often.
constexpr std::size_t kBytesInPeriod = std::size_t{4} * kMaxPlanBytesPerMessage;
/// The order does not fail before it was sent as often: the process may have been stopped.
constexpr int kLeastSent = 20;

/// "t = 600.0 s": an end, in mission time.
std::string end_text(const MonitoredRun& team, Tick tick_count) {
  char text[40];
  std::snprintf(text, sizeof text, "t = %.1f s",
                static_cast<double>(tick_count) * team.mission().timing.dt_s);
  return text;
}

/// " (u_max_mps 8)", if the list still has the numbers of the law.
std::string numbers_text(const MonitoredRun& team, std::int32_t number) {
  const auto& laws = team.amendments().laws;
  const auto found = std::ranges::find(laws, number, &LawChange::number);
  return found == laws.end() ? "" : " (" + law_text(*found, team.mission()) + ")";
}

/// The sighting or dismissal of an amendment; null if the list has none.
const SearchNote* note_of(const MonitoredRun& team, const Amendment& amendment) {
  const auto& notes = team.amendments().notes;
  const auto found = std::ranges::find(notes, amendment.number, &SearchNote::number);
  return found == notes.end() ? nullptr : &*found;
}

/// "target 5f0c…".
std::string kind_text(const MonitoredRun& team, const Amendment& amendment) {
  if (const SearchNote* const note = note_of(team, amendment)) return to_text(*note);
  switch (amendment.kind) {
    case AmendmentKind::kPause:
      return "a pause";
    case AmendmentKind::kResume:
      return "the end of a pause";
    case AmendmentKind::kEnd:
      return "the end at " + end_text(team, static_cast<Tick>(amendment.hash));
    case AmendmentKind::kZone:
      return "zone " + to_hex(amendment.hash);
    case AmendmentKind::kReopen:
      return "the end of the zone of amendment " + std::to_string(amendment.hash);
    case AmendmentKind::kLaw:
      return "law " + to_hex(amendment.hash) + numbers_text(team, amendment.number);
    case AmendmentKind::kDismiss:
      return "a dismissed contact";
    default:
      return "target " + to_hex(amendment.hash);
  }
}

/// A target or law that waits for its tick.
struct Waiting {
  std::int32_t number;
  Tick from;
};

/// The one that waits, of the kind of a wish; nothing if none does.
std::optional<Waiting> waiting_for(AmendmentKind kind, const MonitoredRun& team) {
  const auto newest = [&team](const auto& changes) -> std::optional<Waiting> {
    if (changes.empty() || changes.back().from <= team.tick()) return std::nullopt;
    return Waiting{changes.back().number, changes.back().from};
  };
  if (kind == AmendmentKind::kTarget) return newest(team.amendments().targets);
  if (kind == AmendmentKind::kLaw) return newest(team.amendments().laws);
  return std::nullopt;
}

std::string waiting_text(const MonitoredRun& team, AmendmentKind kind, const Waiting& waiting) {
  return "another " + std::string(to_string(kind)) + ", amendment " +
         std::to_string(waiting.number) + ", waits for " + team.mission_time(waiting.from) +
         in_seconds(team.seconds_until(waiting.from)) + ": repeat the order then";
}

/// Why no further zone can be in force; nothing if one can.
std::optional<std::string> why_no_place(const MonitoredRun& team) {
  if (zones_at(team.amendments(), team.tick()) < kMaxZones) return std::nullopt;
  Tick first = std::numeric_limits<Tick>::max();
  for (const Zone& zone : team.amendments().zones)
    if (zone.end() > team.tick()) first = std::min(first, zone.end());
  return std::to_string(kMaxZones) + " zones are in force, and there can be no more at a time: " +
         "repeat the order when the first of them has ended, at " + team.mission_time(first);
}

/// Why a zone cannot be cancelled any more; nothing if it can.
std::optional<std::string> why_not_cancelled(const MonitoredRun& team, const AmendmentWish& wish) {
  const auto number = static_cast<std::int32_t>(wish.hash);
  const auto& zones = team.amendments().zones;
  const auto zone = std::ranges::find(zones, number, &Zone::number);
  if (zone != zones.end() && zone->cancelled >= 0)
    return "another order was first: that zone ends at " + team.mission_time(zone->cancelled);
  if (can_reopen(team.amendments(), number, earliest_tick(team, 0))) return std::nullopt;
  return "that zone ends by itself before all agents can know of an earlier end";
}

/// Why there can be no further sighting or dismissal; nothing if there can.
std::optional<std::string> why_no_note(const MonitoredRun& team) {
  if (team.amendments().notes.size() < kMaxSearchNotes) return std::nullopt;
  return "a mission can get " + std::to_string(kMaxSearchNotes) +
         " sightings and dismissed contacts, and this one has had them: change its target with "
         "--target";
}

/// The coordinator decides by the same rules, with newer places.
std::optional<std::string> why_no_end(const MonitoredRun& team, const AmendmentWish& wish,
                                      Tick delay) {
  const auto wanted = static_cast<Tick>(wish.hash);
  const std::string when = end_text(team, wanted);
  EndRules rules;
  switch (rules.problem(team.mission(), team.amendments(), team.tick(), earliest_tick(team, delay),
                        wanted, team.places())) {
    case EndProblem::kNone:
      return std::nullopt;
    case EndProblem::kSame:
      return "the mission ends at " + when + " already";
    case EndProblem::kFull:
      return "a mission can get " + std::to_string(kMaxEnds) +
             " other ends, and this one has had them: end it with ergocast stop";
    case EndProblem::kPassed:
      return when + " has passed before all agents can know it: name a later end, or use " +
             "ergocast stop";
    case EndProblem::kTooLate:
      return "a later end must be named " + std::to_string(static_cast<int>(kEndNotice_s)) +
             " s of mission time before the end that holds, and that is at " +
             end_text(team, team.tick_count()) + ": start another mission";
    case EndProblem::kTooFar:
      return "agent " + std::to_string(rules.too_far()) +
             " cannot be at its station in time for an end at " + when + ": name a later end";
  }
  return std::nullopt;
}

/// "holds since tick 517, t = 51.7 s".
std::string since_text(const MonitoredRun& team, Tick from) {
  const bool holds = team.tick() >= from;
  return (holds ? "holds since " : "holds from ") + team.mission_time(from) +
         (holds ? "" : in_seconds(team.seconds_until(from)));
}

/// The amendment that ends what another one has changed; null if none is named.
const Amendment* successor_of(const MonitoredRun& team, const Amendment& amendment) {
  if (amendment.kind == AmendmentKind::kReopen || amendment.kind == AmendmentKind::kResume ||
      amendment.kind == AmendmentKind::kDismiss)
    return nullptr;
  const bool is_zone = amendment.kind == AmendmentKind::kZone;
  const auto kind = is_zone                                   ? AmendmentKind::kReopen
                    : amendment.kind == AmendmentKind::kPause ? AmendmentKind::kResume
                                                              : amendment.kind;
  const Amendment* next = nullptr;
  for (const Amendment& one : team.amendments().recent) {
    if (one.number <= amendment.number || one.kind != kind) continue;
    if (is_zone && one.hash != static_cast<std::uint64_t>(amendment.number)) continue;
    // A later one from the same tick on has replaced the next one.
    if (next == nullptr || one.from <= next->from) next = &one;
  }
  return next;
}

/// Whether another amendment took the place of this one before its tick.
bool never_holds(const MonitoredRun& team, const Amendment& amendment) {
  const Amendment* const next = successor_of(team, amendment);
  return next != nullptr && next->from <= amendment.from;
}

/// ": amendment 5 cancelled it", if the list still has that.
std::string cancelled_text(const MonitoredRun& team, const Amendment& zone) {
  const Amendment* const next = successor_of(team, zone);
  return next == nullptr ? "" : ": amendment " + std::to_string(next->number) + " cancelled it";
}

/// "was closed from … until …: amendment 5 cancelled it", or "holds since …, closed since …, until
/// …".
std::string zone_ticks_text(const MonitoredRun& team, const Amendment& amendment) {
  const auto& zones = team.amendments().zones;
  const auto zone = std::ranges::find(zones, amendment.number, &Zone::number);
  if (zone == zones.end()) return "has ended";  // the list has only zones that had not ended
  const std::string until = team.mission_time(zone->end()) +
                            (zone->cancelled >= 0 ? cancelled_text(team, amendment) : "");
  const bool ended = team.tick() >= zone->end();
  if (ended || zone->end() <= zone->from)
    return (ended ? "was closed from " : "is closed from ") + team.mission_time(zone->closed) +
           " until " + until;
  return since_text(team, amendment.from) +
         (team.tick() >= zone->closed ? ", closed since " : ", closed from ") +
         team.mission_time(zone->closed) + ", until " + until;
}

std::string ticks_text(const MonitoredRun& team, const Amendment& amendment) {
  if (amendment.kind == AmendmentKind::kZone) return zone_ticks_text(team, amendment);
  const Amendment* const next = successor_of(team, amendment);
  if (next == nullptr || (team.tick() < next->from && !never_holds(team, amendment)))
    return since_text(team, amendment.from);
  const std::string number = "amendment " + std::to_string(next->number);
  const std::string from = team.mission_time(amendment.from);
  if (never_holds(team, amendment)) return "never holds: " + number + " replaced it before " + from;
  // No mission time passes in a pause.
  if (amendment.kind == AmendmentKind::kPause) return "held at " + from + ", until " + number;
  return "held from " + from + ", until " + team.mission_time(next->from) + ": " + number;
}

}  // namespace

AmendmentWish wish_of(const TargetChange& target) {
  return {AmendmentKind::kTarget, encode_target(target), target_hash(target)};
}

AmendmentWish wish_of_end(Tick tick_count) {
  return {AmendmentKind::kEnd, encode_end(tick_count), static_cast<std::uint64_t>(tick_count)};
}

AmendmentWish wish_of(const Zone& zone) {
  return {AmendmentKind::kZone, encode_zone(zone), zone_hash(zone)};
}

AmendmentWish wish_of_sighting(const TargetChange& target, const SearchNote& note) {
  AmendmentWish wish = wish_of(target);
  const auto place = encode_search_note(note);
  wish.content.insert(wish.content.end(), place.begin(), place.end());
  wish.has_note = true;
  return wish;
}

AmendmentWish wish_of_dismissal(const SearchNote& note) {
  return {.kind = AmendmentKind::kDismiss,
          .content = encode_search_note(note),
          .hash = search_note_hash(note),
          .has_note = true};
}

AmendmentWish wish_of_reopening(std::int32_t number) {
  return {AmendmentKind::kReopen, encode_reopening(number), static_cast<std::uint64_t>(number)};
}

AmendmentWish wish_of(const LawChange& law) {
  return {AmendmentKind::kLaw, encode_law(law), law_hash(law)};
}

Result<AmendmentWish, std::string> wish_to_cancel(const MonitoredRun& team, std::int32_t number) {
  const Amendments& list = team.amendments();
  const std::string name = "amendment " + std::to_string(number);
  if (number < 0 || number >= list.named)
    return failure("there is no " + name + ": ergocast amend --list shows them");
  const auto& targets = list.targets;
  const auto& ends = list.ends;
  if (!targets.empty() && targets.back().number == number) {
    const Mission& mission = team.mission();
    AmendmentWish wish =
        wish_of(targets.size() > 1 ? targets[targets.size() - 2]
                                   : TargetChange{.target = mission.target_coefficients,
                                                  .cosine = mission.cosine_target});
    wish.brings_back = true;
    return wish;
  }
  const auto& laws = list.laws;
  if (!laws.empty() && laws.back().number == number) {
    AmendmentWish wish =
        wish_of(laws.size() > 1 ? laws[laws.size() - 2] : plans_law(team.mission()));
    wish.brings_back = true;
    return wish;
  }
  if (!ends.empty() && ends.back().number == number)
    return wish_of_end(ends.size() > 1 ? ends[ends.size() - 2].tick_count
                                       : team.mission().timing.tick_count);
  if (can_reopen(list, number, team.tick())) return wish_of_reopening(number);
  const auto found = std::ranges::find(list.recent, number, &Amendment::number);
  if (found != list.recent.end() && found->kind == AmendmentKind::kPause)
    return failure(name + " is a pause: ergocast resume ends it");
  if (found != list.recent.end() && found->kind == AmendmentKind::kResume)
    return failure(name + " ended a pause: ergocast pause pauses the mission again");
  if (found != list.recent.end() && found->kind == AmendmentKind::kZone)
    return failure(name +
                   " is a zone that has ended, or is cancelled already: ergocast amend --list "
                   "shows when");
  if (found != list.recent.end() && found->kind == AmendmentKind::kReopen)
    return failure(name + " cancelled a zone: ergocast amend --zone closes one again");
  if (found != list.recent.end() && found->kind == AmendmentKind::kDismiss)
    return failure(name +
                   " dismissed a contact, whose reports are forgotten: give a sighting with "
                   "ergocast amend --sighting");
  return failure("a later amendment has replaced " + name +
                 ": ergocast amend --list shows which can be cancelled");
}

AmendOrder::AmendOrder(AmendmentWish wish, Tick delay, Instant now, std::string by)
    : wish_(std::move(wish)),
      delay_(delay),
      by_(std::move(by)),
      header_{0, kOperator, random_identity(), 0, 0},
      since_(now) {}

Instant::duration AmendOrder::period() const {
  return kRepeatPeriod * std::max<std::size_t>(1, wish_.content.size() / kBytesInPeriod);
}

void AmendOrder::send(const MonitoredRun& team, Instant now, Outbox& out) {
  if (team.over()) return;
  if (team.is_running() && !number_) {
    number_ = team.amendments().named;
    problem_ = why_impossible(team, wish_, delay_);
    since_ = now;
    next_ = now;
  }
  if (number_) {
    for (const Amendment& one : team.amendments().recent)
      if (one.number == *number_) amendment_ = one;
  }
  if (amendment_ || problem_ || now < next_) return;
  next_ = now + (number_ ? period() : kRepeatPeriod);
  number_ ? send_parts(team, out) : out.push_back(mission_question(team, header_));
}

void AmendOrder::send_parts(const MonitoredRun& team, Outbox& out) {
  ++sent_;
  ++header_.sequence;
  header_.run = team.run();
  header_.tick = team.tick();
  const Amend wish{
      .header = header_, .number = *number_, .kind = wish_.kind, .delay_ticks = delay_, .by = by_};
  for (Amend& part : in_parts(wish, wish_.content)) {
    header_.sequence = part.header.sequence;
    out.push_back({Bus::kSwarm, std::move(part)});
  }
}

std::optional<std::string> why_impossible(const MonitoredRun& team, const AmendmentWish& wish,
                                          Tick delay) {
  if (team.amendments().named >= kMaxAmendments)
    return "a mission can be amended " + std::to_string(kMaxAmendments) +
           " times, and this one has been: end it with ergocast stop";
  if (delay >= team.ticks_left())
    return "the mission ends before that, at " +
           team.mission_time(team.tick() + team.ticks_left()) + ": name an earlier time";
  if (wish.kind == AmendmentKind::kEnd) return why_no_end(team, wish, delay);
  if (wish.kind == AmendmentKind::kZone) return why_no_place(team);
  if (wish.kind == AmendmentKind::kReopen) return why_not_cancelled(team, wish);
  if (wish.has_note)
    if (auto problem = why_no_note(team)) return problem;
  const auto waiting = waiting_for(wish.kind, team);
  const std::chrono::duration<double> patience = Order::kAnswerPatience;
  if (wish.brings_back || !waiting || team.seconds_until(waiting->from) < patience.count())
    return std::nullopt;
  return waiting_text(team, wish.kind, *waiting);
}

OrderReport AmendOrder::report(const MonitoredRun& team, Instant now) const {
  if (!number_) return waiting_for_mission(team, now - since_);
  if (problem_) return {State::kFailed, *problem_};
  if (amendment_) return named(team);
  if (team.over()) return {State::kFailed, "the mission has ended: " + team.reason()};
  return unnamed(team, now);
}

OrderReport AmendOrder::unnamed(const MonitoredRun& team, Instant now) const {
  if (now - since_ < kAnswerPatience || sent_ < kLeastSent)
    return {State::kSent, "the coordinator has not answered yet"};
  if (const auto waiting = waiting_for(wish_.kind, team))
    return {State::kFailed, waiting_text(team, wish_.kind, *waiting)};
  if (wish_.kind == AmendmentKind::kEnd)
    if (const auto problem = why_no_end(team, wish_, delay_)) return {State::kFailed, *problem};
  if (wish_.kind == AmendmentKind::kReopen)
    if (const auto problem = why_not_cancelled(team, wish_)) return {State::kFailed, *problem};
  return {State::kFailed, why_no_tick(team)};
}

OrderReport AmendOrder::named(const MonitoredRun& team) const {
  const std::string text = amendment_text(team, *amendment_);
  if (amendment_->ordered_by != header_.incarnation)
    return {State::kFailed, "another order was first: " + text +
                                ". This order had no effect: repeat it if it is still wanted"};
  if (never_holds(team, *amendment_)) return {State::kFailed, text};
  if (team.tick() >= amendment_->from) return {State::kDone, text};
  if (team.over()) return {State::kFailed, "the mission has ended: " + team.reason()};
  return {State::kAnswered, text};
}

Tick earliest_tick(const MonitoredRun& team, Tick delay) {
  const Timing& timing = team.mission().timing;
  const Tick notice = timing.pace == Pace::kRealtime ? notice_ticks(timing) : 1;
  return team.tick() + 1 + notice + delay;
}

std::string amendment_text(const MonitoredRun& team, const Amendment& amendment) {
  return "amendment " + std::to_string(amendment.number) + ", " + kind_text(team, amendment) +
         ", " + ticks_text(team, amendment) + (amendment.by.empty() ? "" : ", by " + amendment.by);
}

std::string inside_text(const MonitoredRun& team, const Zone& zone) {
  std::vector<AgentId> inside;
  for (const auto& [id, x_m] : team.places_m())
    if (is_inside(zone, x_m)) inside.push_back(id);
  if (inside.empty()) return "";
  std::string text = inside.size() == 1 ? "agent " : "agents ";
  for (std::size_t i = 0; i < inside.size(); ++i)
    text += (i == 0 ? "" : i + 1 == inside.size() ? " and " : ", ") + std::to_string(inside[i]);
  return text + (inside.size() == 1 ? " is" : " are") + " in it";
}

}  // namespace ergocast::cli
