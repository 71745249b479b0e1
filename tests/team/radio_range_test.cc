// SPDX-License-Identifier: BSD-3-Clause
// Radio range: which agents with known places receive each other, by distance.
#include "team/radio_range.h"

#include <gtest/gtest.h>

#include "tests/support/team.h"

namespace ergocast {
namespace {

using namespace test;

const std::vector<Eigen::Vector3d> kPlaces{{0, 0, 0}, {300, 400, 0}, {300, 401, 0}};

RadioRange radio_of(double range_m) {
  RadioRange radio(range_m);
  radio.on(world_state(5, kPlaces));
  return radio;
}

TEST(RadioRange, ReachesAsFarAsItsValueAndNoFarther) {
  const RadioRange radio = radio_of(500);
  EXPECT_TRUE(radio.receives(0, 1)) << "500 m exactly";
  EXPECT_FALSE(radio.receives(0, 2));
  EXPECT_TRUE(radio.receives(1, 2));
}

TEST(RadioRange, IsTheSameBothWays) {
  const RadioRange radio = radio_of(500);
  for (AgentId a = 0; a < 3; ++a) {
    EXPECT_TRUE(radio.receives(a, a));
    for (AgentId b = 0; b < 3; ++b) EXPECT_EQ(radio.receives(a, b), radio.receives(b, a));
  }
}

TEST(RadioRange, OfZeroIsNoLimit) {
  const RadioRange radio = radio_of(0);
  EXPECT_FALSE(radio.limited());
  EXPECT_TRUE(radio.receives(0, 2));
}

TEST(RadioRange, HidesNoProcessWhosePlaceIsNotKnown) {
  const RadioRange radio = radio_of(1);
  for (const AgentId process : {kCoordinator, kWorld, kLogger, kOperator, kUnassigned, 3}) {
    EXPECT_TRUE(radio.receives(0, process)) << process;
    EXPECT_TRUE(radio.receives(process, 0)) << process;
  }
  EXPECT_TRUE(RadioRange(1).receives(0, 1)) << "before the first world state";
}

TEST(RadioRange, GoesByTheNewestPlaces) {
  RadioRange radio = radio_of(500);
  radio.on(world_state(6, {{0, 0, 0}, {0, 900, 0}, {0, 10, 0}}));
  EXPECT_FALSE(radio.receives(0, 1));
  EXPECT_TRUE(radio.receives(0, 2));
  radio.on(world_state(5, kPlaces));
  EXPECT_FALSE(radio.receives(0, 1)) << "an old state that comes late";
}

TEST(RadioRange, TakesAWorldInParts) {
  RadioRange radio(500);
  WorldState first = world_state(7, {{0, 0, 0}}), second = world_state(7, {{0, 600, 0}});
  second.vehicles[0].id = 16;
  radio.on(second);
  radio.on(first);
  EXPECT_FALSE(radio.receives(0, 16));
}

}  // namespace
}  // namespace ergocast
