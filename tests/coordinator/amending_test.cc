// SPDX-License-Identifier: BSD-3-Clause
// A new target: it is named once all its parts have come, and only if it follows the newest one.
#include <gtest/gtest.h>

#include <algorithm>

#include "team/amend_parts.h"
#include "tests/coordinator/driven_coordinator.h"
#include "tests/coordinator/successor.h"

namespace ergocast {
namespace {

using namespace test;

Mission wide_mission() {
  Mission mission = small_mission(2);
  mission.basis.modes_x = mission.basis.modes_y = 15;
  mission.target_coefficients = Coefficients::Zero(225);
  mission.target_coefficients[0] = 1;
  mission.timing.tick_count = 1000;
  return mission;
}

TargetChange target(double first) {
  TargetChange change;
  change.target = wide_mission().target_coefficients;
  change.target[1] = first;
  return change;
}

/// The parts of an AMEND by one operator.
std::vector<Amend> wish(double first, std::int32_t number, Incarnation by = 1) {
  return in_parts({.header = {kRun, kOperator, by, next_sequence(), 0},
                   .number = number,
                   .kind = AmendmentKind::kTarget},
                  encode_target(target(first)));
}

/// Lockstep: the world stands by, and the coordinator names the tick.
void let_world_stand_by(Coordinator& coordinator, Tick tick) {
  const auto parts = only<MissionPart>(advance(coordinator, at(1s)));
  ASSERT_FALSE(parts.empty());
  WorldState world = world_where(tick, {9, 9});
  world.roster_revision = parts[0].revision;
  give(coordinator, world, at(1s));
}

TEST(Amending, NamesATargetOnceAllItsPartsHaveCome) {
  Coordinator coordinator = running_coordinator(wide_mission());
  give(coordinator, world_where(10, {9, 9}), at(1s));
  auto parts = wish(0.5, 0);
  ASSERT_EQ(parts.size(), 4U);
  std::swap(parts[0], parts[3]);
  for (const Amend& part : parts) {
    EXPECT_TRUE(coordinator.amendments().targets.empty());
    give(coordinator, part, at(1s));
    give(coordinator, part, at(1s));
  }
  let_world_stand_by(coordinator, 11);
  ASSERT_EQ(coordinator.amendments().targets.size(), 1U);
  EXPECT_EQ(coordinator.amendments().targets[0].from, 13);
  EXPECT_EQ(coordinator.amendments().recent[0].hash, target_hash(target(0.5)));
  for (const Amend& part : parts) give(coordinator, part, at(1s));
  EXPECT_EQ(coordinator.amendments().named, 1) << "it is obeyed once";
}

TEST(Amending, MissionCarriesTheListAfterThePlan) {
  Coordinator coordinator = running_coordinator(wide_mission());
  give(coordinator, world_where(10, {9, 9}), at(1s));
  for (const Amend& part : wish(0.5, 0)) give(coordinator, part, at(1s));
  let_world_stand_by(coordinator, 11);
  MissionFollower follower;
  for (const MissionPart& part : only<MissionPart>(advance(coordinator, at(2s))))
    follower.receive(part);
  ASSERT_TRUE(follower.mission());
  EXPECT_EQ(follower.amendments(), coordinator.amendments());
}

TEST(Amending, PartsOfTwoOperatorsDoNotMix) {
  Coordinator coordinator = running_coordinator(wide_mission());
  give(coordinator, world_where(10, {9, 9}), at(1s));
  const auto one = wish(0.25, 0, 1), other = wish(0.75, 0, 2);
  for (std::size_t i = 0; i < 3; ++i) {
    give(coordinator, one[i], at(1s));
    give(coordinator, other[3 - i], at(1s));
  }
  give(coordinator, other[0], at(1s));
  let_world_stand_by(coordinator, 11);
  ASSERT_EQ(coordinator.amendments().named, 1);
  EXPECT_EQ(coordinator.amendments().recent[0].hash, target_hash(target(0.75)));
  EXPECT_EQ(coordinator.amendments().recent[0].ordered_by, 2U);
}

TEST(Amending, RefusesWhatIsNoTargetOfTheMission) {
  for (const double first : {1.5, std::nan("")}) {
    Coordinator coordinator = running_coordinator(wide_mission());
    give(coordinator, world_where(10, {9, 9}), at(1s));
    for (const Amend& part : wish(first, 0)) give(coordinator, part, at(1s));
    for (Amend part : wish(0.5, 0, 2)) {
      if (part.part == 3) part.content.pop_back();
      give(coordinator, part, at(1s));
    }
    let_world_stand_by(coordinator, 11);
    EXPECT_EQ(coordinator.amendments().named, 0);
  }
}

TEST(Amending, NamesNoTargetWhileAnotherOneWaitsForItsTick) {
  Coordinator coordinator = running_coordinator(wide_mission());
  give(coordinator, world_where(10, {9, 9}), at(1s));
  auto late = wish(0.5, 0);
  for (Amend& part : late) part.delay_ticks = 100;
  for (const Amend& part : late) give(coordinator, part, at(1s));
  let_world_stand_by(coordinator, 11);
  ASSERT_EQ(coordinator.amendments().targets.at(0).from, 113);
  for (const Amend& part : wish(0.75, 1)) give(coordinator, part, at(1s));
  let_world_stand_by(coordinator, 12);
  EXPECT_EQ(coordinator.amendments().named, 1);
  give(coordinator, world_where(113, {113, 113}), at(1s));
  for (const Amend& part : wish(0.75, 1)) give(coordinator, part, at(1s));
  let_world_stand_by(coordinator, 114);
  EXPECT_EQ(coordinator.amendments().named, 2);
}

TEST(Amending, NamesNoTargetAfterTheMissionsEnd) {
  for (const Tick delay : {989, 990}) {
    Coordinator coordinator = running_coordinator(wide_mission());
    give(coordinator, world_where(10, {9, 9}), at(1s));
    for (Amend part : wish(0.5, 0)) {
      part.delay_ticks = delay;
      give(coordinator, part, at(1s));
    }
    let_world_stand_by(coordinator, 11);
    EXPECT_EQ(coordinator.amendments().named, 10 + delay < 1000 ? 1 : 0);
  }
}

// An operator that cancels it sends the target that holds.
TEST(Amending, ATargetThatWaitsIsReplacedByTheOneThatHolds) {
  Coordinator coordinator = running_coordinator(wide_mission());
  give(coordinator, world_where(10, {9, 9}), at(1s));
  for (Amend part : wish(0.5, 0)) {
    part.delay_ticks = 100;
    give(coordinator, part, at(1s));
  }
  let_world_stand_by(coordinator, 11);
  for (const Amend& part : wish(0, 1)) give(coordinator, part, at(1s));
  let_world_stand_by(coordinator, 12);
  ASSERT_EQ(coordinator.amendments().named, 2);
  ASSERT_EQ(coordinator.amendments().targets.size(), 1U);
  EXPECT_EQ(coordinator.amendments().targets[0].from, 113);
  EXPECT_EQ(coordinator.amendments().targets[0].number, 1);
  EXPECT_EQ(coordinator.amendments().targets[0].target, wide_mission().target_coefficients);
}

/// An AMEND of one part.
Amend one_part(Amend wish, const std::vector<std::byte>& content, Incarnation by = 1) {
  wish.header = {kRun, kOperator, by, next_sequence(), 0};
  return in_parts(wish, content).at(0);
}

Amend wish_of_end(Tick tick_count, std::int32_t number, Incarnation by = 1) {
  return one_part({.number = number, .kind = AmendmentKind::kEnd}, encode_end(tick_count), by);
}

TEST(Amending, NamesAnEnd) {
  Coordinator coordinator = running_coordinator(wide_mission());
  give(coordinator, world_where(10, {9, 9}), at(1s));
  give(coordinator, wish_of_end(500, 0), at(1s));
  let_world_stand_by(coordinator, 11);
  EXPECT_EQ(coordinator.amendments().ends, (std::vector<EndChange>{{0, 13, 500}}));
  const auto status = only<TeamStatus>(advance(coordinator, at(2s)));
  ASSERT_FALSE(status.empty());
  EXPECT_EQ(status[0].tick_count, 500);
  give(coordinator, wish_of_end(600, 0, 2), at(2s));
  give(coordinator, world_where(12, {11, 11}), at(2s));
  EXPECT_EQ(coordinator.amendments().named, 1) << "another order was first";
  give(coordinator, world_where(499, {498, 498}), at(3s));
  EXPECT_EQ(coordinator.state(), MissionState::kRunning);
  give(coordinator, world_where(500, {499, 499}), at(3s));
  EXPECT_EQ(coordinator.state(), MissionState::kEnded);
}

TEST(Amending, NamesNoEndThatTheTeamCannotKeep) {
  for (const auto& [tick, tick_count, named] :
       {std::tuple(Tick{10}, Tick{13}, 0), std::tuple(Tick{10}, Tick{14}, 1),
        std::tuple(Tick{10}, Tick{1000}, 0), std::tuple(Tick{890}, Tick{2000}, 1),
        std::tuple(Tick{899}, Tick{2000}, 0), std::tuple(Tick{10}, Tick{0}, 0)}) {
    Coordinator coordinator = running_coordinator(wide_mission());
    give(coordinator, world_where(tick, {tick - 1, tick - 1}), at(1s));
    give(coordinator, wish_of_end(tick_count, 0), at(1s));
    let_world_stand_by(coordinator, tick + 1);
    EXPECT_EQ(coordinator.amendments().named, named) << tick_count;
  }
}

TEST(Amending, NamesNoEarlierEndThatAnAgentCannotBeHomeFor) {
  for (const bool near : {false, true}) {
    Mission mission = wide_mission();
    mission.kinds = {{"a", 2, 10, 0, 0}};
    mission.kinds[0].stations_m = {{near ? 10.0 : 1900.0, 1, 0}};
    mission.kinds[0].reserve_s = 1;
    Coordinator coordinator = running_coordinator(mission);
    give(coordinator, world_where(10, {9, 9}), at(1s));
    give(coordinator, wish_of_end(500, 0), at(1s));
    let_world_stand_by(coordinator, 11);
    EXPECT_EQ(coordinator.amendments().named, near ? 1 : 0);
  }
}

TEST(Amending, AnEndIsNotDelayed) {
  Coordinator coordinator = running_coordinator(wide_mission());
  give(coordinator, world_where(10, {9, 9}), at(1s));
  Amend wish = wish_of_end(500, 0);
  wish.delay_ticks = 1;
  give(coordinator, wish, at(1s));
  let_world_stand_by(coordinator, 11);
  EXPECT_EQ(coordinator.amendments().named, 0);
}

// A large team's state arrives in parts. Drivers of one vehicle each send a part, too, and each
// goes by its own clock.
TEST(TeamPlaces, AreTheNewestOfEachAgentAndAsOldAsTheOldest) {
  const auto part = [](Tick tick, AgentId id, Incarnation driver = 1) {
    WorldState world = world_state(tick, {{1.0 * static_cast<double>(tick), 0, 0}});
    world.header.incarnation = driver;
    world.part = id;
    world.parts = 2;
    world.vehicles[0].id = id;
    return world;
  };
  const std::vector<RosterEntry> roster = roster_of(2);
  TeamPlaces places;
  EXPECT_EQ(places.tick(roster), -1);
  places.note_world(part(10, 0));
  EXPECT_EQ(places.of(roster)[1].x_m, std::nullopt);
  places.note_world(part(12, 1, 2));
  places.note_world(part(13, 0));
  places.note_world(part(11, 0));
  EXPECT_EQ(places.tick(roster), 12);
  EXPECT_EQ(places.of(roster)[0].x_m->x(), 13) << "and not of the state that came late";
  EXPECT_EQ(places.of(roster)[1].x_m->x(), 12);
}

TEST(Amending, ASuccessorKnowsTheEnd) {
  MissionPart memory = memory_of(3);
  Amendments list;
  name_end(list, 2, 150);
  memory.amendments = encode_amendments(list);
  Coordinator coordinator = taken_over(memory);
  EXPECT_EQ(coordinator.amendments(), list);
  const auto status = only<TeamStatus>(advance(coordinator, at(60s)));
  ASSERT_FALSE(status.empty());
  EXPECT_EQ(status[0].tick_count, 150);
}

TEST(Amending, ASuccessorKnowsTheTargets) {
  MissionPart memory = memory_of(3);
  TargetChange change;
  change.target = small_mission(2).target_coefficients;
  change.target[1] = 0.5;
  Amendments list;
  name_target(list, 2, change);
  memory.amendments = encode_amendments(list);
  Coordinator coordinator = taken_over(memory);
  EXPECT_EQ(coordinator.amendments(), list);
}

// Another coordinator has listed and named more than this one.
TEST(Amending, APlanIsForgottenForANewerList) {
  const Mission mission = wide_mission();
  const Zone zone{.until = 50, .corners_m = {{100, 100}, {400, 100}, {400, 400}}};
  Amendments planned;
  for (int i = 0; i < 4; ++i) add_target(planned, 10 + 10 * i, target(0.1 * i));
  for (std::size_t i = 0; i < kMaxZones + 1; ++i) add_zone(planned, 5, 3, zone);
  Amending amending;
  amending.plan(planned);
  Amendments known = planned;
  known.targets.erase(known.targets.begin(), known.targets.end() - 2);
  known.zones.clear();
  name_end(known, 100, 500);
  amending.adopt(known);
  const Participant me(Role::kCoordinator, {kRun, kCoordinator, kCoordinatorLife});
  const SignsOfLife signs{me, at(1s)};
  const TeamPlaces places;
  const std::vector<RosterEntry> roster;
  TickWatch ticks;
  ticks.receive(world_where(200, {199, 199}), at(1s));
  Announcement announcement;
  amending.note_world(mission, ticks, {signs, places, roster}, announcement);
  EXPECT_LT(amending.stand_by_revision(), 0) << "it would list what has been listed";
  EXPECT_EQ(amending.list(), known);
}

// ---- zones ----

/// An AMEND that asks for a square zone.
Amend zone_wish(double x_m, std::int32_t number, double size_m = 200, Tick lasts = 100) {
  Zone zone;
  zone.until = lasts;
  const double y_m = std::min(x_m, 100.0), far_x_m = x_m + size_m, far_y_m = y_m + size_m;
  zone.corners_m = {{x_m, y_m}, {far_x_m, y_m}, {far_x_m, far_y_m}, {x_m, far_y_m}};
  return one_part({.number = number, .kind = AmendmentKind::kZone, .delay_ticks = 50},
                  encode_zone(zone));
}

TEST(Amending, ClosesAZoneAtOnceAndFreesItLater) {
  Coordinator coordinator = running_coordinator(wide_mission());
  give(coordinator, world_where(10, {9, 9}), at(1s));
  give(coordinator, zone_wish(300, 0), at(1s));
  let_world_stand_by(coordinator, 11);
  ASSERT_EQ(coordinator.amendments().zones.size(), 1U);
  const Zone& zone = coordinator.amendments().zones[0];
  EXPECT_EQ(zone.closed, 13);
  EXPECT_EQ(zone.from, 63);
  EXPECT_EQ(zone.until, 163);
}

Amend reopening(std::int32_t zone, std::int32_t number, Tick delay = 0) {
  return {.header = {kRun, kOperator, 1, next_sequence(), 0},
          .number = number,
          .kind = AmendmentKind::kReopen,
          .delay_ticks = delay,
          .content = encode_reopening(zone),
          .by = "anna@base"};
}

TEST(Amending, CancelsAZoneOnce) {
  Coordinator coordinator = running_coordinator(wide_mission());
  give(coordinator, world_where(10, {9, 9}), at(1s));
  give(coordinator, zone_wish(300, 0), at(1s));
  let_world_stand_by(coordinator, 11);
  give(coordinator, world_where(80, {79, 79}), at(1s));
  advance(coordinator, at(1s));
  for (const Amend& refused : {reopening(1, 1), reopening(0, 1, 5)}) {
    give(coordinator, refused, at(1s));
    EXPECT_TRUE(only<MissionPart>(advance(coordinator, at(1s))).empty());
  }
  give(coordinator, reopening(0, 1), at(1s));
  let_world_stand_by(coordinator, 81);
  ASSERT_EQ(coordinator.amendments().named, 2);
  EXPECT_EQ(coordinator.amendments().recent[1],
            (Amendment{1, AmendmentKind::kReopen, 83, 0, "anna@base", 1}));
  EXPECT_EQ(coordinator.amendments().zones[0].end(), 83);
  advance(coordinator, at(1s));
  give(coordinator, reopening(0, 2), at(1s));
  EXPECT_TRUE(only<MissionPart>(advance(coordinator, at(1s))).empty()) << "it is cancelled already";
}

TEST(Amending, CancelsNoZoneThatEndsBefore) {
  Coordinator coordinator = running_coordinator(wide_mission());
  give(coordinator, world_where(10, {9, 9}), at(1s));
  give(coordinator, zone_wish(300, 0), at(1s));
  let_world_stand_by(coordinator, 11);  // until 163
  give(coordinator, world_where(161, {160, 160}), at(1s));
  advance(coordinator, at(1s));
  give(coordinator, reopening(0, 1), at(1s));
  EXPECT_TRUE(only<MissionPart>(advance(coordinator, at(1s))).empty());
}

TEST(Amending, RefusesAZoneThatIsNotPossible) {
  const Amend outside = zone_wish(5000, 0), everything = zone_wish(-100, 0, 4000);
  Amend cut = zone_wish(300, 0);
  cut.content.pop_back();
  for (const Amend& wish : {outside, everything, cut}) {
    Coordinator coordinator = running_coordinator(wide_mission());
    give(coordinator, world_where(10, {9, 9}), at(1s));
    for (int i = 0; i < 3; ++i) give(coordinator, wish, at(1s));
    let_world_stand_by(coordinator, 11);
    EXPECT_EQ(coordinator.amendments().named, 0);
  }
}

TEST(Amending, NamesNoNinthZoneUntilOneHasEnded) {
  Coordinator coordinator = running_coordinator(wide_mission());
  Tick tick = 10;
  const auto ask = [&](int number, Tick lasts) {
    give(coordinator, world_where(tick, {tick - 1, tick - 1}), at(1s));
    give(coordinator, zone_wish(100 + 10 * number, number, 50, lasts), at(1s));
    const auto parts = only<MissionPart>(advance(coordinator, at(1s)));
    if (parts.empty()) return;  // it is refused
    WorldState world = world_where(++tick, {9, 9});
    world.roster_revision = parts[0].revision;
    give(coordinator, world, at(1s));
  };
  for (int i = 0; i < 9; ++i) ask(i, 100);
  EXPECT_EQ(coordinator.amendments().named, 8);
  tick = coordinator.amendments().zones[0].until - 1;
  ask(8, 100);
  EXPECT_EQ(coordinator.amendments().named, 8) << "it ends a tick later";
  ++tick;
  ask(8, 100);
  EXPECT_EQ(coordinator.amendments().named, 9);
}

// ---- laws ----

Amend law_wish(double share, std::int32_t number, Tick delay = 0) {
  LawChange law = plans_law(wide_mission());
  law.kinds[0].u_max_mps *= share;
  return one_part(
      {.number = number, .kind = AmendmentKind::kLaw, .delay_ticks = delay, .by = "anna@base"},
      encode_law(law));
}

TEST(Amending, NamesALawAndItsOperator) {
  Coordinator coordinator = running_coordinator(wide_mission());
  give(coordinator, world_where(10, {9, 9}), at(1s));
  give(coordinator, law_wish(0.5, 0), at(1s));
  let_world_stand_by(coordinator, 11);
  ASSERT_EQ(coordinator.amendments().laws.size(), 1U);
  EXPECT_EQ(coordinator.amendments().laws[0].from, 13);
  EXPECT_EQ(coordinator.amendments().laws[0].kinds[0].u_max_mps, wide_mission().law.u_max_mps / 2);
  EXPECT_EQ(coordinator.amendments().recent[0].by, "anna@base");
}

TEST(Amending, NamesNoLawBeyondThePlan) {
  Amend cut = law_wish(0.5, 0);
  cut.content.pop_back();
  for (const Amend& wish : {law_wish(1.5, 0), law_wish(0, 0), law_wish(-1, 0), cut}) {
    Coordinator coordinator = running_coordinator(wide_mission());
    give(coordinator, world_where(10, {9, 9}), at(1s));
    give(coordinator, wish, at(1s));
    let_world_stand_by(coordinator, 11);
    EXPECT_EQ(coordinator.amendments().named, 0);
  }
}

TEST(Amending, ALawThatWaitsIsReplacedByTheOneThatHoldsAlone) {
  Coordinator coordinator = running_coordinator(wide_mission());
  give(coordinator, world_where(10, {9, 9}), at(1s));
  give(coordinator, law_wish(0.5, 0, 100), at(1s));
  let_world_stand_by(coordinator, 11);
  give(coordinator, law_wish(0.75, 1), at(1s));
  let_world_stand_by(coordinator, 12);
  EXPECT_EQ(coordinator.amendments().named, 1) << "another one waits";
  give(coordinator, law_wish(1, 1), at(1s));
  let_world_stand_by(coordinator, 13);
  ASSERT_EQ(coordinator.amendments().laws.size(), 1U);
  EXPECT_EQ(coordinator.amendments().laws[0].from, 113);
  EXPECT_EQ(coordinator.amendments().laws[0].kinds, plans_law(wide_mission()).kinds);
}

}  // namespace
}  // namespace ergocast
