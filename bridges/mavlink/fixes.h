// SPDX-License-Identifier: BSD-3-Clause
// The positions that an autopilot reports, as far as they can be trusted.
//
// GLOBAL_POSITION_INT is taken with the scenario's origin. LOCAL_POSITION_NED counts from a place
// that each vehicle has chosen for itself. So it is taken only if that place is known: a stated
// one, or GPS_GLOBAL_ORIGIN with the scenario's origin.
#pragma once

#include <ergocast/core/base/ids.h>

#include <Eigen/Core>
#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "bridges/mavlink/clock_bond.h"
#include "bridges/mavlink/messages.h"
#include "bridges/mavlink/places.h"

namespace ergocast::mavlink {

/// A position in the scenario's frame.
struct Fix {
  Eigen::Vector3d position_m{0, 0, 0}, velocity_mps{0, 0, 0};
  double height_m = 0;   ///< above home, or above the local start
  Instant not_before{};  ///< it was measured then or later
};

/// Limit (MAVLink): age of a position [s]. Beyond it: the vehicle stands, and its position is not
/// sent.
inline constexpr double kOldestFix_s = 0.5;
/// Limit (MAVLink): distance between two positions that follow each other, beyond twice the way at
/// the vehicle's greatest speed [m]. Beyond it: the vehicle stands until positions are steady
/// again.
inline constexpr double kGreatestJump_m = 5;
/// For so long positions must be steady after a jump, by the autopilot's clock [ms].
inline constexpr std::uint32_t kSteady_ms = 3000;

class Fixes {
 public:
  Fixes(const std::optional<EarthPlace>& origin,
        const std::optional<Eigen::Vector3d>& local_origin_m)
      : origin_(origin), local_origin_m_(local_origin_m) {}

  /// The greatest speed of the vehicle by the mission, because a much longer way is a jump. And the
  /// age from which positions are too old for it; kOldestFix_s counts, too.
  void set_limits(double speed_limit_mps, double oldest_s) {
    speed_limit_mps_ = speed_limit_mps;
    oldest_s_ = std::min(oldest_s, kOldestFix_s);
  }

  void take(const GlobalPositionInt& at);
  void take(const LocalPositionNed& at);
  void take(const GpsGlobalOrigin& at);
  ClockBond& clock() { return clock_; }
  /// Whether the autopilot has started anew since the last call.
  bool take_restart() { return std::exchange(restarted_, false); }

  /// The newest trusted position; nothing if there is none that is young enough.
  std::optional<Fix> at(Instant now) const;
  /// Why there is none, as a sentence.
  std::string problem(Instant now) const;

 private:
  void take(std::uint32_t boot_ms, const std::optional<Eigen::Vector3d>& position_m, Fix fix);
  bool is_of_the_future(Instant now) const;
  bool note_time(std::uint32_t boot_ms);
  void note_way(std::uint32_t boot_ms, const Eigen::Vector3d& position_m);

  std::optional<EarthPlace> origin_;
  std::optional<Eigen::Vector3d> local_origin_m_;   // stated, or from GPS_GLOBAL_ORIGIN
  bool sends_global_ = false, has_global_ = false;  // has: a place, not 0
  bool restarted_ = false;
  double speed_limit_mps_ = 100, oldest_s_ = kOldestFix_s;
  ClockBond clock_;
  std::optional<Fix> newest_;
  std::optional<Eigen::Vector3d> last_m_;  // the last position that was a number
  std::uint32_t last_ms_ = 0, newest_ms_ = 0, steady_since_ms_ = 0;
  std::string unsteady_;  // why positions are not trusted at present
  std::string problem_ = "the autopilot sends no position";
};

}  // namespace ergocast::mavlink
