// SPDX-License-Identifier: BSD-3-Clause
// Ages from echoes, the lease, and beacons that must be refused.
#include "team/beacon_book.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "tests/support/team.h"

namespace ergocast {
namespace {

using namespace test;

constexpr Tick kLease = 20;

Mission leased(int agents) {
  Mission mission = small_mission(agents);
  mission.timing.pace = Pace::kRealtime;
  mission.timing.command_hold_s = 0;
  mission.speed_limit_mps = 40;
  mission.separation.distance_m = 30;
  mission.separation.lease_s = 2;
  return mission;
}

Moment moment(Tick tick) { return {tick, at(tick * 100ms)}; }

/// Agents that receive each other, each with a driver. All act within one tick, in ascending order.
class Team {
 public:
  explicit Team(int agents) : mission_(leased(agents)), roster_(roster_of(agents)) {
    for (AgentId id = 0; id < agents; ++id) {
      books_.emplace_back(mission_, author_of(id), 1);
      books_.back().note_roster(roster_);
      places_m_.push_back({35.0 * id, 0, 0});
    }
  }

  /// @param receives  whether messages of the first agent reach the second
  void pass(
      Tick tick, const std::function<bool(AgentId, AgentId)>& receives = [](AgentId, AgentId) {
        return true;
      }) {
    for (AgentId id = 0; id < std::ssize(books_); ++id) {
      BeaconBook& book = books_[static_cast<std::size_t>(id)];
      book.measured(tick - 1, 1, places_m_[static_cast<std::size_t>(id)], {0, 0, 0});
      if (const auto beacon = book.next(1, moment(tick))) send(id, *beacon, tick, receives);
      book.bodies(places_m_[static_cast<std::size_t>(id)], moment(tick));
      book.commands(moment(tick));
    }
  }
  void send(AgentId from, Beacon beacon, Tick tick,
            const std::function<bool(AgentId, AgentId)>& receives) {
    beacon.header = {kRun, from, incarnation_of(from), ++sequence_, tick};
    last_[from] = beacon;
    for (AgentId to = 0; to < std::ssize(books_); ++to) {
      if (to != from && receives(from, to))
        books_[static_cast<std::size_t>(to)].receive(beacon, true, moment(tick));
    }
  }

  Neighbour seen(AgentId by, AgentId of, Tick tick) {
    const auto all = books_[static_cast<std::size_t>(by)].bodies(
        places_m_[static_cast<std::size_t>(by)], moment(tick));
    const auto at = std::ranges::find(all, of, &Neighbour::id);
    EXPECT_NE(at, all.end());
    return at == all.end() ? Neighbour{} : *at;
  }
  BeaconBook& book(AgentId id) { return books_[static_cast<std::size_t>(id)]; }
  Eigen::Vector3d& place_m(AgentId id) { return places_m_[static_cast<std::size_t>(id)]; }
  const Beacon& last(AgentId id) { return last_[id]; }
  std::vector<RosterEntry>& roster() { return roster_; }
  void note_roster() {
    for (BeaconBook& book : books_) book.note_roster(roster_);
  }

 private:
  Mission mission_;
  std::vector<RosterEntry> roster_;
  std::vector<BeaconBook> books_;
  std::vector<Eigen::Vector3d> places_m_;
  std::map<AgentId, Beacon> last_;
  std::int64_t sequence_ = 0;
};

TEST(BeaconBook, KnowsNoAgentAtFirst) {
  Team team(3);
  EXPECT_FALSE(team.seen(0, 2, 0).known);
  EXPECT_FALSE(team.book(0).next(1, moment(0))) << "no state has answered a command yet";
  team.book(0).commands(moment(4));
  team.book(0).measured(3, 1, {0, 0, 0}, {0, 0, 0});
  EXPECT_FALSE(team.book(0).next(1, moment(5))) << "the state answers another command";
  team.book(0).measured(4, 0, {0, 0, 0}, {0, 0, 0});
  EXPECT_FALSE(team.book(0).next(1, moment(5))) << "a predecessor's command";
  team.book(0).measured(4, 1, {0, 0, 0}, {0, 0, 0});
  EXPECT_TRUE(team.book(0).next(1, moment(5)));
}

/// Agents whose beacons arrive late or never, and whose drivers are late. The measurement of a tick
/// arrives `lag` ticks later, and so do commands at the driver.
class LateTeam {
 public:
  LateTeam() {
    for (AgentId id = 0; id < kAgents; ++id) {
      books_.emplace_back(leased(kAgents), author_of(id), 1);
      books_.back().note_roster(roster_of(kAgents));
    }
  }

