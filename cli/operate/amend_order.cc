// SPDX-License-Identifier: BSD-3-Clause
// Repeats all parts of AMEND until MISSION names an amendment of its number, then compares hashes.
#include "cli/operate/amend_order.h"

#include <algorithm>
#include <chrono>
#include <limits>
#include <utility>

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

/// "target 5f0c…".
std::string kind_text(const Amendment& amendment) {
  switch (amendment.kind) {
    case AmendmentKind::kPause:
      return "a pause";
    case AmendmentKind::kResume:
      return "the end of a pause";
    case AmendmentKind::kZone:
      return "zone " + to_hex(amendment.hash);
    default:
      return "target " + to_hex(amendment.hash);
  }
}

/// The target that waits for its tick; null if none does.
const TargetChange* waiting_target(const MonitoredRun& team) {
  const auto& targets = team.amendments().targets;
  return !targets.empty() && targets.back().from > team.tick() ? &targets.back() : nullptr;
}

std::string waiting_text(const MonitoredRun& team, const TargetChange& waiting) {
  return "another target, amendment " + std::to_string(waiting.number) + ", waits for " +
         team.mission_time(waiting.from) + in_seconds(team.seconds_until(waiting.from)) +
         ": repeat the order then";
}

/// Why no further zone can be in force; nothing if one can.
std::optional<std::string> why_no_place(const MonitoredRun& team) {
  if (zones_at(team.amendments(), team.tick()) < kMaxZones) return std::nullopt;
  Tick first = std::numeric_limits<Tick>::max();
  for (const Zone& zone : team.amendments().zones)
    if (zone.until > team.tick()) first = std::min(first, zone.until);
  return std::to_string(kMaxZones) + " zones are in force, and there can be no more at a time: " +
         "repeat the order when the first of them has ended, at " + team.mission_time(first);
}

/// ", closed since tick 500, t = 50.0 s, until tick 900, t = 90.0 s".
std::string zone_ticks_text(const MonitoredRun& team, std::int32_t number) {
  for (const Zone& zone : team.amendments().zones) {
    if (zone.number != number) continue;
    const bool closed = team.tick() >= zone.closed, ended = team.tick() >= zone.until;
    return (closed ? ", closed since " : ", closed from ") + team.mission_time(zone.closed) +
           (ended ? ", ended at " : ", until ") + team.mission_time(zone.until);
  }
  return "";
}

}  // namespace

AmendOrder::AmendOrder(const TargetChange& target, Tick delay, Instant now)
    : content_(encode_target(target)),
      hash_(target_hash(target)),
      delay_(delay),
      header_{0, kOperator, random_identity(), 0, 0},
      since_(now) {}

AmendOrder::AmendOrder(const Zone& zone, Tick notice, Instant now)
    : kind_(AmendmentKind::kZone),
      content_(encode_zone(zone)),
      hash_(zone_hash(zone)),
      delay_(notice),
      header_{0, kOperator, random_identity(), 0, 0},
      since_(now) {}

Instant::duration AmendOrder::period() const {
  return kRepeatPeriod * std::max<std::size_t>(1, content_.size() / kBytesInPeriod);
}

void AmendOrder::send(const MonitoredRun& team, Instant now, Outbox& out) {
  if (team.over()) return;
  if (team.is_running() && !number_) {
    number_ = team.amendments().named;
    problem_ = why_impossible(team);
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
  const Amend wish{.header = header_, .number = *number_, .kind = kind_, .delay_ticks = delay_};
  for (Amend& part : in_parts(wish, content_)) {
    header_.sequence = part.header.sequence;
    out.push_back({Bus::kSwarm, std::move(part)});
  }
}

/// Why no coordinator would obey; nothing if one may.
std::optional<std::string> AmendOrder::why_impossible(const MonitoredRun& team) const {
  if (*number_ >= kMaxAmendments)
    return "a mission can be amended " + std::to_string(kMaxAmendments) +
           " times, and this one has been: end it with ergocast stop";
  if (delay_ >= team.ticks_left())
    return "the mission ends before that, at " +
           team.mission_time(team.tick() + team.ticks_left()) + ": name an earlier time";
  if (kind_ == AmendmentKind::kZone) return why_no_place(team);
  const TargetChange* const waiting = waiting_target(team);
  const std::chrono::duration<double> patience = kAnswerPatience;
  if (waiting == nullptr || team.seconds_until(waiting->from) < patience.count())
    return std::nullopt;
  return waiting_text(team, *waiting);
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
  const TargetChange* const waiting = waiting_target(team);
  if (waiting != nullptr && kind_ == AmendmentKind::kTarget)
    return {State::kFailed, waiting_text(team, *waiting)};
  return {State::kFailed, why_no_tick(team)};
}

OrderReport AmendOrder::named(const MonitoredRun& team) const {
  const std::string text = amendment_text(team, *amendment_);
  if (amendment_->kind != kind_ || amendment_->hash != hash_)
    return {State::kFailed, "another operator was first: " + text +
                                ". This order had no effect: repeat it if it is still wanted"};
  if (team.tick() >= amendment_->from) return {State::kDone, text};
  if (team.over()) return {State::kFailed, "the mission has ended: " + team.reason()};
  return {State::kAnswered, text};
}

std::string amendment_text(const MonitoredRun& team, const Amendment& amendment) {
  const bool holds = team.tick() >= amendment.from;
  return "amendment " + std::to_string(amendment.number) + ", " + kind_text(amendment) +
         (holds ? ", holds since " : ", holds from ") + team.mission_time(amendment.from) +
         (holds ? "" : in_seconds(team.seconds_until(amendment.from))) +
         zone_ticks_text(team, amendment.number);
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
