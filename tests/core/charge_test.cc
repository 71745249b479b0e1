// SPDX-License-Identifier: BSD-3-Clause
#include "core/motion/charge.h"

#include <gtest/gtest.h>

namespace ergocast {
namespace {

/// It is empty after 1000 s of use, and full again after 500 s at the station.
constexpr Battery kBattery{.capacity_wh = 10, .power_w = 36, .charge_w = 72, .reserve = 0.2};
constexpr double kDt_s = 0.5;

TEST(Charge, IsUsedAwayFromTheStationAndComesBackThere) {
  EXPECT_NEAR(share_after(kBattery, 0.5, false, 10), 0.49, 1e-12);
  EXPECT_NEAR(share_after(kBattery, 0.5, true, 10), 0.52, 1e-12);
  EXPECT_EQ(share_after(kBattery, 0.001, false, 10), 0);
  EXPECT_EQ(share_after(kBattery, 0.999, true, 10), 1);
  EXPECT_NEAR(endurance_s(kBattery), 800, 1e-9);
  EXPECT_EQ(charge_ppm_of(1), kWhole_ppm);
  EXPECT_EQ(charge_ppm_of(0.1234567), 123456);
}

/// Uses the share `per_s` of the capacity in each second of `ticks` ticks.
std::int32_t use(ChargeWatch& watch, std::int32_t charge_ppm, double per_s, Tick from, Tick ticks) {
  for (Tick tick = from; tick < from + ticks; ++tick) {
    watch.note(tick, charge_ppm);
    charge_ppm -= static_cast<std::int32_t>(per_s * kDt_s * kWhole_ppm);
  }
  return charge_ppm;
}

TEST(Charge, SendsTheAgentHomeWhenTheWayNeedsWhatIsAboveTheReserve) {
  ChargeWatch watch(kBattery, kDt_s);
  watch.note(0, 300'001);
  EXPECT_FALSE(watch.must_go(100)) << "the way needs 0.1 of the capacity, and the reserve is 0.2";
  watch.note(1, 300'000);
  EXPECT_TRUE(watch.must_go(100));
  watch.note(2, 900'000);
  EXPECT_TRUE(watch.must_go(0)) << "it stays until the battery is full";
  watch.note(3, kFull_ppm);
  EXPECT_FALSE(watch.must_go(0));
}

TEST(Charge, CountsTheUseThatWasMeasured) {
  ChargeWatch watch(kBattery, kDt_s);
  EXPECT_DOUBLE_EQ(watch.use_per_s(), 0.001);
  const std::int32_t left_ppm = use(watch, kWhole_ppm, 0.002, 0, 40);
  EXPECT_DOUBLE_EQ(watch.use_per_s(), 0.001) << "a use of 4 % is too little to measure by";
  use(watch, left_ppm, 0.002, 40, 200);
  EXPECT_NEAR(watch.use_per_s(), 0.002, 1e-6);
  watch.note(240, 760'000);
  EXPECT_TRUE(watch.must_go(290));
}

TEST(Charge, BeginsToMeasureAnewFromTheHighestChargeOn) {
  ChargeWatch watch(kBattery, kDt_s);
  use(watch, kWhole_ppm, 0.004, 0, 300);
  EXPECT_NEAR(watch.use_per_s(), 0.004, 1e-6);
  std::int32_t charge_ppm = 400'000;
  for (Tick tick = 300; tick < 400; ++tick) watch.note(tick, charge_ppm += 4'000);
  EXPECT_DOUBLE_EQ(watch.use_per_s(), 0.001) << "nothing was used since";
  use(watch, charge_ppm, 0.003, 400, 200);
  EXPECT_NEAR(watch.use_per_s(), 0.003, 5e-5);
}

/// The charge of a battery rises by a percent or two when the vehicle brakes.
TEST(Charge, IsNotMeasuredAnewForALittleRise) {
  ChargeWatch watch(kBattery, kDt_s);
  use(watch, kWhole_ppm, 0.004, 0, 300);
  watch.note(300, 415'000);
  EXPECT_NEAR(watch.use_per_s(), 0.0039, 1e-5);
}

TEST(Charge, ThatIsNotKnownChangesNothing) {
  ChargeWatch watch(kBattery, kDt_s);
  watch.note(0, kNoCharge);
  EXPECT_FALSE(watch.must_go(1e9)) << "a robot that reports no charge goes home by its reserve_s";
  watch.note(1, 100'000);
  watch.note(2, kNoCharge);
  EXPECT_TRUE(watch.must_go(0));
}

}  // namespace
}  // namespace ergocast
