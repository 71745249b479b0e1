// SPDX-License-Identifier: BSD-3-Clause
// Assembles the numbered parts of MISSION: the roster and the mission's state, as every process but
// the coordinator knows them.
#pragma once

#include <algorithm>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/base/ids.h"
#include "core/base/result.h"
#include "core/mission/amendments.h"
#include "core/mission/mission.h"
#include "team/messages.h"

namespace ergocast {

/// A hash of a part's content: its number and its shares of roster, plan and amendments.
std::uint64_t hash_of(const MissionPart& part);

class MissionFollower {
 public:
  /// From now on accepts only this plan: a foreign plan is a plan_problem().
  /// @pre no part has been received
  void expect_plan(std::vector<std::byte> plan) { expected_plan_ = std::move(plan); }
  /// From now on the mission also gets the table of its modes, if it needs one. This takes a second
  /// or more once, unless the table was handed over. A missing table is a plan_problem().
  void need_table() { needs_table_ = true; }

  /// Takes in one part, in any order. True if it completed a newer revision: all its parts have
  /// arrived, or older parts in place of the missing ones give its content_hash. A run has one
  /// plan: a revision with another plan or with an impossible list of amendments only counts in
  /// foreign_plans().
  bool receive(const MissionPart& part);

  /// The mission, once a whole plan has arrived and decoded.
  const std::optional<Mission>& mission() const { return mission_; }
  /// Why this program cannot use the received plan: another version, damage, or not the expected
  /// plan.
  const std::optional<std::string>& plan_problem() const { return plan_problem_; }
  /// Complete revisions that were ignored because their plan is not this run's, or their list of
  /// amendments is impossible.
  std::int64_t foreign_plans() const { return foreign_plans_; }

  std::int64_t revision() const { return revision_; }
  /// The newest revision of which any part was received; −1: none.
  std::int64_t newest_heard() const {
    return collected_.empty() ? revision_ : std::max(revision_, collected_.rbegin()->first);
  }
  MissionState state() const { return state_; }
  bool over() const { return is_over(state_); }
  const std::string& reason() const { return reason_; }
  /// What has changed since the plan; are_amendments() is true for it.
  const Amendments& amendments() const { return amendments_; }
  /// Ticks that do not count.
  std::span<const Hold> holds() const { return amendments_.holds; }
  /// See MissionPart.
  std::int64_t stand_by_revision() const { return stand_by_revision_; }
  /// In ascending order of authors.
  const std::vector<RosterEntry>& roster() const { return roster_; }
  const std::vector<std::byte>& plan() const { return plan_; }
  /// The newest complete revision as its coordinator sent it, for answers to mission requests. Its
  /// parts may be of several revisions.
  const std::vector<MissionPart>& parts() const { return parts_; }

  /// The entry of an incarnation, or null.
  const RosterEntry* entry_of(Incarnation incarnation) const;

 private:
  std::vector<std::byte> expected_plan_;  // empty: any
  bool needs_table_ = false;
  std::optional<Mission> mission_;
  std::optional<std::string> plan_problem_;
  std::int64_t foreign_plans_ = 0;
  std::int64_t revision_ = -1;
  MissionState state_ = MissionState::kWaiting;
  std::string reason_;
  Amendments amendments_;
  std::int64_t stand_by_revision_ = -1;
  std::vector<RosterEntry> roster_;
  std::vector<std::pair<Incarnation, std::size_t>> by_incarnation_;  // places in it, ascending
  std::vector<std::byte> plan_;
  std::vector<MissionPart> parts_;

  struct Page {
    MissionPart part;
    std::uint64_t hash;
  };
  using Pages = std::vector<std::optional<Page>>;

  const Page* newest_of(std::size_t part, std::int64_t revision) const;
  std::optional<std::vector<MissionPart>> completed(const MissionPart& newest) const;
  void forget_oldest();
  Result<Mission> read(const std::vector<std::byte>& plan) const;
  bool commit(const MissionPart& newest, std::vector<MissionPart> parts);

  std::map<std::int64_t, Pages> collected_;  // by revision, none of them complete
  Pages known_;                              // the newest of each that is no longer collected
};

/// Sequence numbers of one sender, counted per bus, so that a gap on a bus is a loss on that bus.
class Sequencer {
 public:
  std::int64_t next(Bus bus) { return ++last_[static_cast<std::size_t>(bus)]; }
  std::int64_t total() const { return last_[0] + last_[1] + last_[2]; }

 private:
  std::array<std::int64_t, kBusCount> last_{};
};

}  // namespace ergocast
