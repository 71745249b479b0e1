// SPDX-License-Identifier: BSD-3-Clause
// The charge of a vehicle's battery, and when it sends the agent home to its station.
//
// A charge is a share of the capacity in millionths. In a tick that counts, a simulated vehicle
// uses power_w · dt away from its station and gets charge_w · dt there (core/motion/home.h has how
// near that is). A pause takes nothing. An empty vehicle stands.
//
// An agent with the charge c, from a place from which the way home needs the time t, goes home if
//
//   c ≤ reserve + use · t.
//
// Then it stays at its station until c is at least kFull. `use` is what it has measured since the
// charge rose last, over all of that time. Until a twentieth of the capacity has been used, it is
// power_w by the scenario.
#pragma once

#include <cstdint>

#include "core/base/ids.h"
#include "core/mission/mission.h"

namespace ergocast {

/// A charge that is not known, or of a vehicle without a battery.
inline constexpr std::int32_t kNoCharge = -1;
/// A full battery [millionths].
inline constexpr std::int32_t kWhole_ppm = 1'000'000;
/// The charge with which an agent goes back into the mission. Real batteries hardly report more.
inline constexpr std::int32_t kFull_ppm = 950'000;

/// The share of the capacity of a known charge.
constexpr double share_of(std::int32_t charge_ppm) {
  return static_cast<double>(charge_ppm) / kWhole_ppm;
}
/// A share of the capacity as a charge, rounded down. @pre 0 ≤ share ≤ 1
std::int32_t charge_ppm_of(double share);

/// The share after a tick of `dt_s` that counts.
double share_after(const Battery& battery, double share, bool at_station, double dt_s);

/// For how long a full battery lasts without its reserve [s]. @pre battery.any()
double endurance_s(const Battery& battery);

class ChargeWatch {
 public:
  /// @pre battery.any()
  ChargeWatch(const Battery& battery, double dt_s);

  /// Takes in the charge at a tick. kNoCharge changes nothing.
  void note(Tick tick, std::int32_t charge_ppm);
  /// Whether the agent has to be at its station, or on the way there. Once that is so, it lasts
  /// until the battery is full.
  /// @param way_s  what the way home needs
  bool must_go(double way_s);
  bool must_go() const { return must_go_; }

  /// What it uses of its charge [1/s].
  double use_per_s() const;

 private:
  double reserve_, planned_use_per_s_, dt_s_;
  std::int32_t now_ppm_ = kNoCharge, least_ppm_ = kNoCharge;  // the least since it rose last
  std::int32_t from_ppm_ = kNoCharge;                         // where the measurement begins
  Tick now_ = 0, from_ = 0;
  bool must_go_ = false;
};

}  // namespace ergocast
