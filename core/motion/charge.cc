// SPDX-License-Identifier: BSD-3-Clause
// Measures the use of a battery from its highest charge on.
#include "core/motion/charge.h"

#include <algorithm>
#include <cmath>

namespace ergocast {
namespace {

constexpr double kSecondsPerHour = 3600;
/// What has to be used before the measured use counts.
constexpr std::int32_t kMeasurable_ppm = 50'000;
/// A charge that rises by less is a battery that recovers, or noise of its meter.
constexpr std::int32_t kCharged_ppm = 20'000;

double share_per_s(const Battery& battery, double power_w) {
  return power_w / (battery.capacity_wh * kSecondsPerHour);
}

}  // namespace

std::int32_t charge_ppm_of(double share) {
  return static_cast<std::int32_t>(std::floor(share * kWhole_ppm));
}

double share_after(const Battery& battery, double share, bool at_station, double dt_s) {
  const double power_w = at_station ? battery.charge_w : -battery.power_w;
  return std::clamp(share + share_per_s(battery, power_w) * dt_s, 0.0, 1.0);
}

double endurance_s(const Battery& battery) {
  return (1 - battery.reserve) / share_per_s(battery, battery.power_w);
}

ChargeWatch::ChargeWatch(const Battery& battery, double dt_s)
    : reserve_(battery.reserve),
      planned_use_per_s_(share_per_s(battery, battery.power_w)),
      dt_s_(dt_s) {}

void ChargeWatch::note(Tick tick, std::int32_t charge_ppm) {
  if (charge_ppm == kNoCharge) return;
  now_ = tick;
  now_ppm_ = charge_ppm;
  if (least_ppm_ == kNoCharge || charge_ppm >= from_ppm_ ||
      charge_ppm >= least_ppm_ + kCharged_ppm) {
    from_ = tick;
    from_ppm_ = least_ppm_ = charge_ppm;
  }
  least_ppm_ = std::min(least_ppm_, charge_ppm);
}

double ChargeWatch::use_per_s() const {
  if (now_ppm_ == kNoCharge || from_ppm_ - now_ppm_ < kMeasurable_ppm) return planned_use_per_s_;
  const double used = share_of(from_ppm_ - now_ppm_ + 1);
  return used / (static_cast<double>(std::max<Tick>(now_ - from_, 1)) * dt_s_);
}

bool ChargeWatch::must_go(double way_s) {
  if (now_ppm_ == kNoCharge) return must_go_;
  if (now_ppm_ >= kFull_ppm) must_go_ = false;
  must_go_ = must_go_ || share_of(now_ppm_) <= reserve_ + use_per_s() * way_s;
  return must_go_;
}

}  // namespace ergocast