  void pass(Tick tick) {
    for (AgentId id = 0; id < kAgents; ++id) {
      BeaconBook& book = books_[static_cast<std::size_t>(id)];
      const Tick lag = id;
      while (!coming_[id].empty() && coming_[id].front().first <= tick) {
        book.receive(coming_[id].front().second, true, moment(tick));
        coming_[id].erase(coming_[id].begin());
      }
      // The position shows when it was measured.
      const Tick measured = tick - lag;
      book.measured(measured - lag - 1, 1, {40.0 * id, static_cast<double>(measured), 0},
                    {0, 0, 0});
      if (auto beacon = book.next(1, moment(tick))) send(id, *beacon, tick);
      book.commands(moment(tick));
    }
  }
  std::span<const Neighbour> bodies(AgentId id, Tick tick) {
    return books_[static_cast<std::size_t>(id)].bodies({40.0 * id, 0, 0}, moment(tick));
  }
  static constexpr AgentId kAgents = 4;

 private:
  void send(AgentId from, Beacon beacon, Tick tick) {
    beacon.header = {kRun, from, incarnation_of(from), ++sequence_, tick};
    for (AgentId to = 0; to < kAgents; ++to) {
      const auto draw = static_cast<Tick>((sequence_ * 7919 + to * 104729) % 1009);
      if (to == from || draw % 4 == 0) continue;
      Tick& last = last_arrival_[{from, to}];
      last = std::max(last, tick + draw % 5);  // the order on a link is kept
      coming_[to].emplace_back(last, beacon);
      std::ranges::stable_sort(coming_[to], {}, &std::pair<Tick, Beacon>::first);
    }
  }

