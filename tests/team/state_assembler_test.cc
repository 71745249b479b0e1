// SPDX-License-Identifier: BSD-3-Clause
// Parts of a state in any order, repeated, of another world, and of several drivers.
#include "team/state_assembler.h"

#include <gtest/gtest.h>

#include "tests/support/team.h"

namespace ergocast::test {
namespace {

/// Part `part` of `parts`, with one vehicle of this number.
WorldState part_of(Tick tick, int part, int parts, AgentId id, double x_m = 0,
                   Incarnation world = kWorldLife) {
  WorldState state;
  state.header = {kRun, kWorld, world, next_sequence(), tick};
  state.part = part;
  state.parts = parts;
  Vehicle& vehicle = state.add_vehicle();
  vehicle.id = id;
  vehicle.position_m.x() = x_m;
  return state;
}

const Vehicle& vehicle(const StateAssembler& assembler, std::size_t part) {
  return assembler.states().at(part).vehicles_in_part().front();
}

TEST(StateAssembler, IsCompleteOnceAllPartsHaveArrivedInAnyOrder) {
  StateAssembler assembler;
  EXPECT_EQ(assembler.newest(), -1);
  assembler.take(part_of(3, 1, 2, 7));
  assembler.take(part_of(3, 1, 2, 7));
  EXPECT_FALSE(assembler.complete(3));
  assembler.take(part_of(3, 0, 2, 2));
  EXPECT_TRUE(assembler.complete(3));
  EXPECT_FALSE(assembler.complete(2));
  ASSERT_EQ(assembler.states().size(), 2u);
  EXPECT_EQ(vehicle(assembler, 0).id, 2);
  EXPECT_EQ(vehicle(assembler, 1).id, 7);
}

TEST(StateAssembler, KeepsTheLastCompleteTickUntilTheNextOneIsComplete) {
  StateAssembler assembler;
  for (int part = 0; part < 2; ++part) assembler.take(part_of(3, part, 2, part, 10));
  assembler.take(part_of(4, 0, 2, 0, 20));
  EXPECT_EQ(assembler.newest(), 3);
  EXPECT_FALSE(assembler.complete(3)) << "a newer tick has come";
  EXPECT_EQ(vehicle(assembler, 0).position_m.x(), 10);
  assembler.take(part_of(3, 0, 2, 0, 99));
  EXPECT_EQ(vehicle(assembler, 0).position_m.x(), 10) << "an older tick has no effect";
  assembler.take(part_of(4, 1, 2, 1, 20));
  EXPECT_EQ(assembler.newest(), 4);
  EXPECT_EQ(vehicle(assembler, 1).position_m.x(), 20);
}

TEST(StateAssembler, ARepeatReplacesThePart) {
  StateAssembler assembler;
  assembler.take(part_of(3, 0, 1, 0, 10));
  WorldState repeat = part_of(3, 0, 1, 0, 10);
  repeat.vehicles[0].answered_tick = 3;
  repeat.add_vehicle().id = 5;
  assembler.take(repeat);
  EXPECT_EQ(assembler.states().front().vehicle_count, 2);
  EXPECT_EQ(vehicle(assembler, 0).answered_tick, 3);
}

TEST(StateAssembler, DoesNotMixTwoWorlds) {
  StateAssembler assembler;
  assembler.take(part_of(3, 0, 2, 0));
  assembler.take(part_of(3, 1, 2, 1, 0, kWorldLife + 1));
  EXPECT_FALSE(assembler.complete(3));
  assembler.take(part_of(3, 0, 2, 0, 0, kWorldLife + 1));
  EXPECT_TRUE(assembler.complete(3));
  // The state stays known while yet another world repeats it.
  assembler.take(part_of(3, 0, 3, 0, 0, kWorldLife + 2));
  EXPECT_TRUE(assembler.complete(3));
  EXPECT_EQ(assembler.states().size(), 2u);
}

TEST(StateAssembler, GivesNeighboursInOrderWithTheirSpeedLimits) {
  const Mission mission = small_mission(2);
  StateAssembler assembler;
  assembler.take(part_of(3, 0, 2, 1, 10));
  assembler.take(part_of(3, 1, 2, 0, 20));
  const auto neighbours = assembler.neighbours(mission);
  ASSERT_EQ(neighbours.size(), 2u);
  EXPECT_EQ(neighbours[0].id, 0);
  EXPECT_EQ(neighbours[0].position_m.x(), 20);
  EXPECT_EQ(neighbours[1].max_speed_mps, motion_of(mission, 1).speed_limit_mps);
}

TEST(ArrivedParts, OfSeveralDriversMayCountDifferently) {
  ArrivedParts parts;
  EXPECT_FALSE(parts.complete());
  parts.begin(part_of(3, 0, 1, 0));
  EXPECT_TRUE(parts.complete());
  const WorldState other = part_of(3, 2, 3, 2, 0, kWorldLife + 1);
  EXPECT_FALSE(parts.same(other));
  parts.add(other);
  EXPECT_FALSE(parts.complete());
  parts.add(part_of(3, 1, 2, 1, 0, kWorldLife + 2));
  EXPECT_TRUE(parts.complete());
}

}  // namespace
}  // namespace ergocast::test
