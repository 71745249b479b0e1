// SPDX-License-Identifier: BSD-3-Clause
// A simulated operator: it pauses a mission and resumes it, gives the team other targets, sends it
// out of zones, changes its speed, undoes that, and sends agents home or out of the mission.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "coordinator/coordinator.h"
#include "core/base/ids.h"
#include "core/mission/amendments.h"
#include "plan/amendment_list.h"
#include "team/amend_parts.h"
#include "team/messages.h"

namespace ergocast::lab {

class SimulatedOperator {
 public:
  /// From now on it wants the mission to be paused, for this long at least.
  void want_pause(Instant now, double lasts_s) {
    paused_until_ = std::max(paused_until_.value_or(now), now + seconds(lasts_s));
  }
  /// Wants the mission to go on, if its pause has been long enough.
  void end_pause(Instant now) {
    if (paused_until_ && *paused_until_ <= now) paused_until_.reset();
  }
  /// Wants the team to cover another target. It then wants no earlier one any more.
  /// @param sighting  from which the target follows
  void want_target(const TargetChange& target, Tick delay = 0,
                   const std::optional<SearchNote>& sighting = {}) {
    target_hash_ = target_hash(target);
    target_ = encode_target(target);
    target_delay_ = delay;
    if (!sighting) return;
    const auto place = encode_search_note(*sighting);
    target_.insert(target_.end(), place.begin(), place.end());
  }
  /// Wants a contact to be dismissed. The coordinator may refuse it; then it gives up.
  void want_dismissal(const SearchNote& note) {
    dismissal_ = note;
    dismissal_sent_ = 0;
  }
  /// Wants the mission to have another end. The coordinator may refuse it; then it gives up.
  void want_end(Tick tick_count) {
    end_ = tick_count;
    end_sent_ = 0;
  }
  /// Wants the team to leave a zone. It gives up if that is not obeyed soon.
  void want_zone(const Zone& zone, Tick notice, Instant now) {
    zone_hash_ = zone_hash(zone);
    zone_ = encode_zone(zone);
    zone_notice_ = notice;
    zone_wanted_ = now;
  }
  /// Wants the zone of this amendment to end. The coordinator may refuse it; then it gives up.
  void want_no_zone(std::int32_t number) { cancelled_zone_ = number; }
  /// Wants the law to have other numbers. It then wants no earlier ones any more.
  void want_law(const LawChange& law, Tick delay = 0) {
    law_hash_ = law_hash(law);
    law_ = encode_law(law);
    law_delay_ = delay;
  }
  /// Wants an agent to go home, or out of the mission if it `leaves`.
  void want_recall(AgentId id, bool leaves) { recalls_.push_back({{}, id, leaves, {}}); }
  /// Wants the mission to go on.
  void want_no_pause() { paused_until_.reset(); }
  /// Whether it has sent an agent out of the mission.
  bool sent_out(AgentId id) const { return sent_out_.contains(id); }
  /// When its pause ends; Instant::max(): it wants none.
  Instant next() const { return paused_until_.value_or(Instant::max()); }
  /// Whether it has wanted nothing yet, and wants nothing now.
  bool idle() const {
    return messages_ == 0 && !paused_until_ && recalls_.empty() && target_.empty() && !end_ &&
           zone_.empty() && !cancelled_zone_ && law_.empty() && !dismissal_;
  }
  /// The parts of the target that it sends now. It repeats them until the coordinator has named it.
  std::vector<Amend> targets(Instant now, RunId run, const Coordinator& coordinator) {
    const Amendments& list = coordinator.amendments();
    if (newest_hash(AmendmentKind::kTarget, list) == target_hash_) target_.clear();
    if (target_.empty() || now < next_target_) return {};
    next_target_ = now + kPeriod;
    auto parts = in_parts({.header = {run, kOperator, 1, messages_ + 1, coordinator.tick()},
                           .number = list.named,
                           .kind = AmendmentKind::kTarget,
                           .delay_ticks = target_delay_},
                          target_);
    messages_ += std::ssize(parts);
    return parts;
  }

  /// The end that it sends now: some times, until the coordinator has named it.
  std::vector<Amend> ends(Instant now, RunId run, const Coordinator& coordinator) {
    if (!end_ || now < next_end_) return {};
    const auto& ends = coordinator.amendments().ends;
    if (++end_sent_ > kMostEndsSent || (!ends.empty() && ends.back().tick_count == *end_)) {
      end_.reset();
      return {};
    }
    next_end_ = now + kPeriod;
    return in_parts({.header = {run, kOperator, 1, ++messages_, coordinator.tick()},
                     .number = coordinator.amendments().named,
                     .kind = AmendmentKind::kEnd},
                    encode_end(*end_));
  }
  /// The parts of the zone that it sends now.
  std::vector<Amend> zones(Instant now, RunId run, const Coordinator& coordinator) {
    const Amendments& list = coordinator.amendments();
    const auto is_ours = [this](const Amendment& one) { return one.hash == zone_hash_; };
    const bool named = std::ranges::any_of(list.recent, is_ours);
    if (named || now - zone_wanted_ > kPatience) zone_.clear();
    if (zone_.empty() || now < next_zone_) return {};
    next_zone_ = now + kPeriod;
    auto parts = in_parts({.header = {run, kOperator, 2, messages_ + 1, coordinator.tick()},
                           .number = list.named,
                           .kind = AmendmentKind::kZone,
                           .delay_ticks = zone_notice_},
                          zone_);
    messages_ += std::ssize(parts);
    return parts;
  }

