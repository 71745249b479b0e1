// SPDX-License-Identifier: BSD-3-Clause
// Collects what an operator wants, and names it at a tick that all agents learn in time.
#include "coordinator/amending.h"

#include <algorithm>
#include <chrono>
#include <span>

#include "core/mission/end_by_finding.h"
#include "core/motion/zones.h"
#include "plan/amendment_list.h"

namespace ergocast {
namespace {

/// Operators whose parts are collected at once.
/// Limit (Team): operators whose amendments a coordinator collects at once. Beyond it: the parts of
/// the one that asked first are forgotten; it repeats them.
constexpr std::size_t kMostOperators = 4;

/// Lockstep: how many ticks after the world's tick an amendment holds.
constexpr Tick kLockstepNotice = 2;
/// For so long a refused zone is not looked at again.
constexpr Tick kSameAnswerTicks = 20;

/// Real time: the tick after the notice. It counts from the newest tick that the world can be at.
/// Nothing while the world is silent, because that tick is then unknown; the operator asks again.
std::optional<Tick> tick_with_notice(const Timing& timing, const TickWatch& ticks,
                                     const SignsOfLife& signs) {
  if (!ticks.world_heard() || signs.me.silent(kWorld, signs.now)) return std::nullopt;
  const double since_s = std::chrono::duration<double>(signs.now - ticks.since()).count();
  const auto since = static_cast<Tick>(since_s * timing.realtime_factor / timing.dt_s);
  return ticks.newest() + 1 + since + notice_ticks(timing);
}

/// Whether a target or law can be named from a tick on. Only two of each travel, the one that holds
/// and the next. One that waits can be replaced by the one that holds.
/// @param plans  that of the plan
template <class Change>
bool may_follow(const std::vector<Change>& changes, const Change& change, const Change& plans,
                Tick newest, Tick from, auto hash_of) {
  if (changes.empty() || changes.back().from <= newest) return true;
  if (changes.back().from < from) return false;
  const Change& holds = changes.size() > 1 ? changes[changes.size() - 2] : plans;
  return hash_of(change) == hash_of(holds);
}

/// Whether the newest change does not hold yet at a tick.
bool waits(const auto& changes, Tick tick) {
  return !changes.empty() && changes.back().from >= tick;
}

}  // namespace

void Amending::replace(Amendments list) {
  list_ = std::move(list);
  bytes_ = encode_amendments(list_);
}

void Amending::plan(Amendments list) {
  constexpr std::ptrdiff_t kListed = 2;
  const auto& all = list.targets;
  if (std::ssize(all) > kListed) {
    planned_.assign(all.begin() + kListed, all.end());
    list.targets.resize(kListed);
  }
  if (list.zones.size() > kMaxZones) {
    planned_zones_.assign(list.zones.begin() + kMaxZones, list.zones.end());
    list.zones.resize(kMaxZones);
  }
  if (list.laws.size() > kMaxLaws) {
    planned_laws_.assign(list.laws.begin() + kMaxLaws, list.laws.end());
    list.laws.resize(kMaxLaws);
  }
  replace(std::move(list));
}

void Amending::adopt(const Amendments& known) {
  if (known.named <= list_.named) return;
  replace(known);
  // It names more only once it lists all that was planned. A wish that waits for its tick does not
  // follow that list. Its operator repeats it.
  planned_.clear();
  planned_zones_.clear();
  planned_laws_.clear();
  wish_.reset();
  stand_by_revision_ = -1;
}

/// Whether the next amendment may be of this kind and number.
bool Amending::may_name(const Amend& amend, const TickWatch& ticks) const {
  if (stand_by_revision_ >= 0 || amend.number != list_.named) return false;
  const bool all_listed = planned_.empty() && planned_zones_.empty() && planned_laws_.empty();
  if (list_.named >= kMaxAmendments || !all_listed) return false;
  if (amend.kind == AmendmentKind::kZone) return zones_at(list_, ticks.newest()) < kMaxZones;
  if (amend.kind == AmendmentKind::kPause)
    return !is_open(list_.holds) && list_.holds.size() < kMaxHolds;
  if (amend.kind == AmendmentKind::kResume) return is_open(list_.holds);
  if (amend.kind == AmendmentKind::kEnd)
    return list_.ends.size() < kMaxEnds && amend.delay_ticks == 0;
  if (amend.kind == AmendmentKind::kReopen) return amend.delay_ticks == 0;
  if (amend.kind == AmendmentKind::kDismiss)
    return list_.notes.size() < kMaxSearchNotes && amend.delay_ticks == 0;
  return true;
}

/// The content of an AMEND whose last part has arrived.
std::optional<std::vector<std::byte>> Amending::completed(const Amend& amend) {
  const Incarnation from = amend.header.incarnation;
  const auto is_from = [from](const Collected& one) { return one.operator_incarnation == from; };
  auto found = std::ranges::find_if(collected_, is_from);
  if (found == collected_.end()) {
    if (collected_.size() == kMostOperators) collected_.erase(collected_.begin());
    found = collected_.insert(collected_.end(), Collected{from});
  }
  const auto count = static_cast<std::size_t>(amend.parts);
  if (found->number != amend.number || found->parts.size() != count)
    *found = {from, amend.number, decltype(found->parts)(count)};
  found->parts[static_cast<std::size_t>(amend.part)] = amend.content;
  std::vector<std::byte> content;
  for (const auto& part : found->parts) {
    if (!part) return std::nullopt;
    content.insert(content.end(), part->begin(), part->end());
  }
  collected_.erase(found);
  return content;
}

/// Whether the mission can get this amendment from a tick on.
bool Amending::possible(const Wish& wish, const Mission& mission, Tick newest, Tick from,
                        const Team& team) {
  if (wish.kind == AmendmentKind::kTarget)
    return may_follow(list_.targets, wish.target,
                      {.target = mission.target_coefficients, .cosine = mission.cosine_target},
                      newest, from, target_hash);
  if (wish.kind == AmendmentKind::kLaw)
    return may_follow(list_.laws, wish.law, plans_law(mission), newest, from, law_hash);
  if (wish.kind == AmendmentKind::kReopen) return can_reopen(list_, wish.number, from);
  if (wish.kind != AmendmentKind::kEnd) return true;
  if (wish.tick_count == 0)
    return soonest_tick_count(list_, from) < tick_count_of(mission.timing, list_.ends);
  const Tick known = team.places.tick(team.roster);
  const auto agents = team.places.of(team.roster);
  return end_rules_.problem(mission, list_, known, from, wish.tick_count, agents) ==
         EndProblem::kNone;
}

void Amending::obey(const Amend& amend, const Mission& mission, const TickWatch& ticks,
                    const Team& team, Announcement& announcement) {
  const Tick end = tick_after(list_.holds, tick_count_of(mission.timing, list_.ends));
  if (!may_name(amend, ticks) || ticks.newest() + amend.delay_ticks >= end) return;
  auto wish = wish_of(amend, mission, ticks.newest());
  if (!wish) return;
  const bool realtime = mission.timing.pace == Pace::kRealtime;
  const auto tick = realtime ? tick_with_notice(mission.timing, ticks, team.signs)
                             : std::optional(ticks.newest() + kLockstepNotice);
  if (!tick || !possible(*wish, mission, ticks.newest(), *tick + wish->delay_ticks, team)) return;
  if (realtime) return name(ticks.newest(), *tick, *std::move(wish), announcement);
  wish_ = std::move(wish);
  stand_by(announcement);
}

/// What an AMEND wants, once its content is whole; nothing if that is not possible.
std::optional<Amending::Wish> Amending::wish_of(const Amend& amend, const Mission& mission,
                                                Tick now) {
  Wish wish{.kind = amend.kind,
            .delay_ticks = amend.delay_ticks,
            .by = amend.by,
            .ordered_by = amend.header.incarnation};
  const bool has_content = wish.kind >= AmendmentKind::kTarget;
  std::optional<std::vector<std::byte>> content;
  if (has_content) {
    content = completed(amend);
    if (!content) return std::nullopt;
  }
  if (wish.kind == AmendmentKind::kTarget) {
    const std::size_t target_size = std::min(content->size(), target_bytes(mission));
    auto target = decode_target(std::span(*content).first(target_size), mission);
    if (!target) return std::nullopt;
    wish.target = *std::move(target);
    if (content->size() > target_size) {
      wish.note = decode_search_note(std::span(*content).subspan(target_size), mission);
      if (!wish.note || !wish.note->is_sighting() || list_.notes.size() >= kMaxSearchNotes)
        return std::nullopt;
    }
  }
  if (wish.kind == AmendmentKind::kEnd) {
    const auto tick_count = decode_end(*content, mission);
    if (!tick_count) return std::nullopt;
    wish.tick_count = *tick_count;
  }
  if (wish.kind == AmendmentKind::kLaw) {
    auto law = decode_law(*content, mission);
    if (!law) return std::nullopt;
    wish.law = *std::move(law);
  }
  if (wish.kind == AmendmentKind::kReopen) {
    const auto number = decode_reopening(*content);
    if (!number) return std::nullopt;
    wish.number = *number;
  }
  if (wish.kind == AmendmentKind::kDismiss) {
    wish.note = decode_search_note(*content, mission);
    if (!wish.note || wish.note->is_sighting()) return std::nullopt;
  }
  if (wish.kind == AmendmentKind::kZone) {
    const auto& [refused, since] = refused_zone_;
    if (*content == refused && now < since + kSameAnswerTicks) return std::nullopt;
    auto zone = decode_zone(*content, mission.domain);
    if (!zone || zone_problem(mission, *zone, not_ended(list_.zones, now))) {
      refused_zone_ = {*content, now};
      return std::nullopt;
    }
    wish.zone = *std::move(zone);
  }
  return wish;
}

void Amending::note_found(int by_world, int known, const Mission& mission, const TickWatch& ticks,
                          const SignsOfLife& signs, Announcement& announcement) {
  if (!lacks_end_by_finding(mission, list_, known, ticks.newest())) return;
  Wish wish{.kind = AmendmentKind::kEnd, .by = kByFinding};
  const bool realtime = mission.timing.pace == Pace::kRealtime;
  if (!realtime && !lacks_end_by_finding(mission, list_, by_world, ticks.tick())) {
    // The world has lost what its predecessor knew, and goes on.
    if (stand_by_revision_ >= 0) return;
    wish_ = std::move(wish);
    return stand_by(announcement);
  }
  const auto tick = realtime ? tick_with_notice(mission.timing, ticks, signs)
                             : std::optional(ticks.tick() + kLockstepNotice);
  if (!tick) return;
  wish_.reset();  // its operator repeats it
  name(ticks.newest(), *tick, std::move(wish), announcement);
}

void Amending::stand_by(Announcement& announcement) {
  announcement.change();
  stand_by_revision_ = announcement.revision();
}

void Amending::note_world(const Mission& mission, const TickWatch& ticks, const Team& team,
                          Announcement& announcement) {
  if (stand_by_revision_ < 0) {
    const Tick now = ticks.newest();
    if (target_is_due(now) || zone_is_due(now) || law_is_due(now)) stand_by(announcement);
    return;
  }
  if (ticks.world_revision() < stand_by_revision_) return;
  if (!wish_) return list_next(ticks.newest(), announcement);
  // The world goes on once it knows the named tick. No agent answers the next tick before that.
  Wish wish = *std::exchange(wish_, std::nullopt);
  const Tick tick = ticks.tick() + kLockstepNotice;
  if (possible(wish, mission, ticks.newest(), tick + wish.delay_ticks, team))
    return name(ticks.newest(), tick, std::move(wish), announcement);
  stand_by_revision_ = -1;
  announcement.change();
}

/// Whether a planned target can have the place of one that holds no longer.
bool Amending::target_is_due(Tick now) const {
  return !planned_.empty() && list_.targets.back().from <= now;
}

/// Whether a planned zone can have the place of one that has ended.
bool Amending::zone_is_due(Tick now) const {
  return !planned_zones_.empty() && zones_at(list_, now) < kMaxZones;
}

/// Whether a planned law can have the place of one that holds no longer.
bool Amending::law_is_due(Tick now) const {
  return !planned_laws_.empty() && list_.laws.back().from <= now;
}

void Amending::list_next(Tick now, Announcement& announcement) {
  stand_by_revision_ = -1;
  if (target_is_due(now)) {
    list_.targets.erase(list_.targets.begin());
    list_.targets.push_back(std::move(planned_.front()));
    planned_.pop_front();
  }
  if (zone_is_due(now)) {
    list_.zones = not_ended(list_.zones, now);
    list_.zones.push_back(std::move(planned_zones_.front()));
    planned_zones_.pop_front();
  }
  if (law_is_due(now)) {
    list_.laws.erase(list_.laws.begin());
    list_.laws.push_back(std::move(planned_laws_.front()));
    planned_laws_.pop_front();
  }
  bytes_ = encode_amendments(list_);
  announcement.change();
}

void Amending::name(Tick now, Tick tick, Wish wish, Announcement& announcement) {
  stand_by_revision_ = -1;
  std::string by = std::move(wish.by);
  const Incarnation ordered_by = wish.ordered_by;
  list_wish(now, tick, std::move(wish));
  list_.recent.back().by = std::move(by);
  list_.recent.back().ordered_by = ordered_by;
  bytes_ = encode_amendments(list_);
  announcement.change();
}

void Amending::list_wish(Tick now, Tick tick, Wish wish) {
  const Tick delay = wish.delay_ticks;
  switch (wish.kind) {
    case AmendmentKind::kTarget:
      waits(list_.targets, tick + delay) ? replace_target(list_, std::move(wish.target))
                                         : name_target(list_, tick + delay, std::move(wish.target));
      if (wish.note) note_sighting(list_, *wish.note);
      return;
    case AmendmentKind::kDismiss:
      return name_dismissal(list_, tick, *wish.note);
    case AmendmentKind::kLaw:
      return waits(list_.laws, tick + delay) ? replace_law(list_, std::move(wish.law))
                                             : name_law(list_, tick + delay, std::move(wish.law));
    case AmendmentKind::kEnd:
      return name_end(list_, tick + delay,
                      wish.tick_count > 0 ? wish.tick_count : soonest_tick_count(list_, tick));
    case AmendmentKind::kZone:
      return name_zone(list_, now, tick, delay, std::move(wish.zone));
    case AmendmentKind::kReopen:
      return name_reopening(list_, tick, wish.number);
    default:
      return name_pause(list_, tick + delay);
  }
}

}  // namespace ergocast