  std::vector<BeaconBook> books_;
  std::map<AgentId, std::vector<std::pair<Tick, Beacon>>> coming_;
  std::map<std::pair<AgentId, AgentId>, Tick> last_arrival_;
  std::int64_t sequence_ = 0;
};

TEST(BeaconBook, NeverUnderstatesAnAge) {
  LateTeam team;
  int known = 0;
  Tick closest = kLease;
  for (Tick tick = 0; tick < 2000; ++tick) {
    team.pass(tick);
    for (AgentId by = 0; by < LateTeam::kAgents; ++by) {
      for (const Neighbour& body : team.bodies(by, tick)) {
        if (!body.known) continue;
        ++known;
        const Tick true_age = tick - static_cast<Tick>(body.position_m.y());
        ASSERT_GE(body.age_ticks, std::min(true_age, kLease)) << by << " of " << body.id << tick;
        closest = std::min(closest, body.age_ticks - true_age);
      }
    }
  }
  EXPECT_GT(known, 10000);
  EXPECT_LE(closest, 2) << "no tighter than that would show nothing";
}

TEST(BeaconBook, AgesAreAFewTicksWhereNothingIsLost) {
  Team team(2);
  for (Tick tick = 0; tick < 20; ++tick) team.pass(tick);
  EXPECT_TRUE(team.seen(0, 1, 19).known);
  EXPECT_GE(team.seen(0, 1, 19).age_ticks, 1);
  EXPECT_LE(team.seen(0, 1, 19).age_ticks, 3);
}

/// The clock or the ticks may have stood still.
TEST(BeaconBook, CountsTheMoreOfTicksAndTime) {
  Team team(2);
  for (Tick tick = 0; tick < 20; ++tick) team.pass(tick);
  const Tick age = team.seen(0, 1, 19).age_ticks;
  const auto age_at = [&](const Moment& now) {
    return team.book(0).bodies({0, 0, 0}, now)[0].age_ticks;
  };
  EXPECT_EQ(age_at({19, at(1900ms + 500ms)}), age + 5);
  EXPECT_EQ(age_at({19, at(1900ms + 501ms)}), age + 6) << "rounded up";
  EXPECT_EQ(age_at({25, at(1900ms)}), age + 6);
}

TEST(BeaconBook, AnAgentWithoutEchoesForTheLeaseMustStand) {
  Team team(3);
  for (Tick tick = 0; tick < 30; ++tick) team.pass(tick);
  EXPECT_TRUE(team.seen(0, 1, 29).known);
  // 1 no longer receives 0, and all receive 1.
  const auto deaf = [](AgentId from, AgentId to) { return from != 0 || to != 1; };
  Tick stood = 0;
  for (Tick tick = 30; tick < 70; ++tick) {
    team.pass(tick, deaf);
    if (stood == 0 && !team.seen(0, 1, tick).known) stood = tick;
    EXPECT_TRUE(team.seen(0, 2, tick).known) << "2 does receive it";
    EXPECT_TRUE(team.seen(2, 0, tick).known);
  }
  EXPECT_GE(stood, 45);
  EXPECT_LE(stood, 29 + kLease);
  for (Tick tick = 70; tick < 80; ++tick) team.pass(tick);
  EXPECT_TRUE(team.seen(0, 1, 79).known) << "the lease is renewed";
}

/// However old a position is: the body stands by then, or its agent has left.
TEST(BeaconBook, AnAgeIsNeverMoreThanTheLease) {
  Team team(2);
  for (Tick tick = 0; tick < 10; ++tick) team.pass(tick);
  EXPECT_EQ(team.seen(0, 1, 1000).age_ticks, kLease);
  EXPECT_FALSE(team.seen(0, 1, 1000).known) << "we must stand, too: it may not receive us";
  team.roster()[1].active_until = 900;
  team.note_roster();
  EXPECT_TRUE(team.seen(0, 1, 1000).known) << "it has left, and need not receive us";
  EXPECT_EQ(team.seen(0, 1, 1000).age_ticks, kLease);
}

TEST(BeaconBook, DoesNotEchoAgentsThatHaveLeft) {
  Team team(3);
  for (Tick tick = 0; tick < 10; ++tick) team.pass(tick);
  EXPECT_NE(team.last(0).echoes[1], 0);
  team.roster()[1].active_until = 9;
  team.note_roster();
  team.pass(10);
  EXPECT_EQ(team.last(0).echoes[1], 0);
  EXPECT_NE(team.last(0).echoes[2], 0);
}

TEST(BeaconBook, AnEchoOfAnotherIncarnationIsNone) {
  Team team(2);
  for (Tick tick = 0; tick < 10; ++tick) team.pass(tick);
  // A successor of 0, which also numbers its beacons from 1 on.
  BeaconBook successor(leased(2), {0, 77}, 5);
  std::vector<RosterEntry> roster = team.roster();
  roster[0].active_until = 9;
  roster.push_back({{0, 77}, 9, -1});
  successor.note_roster(roster);
  for (Tick tick = 10; tick < 20; ++tick) {
    successor.commands(moment(tick));
    successor.measured(tick, 5, {0, 0, 0}, {0, 0, 0});
    ASSERT_TRUE(successor.next(5, moment(tick)));
  }
  Beacon beacon = team.last(1);  // echoes the predecessor's 8 or 9
  successor.receive(beacon, true, moment(20));
  EXPECT_FALSE(successor.bodies({0, 0, 0}, moment(20))[0].known);
  beacon.roster_revision = 5;  // as if it knew the successor
  successor.receive(beacon, true, moment(20));
  EXPECT_TRUE(successor.bodies({0, 0, 0}, moment(20))[0].known);
}

TEST(BeaconBook, ASuccessorStandsUntilItIsEchoed) {
  Team team(2);
  for (Tick tick = 0; tick < 10; ++tick) team.pass(tick);
  team.roster()[1].active_until = 9;
  team.roster().push_back({{1, 77}, 9, -1});
  team.book(0).note_roster(team.roster());
  const Neighbour body = team.seen(0, 1, 10);
  EXPECT_FALSE(body.known) << "it has not received us";
  EXPECT_EQ(body.age_ticks, kLease);
  Beacon stranger = team.last(1);
  stranger.position_m = {555, 0, 0};
  team.book(0).receive(stranger, true, moment(10));
  EXPECT_EQ(team.seen(0, 1, 10).position_m, body.position_m) << "of the former incarnation";
  stranger.header.incarnation = 77;
  stranger.echo_count = 0;
  team.book(0).receive(stranger, true, moment(10));
  EXPECT_EQ(team.seen(0, 1, 10).position_m.x(), 555) << "it has not moved since it came";
}

TEST(BeaconBook, RefusesWhatComesLateOrFromTheFuture) {
  Team team(2);
  for (Tick tick = 0; tick < 10; ++tick) team.pass(tick);
  const Eigen::Vector3d place_m = team.seen(0, 1, 10).position_m;
  Beacon late = team.last(1);
  late.position_m = {999, 0, 0};
  team.book(0).receive(late, false, moment(10));
  EXPECT_EQ(team.book(0).late(), 1);
  EXPECT_EQ(team.seen(0, 1, 10).position_m, place_m);
  Beacon early = late;
  early.echoes[0] = static_cast<std::uint16_t>(team.last(0).number + 1);
  team.book(0).receive(early, true, moment(10));
  EXPECT_EQ(team.book(0).from_the_future(), 1);
  EXPECT_EQ(team.seen(0, 1, 10).position_m, place_m);
  early.echoes[0] = 40000;
  team.book(0).receive(early, true, moment(10));
  EXPECT_EQ(team.book(0).from_the_future(), 2);
}

TEST(BeaconBook, ItsNumbersWrapAround) {
  Team team(2);
  Tick tick = 0;
  for (; tick < 65535 + 50; ++tick) {
    team.pass(tick);
    if (tick < 10) continue;
    ASSERT_TRUE(team.seen(0, 1, tick).known) << tick;
    ASSERT_LE(team.seen(0, 1, tick).age_ticks, 3) << tick;
    ASSERT_NE(team.last(0).number, 0);
  }
  EXPECT_LT(team.last(0).number, 100);
  EXPECT_EQ(team.book(0).from_the_future(), 0);
  Beacon old = team.last(1);
  old.echoes[0] = 65000;
  team.book(0).receive(old, true, moment(tick));
  EXPECT_EQ(team.book(0).from_the_future(), 0) << "of before, and too old to matter";
  old.echoes[0] = static_cast<std::uint16_t>(team.last(0).number + 1);
  team.book(0).receive(old, true, moment(tick));
  EXPECT_EQ(team.book(0).from_the_future(), 1);
}

TEST(BeaconBook, SendsMoreRarelyWhileNoAgentIsNear) {
  Team team(2);
  Tick tick = 0;
  const auto sent_in = [&](int ticks) {
    const auto before = team.last(0).number;
    for (const Tick end = tick + ticks; tick < end; ++tick) team.pass(tick);
    return team.last(0).number - before;
  };
  team.place_m(1) = {1900, 1900, 0};
  sent_in(20);
  EXPECT_EQ(sent_in(40), 20) << "an eighth of the lease is two ticks";
  EXPECT_TRUE(team.seen(0, 1, tick).known);
  team.place_m(1) = {35, 0, 0};
  sent_in(10);
  EXPECT_EQ(sent_in(40), 40);
}

}  // namespace
}  // namespace ergocast