  /// What it sends now to end a zone.
  std::optional<Amend> cancelled_zone(Instant now, RunId run, const Coordinator& coordinator) {
    const Amendments& list = coordinator.amendments();
    if (cancelled_zone_ && !can_reopen(list, *cancelled_zone_, coordinator.tick()))
      cancelled_zone_.reset();
    if (!cancelled_zone_ || now < next_cancel_) return {};
    next_cancel_ = now + kPeriod;
    return Amend{.header = {run, kOperator, 4, ++messages_, coordinator.tick()},
                 .number = list.named,
                 .kind = AmendmentKind::kReopen,
                 .content = encode_reopening(*cancelled_zone_)};
  }

  /// What it sends now to dismiss a contact: some times, until the coordinator has named it.
  std::optional<Amend> dismissal(Instant now, RunId run, const Coordinator& coordinator) {
    if (!dismissal_ || now < next_dismissal_) return {};
    const Amendments& list = coordinator.amendments();
    const bool named = newest_hash(AmendmentKind::kDismiss, list) == search_note_hash(*dismissal_);
    if (++dismissal_sent_ > kMostEndsSent || named) {
      dismissal_.reset();
      return {};
    }
    next_dismissal_ = now + kPeriod;
    return Amend{.header = {run, kOperator, 5, ++messages_, coordinator.tick()},
                 .number = list.named,
                 .kind = AmendmentKind::kDismiss,
                 .content = encode_search_note(*dismissal_)};
  }

  /// The law that it sends now. It repeats it until the coordinator has named it.
  std::vector<Amend> laws(Instant now, RunId run, const Coordinator& coordinator) {
    const Amendments& list = coordinator.amendments();
    if (newest_hash(AmendmentKind::kLaw, list) == law_hash_) law_.clear();
    if (law_.empty() || now < next_law_) return {};
    next_law_ = now + kPeriod;
    return in_parts({.header = {run, kOperator, 3, ++messages_, coordinator.tick()},
                     .number = list.named,
                     .kind = AmendmentKind::kLaw,
                     .delay_ticks = law_delay_,
                     .by = "operator@laboratory"},
                    law_);
  }

  /// The message that it sends now. It repeats its wish until a tick is named.
  std::optional<Amend> message(Instant now, RunId run, const Coordinator& coordinator) {
    const auto& holds = coordinator.holds();
    if (is_open(holds) == paused_until_.has_value()) {
      next_message_ = now;
      return {};
    }
    if (now < next_message_) return {};
    next_message_ = now + kPeriod;
    return Amend{.header = {run, kOperator, 1, ++messages_, coordinator.tick()},
                 .number = coordinator.amendments().named,
                 .kind = is_open(holds) ? AmendmentKind::kResume : AmendmentKind::kPause};
  }
  /// The recalls that it sends now: those that the coordinator does not know. The coordinator
  /// receives each of them at once. It may be lost with this coordinator; then it is sent again.
  std::vector<Recall> recalls(RunId run, const Coordinator& coordinator) {
    std::vector<Recall> sent;
    if (coordinator.state() != MissionState::kRunning) return sent;
    for (Recall& recall : recalls_) {
      if (is_obeyed(recall, coordinator)) continue;
      recall.header = {run, kOperator, 1, ++messages_, coordinator.tick()};
      if (recall.leaves) sent_out_.insert(recall.agent);
      sent.push_back(recall);
    }
    return sent;
  }
  /// Forgets the recalls that the coordinator has received and refused.
  void forget_refused(const Coordinator& coordinator) {
    std::erase_if(recalls_, [&](const Recall& recall) {
      const bool refused = !is_obeyed(recall, coordinator);
      if (refused && recall.leaves) sent_out_.erase(recall.agent);
      return refused;
    });
  }

 private:
  /// The hash of the newest amendment of a kind; nothing if the list names none.
  static std::optional<std::uint64_t> newest_hash(AmendmentKind kind, const Amendments& list) {
    const auto found = std::find_if(list.recent.rbegin(), list.recent.rend(),
                                    [kind](const Amendment& one) { return one.kind == kind; });
    return found == list.recent.rend() ? std::nullopt : std::optional(found->hash);
  }
  static bool is_obeyed(const Recall& recall, const Coordinator& coordinator) {
    return std::ranges::any_of(coordinator.roster(), [&](const RosterEntry& entry) {
      return entry.author.agent == recall.agent && entry.recalled() &&
             (entry.leaves || !recall.leaves);
    });
  }

  /// As `ergocast pause` repeats it.
  static constexpr auto kPeriod = std::chrono::milliseconds(100);
  static constexpr auto kPatience = std::chrono::seconds(5);

  std::optional<Instant> paused_until_;
  Instant next_message_;  // until its wish is obeyed
  std::int64_t messages_ = 0;
  std::vector<std::byte> target_;  // that it wants, as AMEND carries it
  std::uint64_t target_hash_ = 0;
  Tick target_delay_ = 0;
  Instant next_target_;
  static constexpr int kMostEndsSent = 10;
  std::optional<Tick> end_;  // that it wants
  int end_sent_ = 0;
  Instant next_end_;
  std::vector<std::byte> zone_;  // that it wants
  std::uint64_t zone_hash_ = 0;
  Tick zone_notice_ = 0;
  Instant zone_wanted_, next_zone_;
  std::optional<std::int32_t> cancelled_zone_;  // that it wants to end
  Instant next_cancel_;
  std::optional<SearchNote> dismissal_;  // that it wants
  int dismissal_sent_ = 0;
  Instant next_dismissal_;
  std::vector<std::byte> law_;  // that it wants
  std::uint64_t law_hash_ = 0;
  Tick law_delay_ = 0;
  Instant next_law_;
  std::vector<Recall> recalls_;  // that it wants
  std::set<AgentId> sent_out_;
};

}  // namespace ergocast::lab
