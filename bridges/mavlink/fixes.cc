// SPDX-License-Identifier: BSD-3-Clause
// Every position is compared with the one before it.
#include "bridges/mavlink/fixes.h"

#include <cstdio>
#include <utility>

namespace ergocast::mavlink {
namespace {

/// A clock that is behind by more has begun anew; less is a message that was overtaken [ms].
constexpr std::uint32_t kOvertaken_ms = 5000;
/// The bound of clock_bond.h may be ahead of the clock by so much, because clocks drift.
constexpr auto kFuture = std::chrono::milliseconds(10);

std::string metres(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.0f m", value);
  return text;
}

std::string short_seconds(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2g s", value);
  return text;
}

}  // namespace

void Fixes::take(const GlobalPositionInt& at) {
  if (!origin_) return;  // the stated local origin counts
  sends_global_ = true;
  if (at.lat == 0 && at.lon == 0) {
    if (!has_global_ && local_origin_m_) return;  // LOCAL_POSITION_NED counts
    newest_.reset();
    problem_ = "the autopilot has no position on the earth yet (latitude and longitude are 0)";
    return;
  }
  Fix fix;
  fix.velocity_mps = velocity_mps_of(at);
  fix.height_m = at.relative_alt * 1e-3;
  take(at.time_boot_ms, local_m(*origin_, place_of(at)), fix);
  has_global_ = true;
}

void Fixes::take(const LocalPositionNed& at) {
  if (has_global_ || !note_time(at.time_boot_ms)) return;
  if (!local_origin_m_) {
    if (sends_global_) return;
    problem_ =
        "LOCAL_POSITION_NED counts from the vehicle's own start, which is not known: a vehicle "
        "with "
        "GPS must send GLOBAL_POSITION_INT or GPS_GLOBAL_ORIGIN, for another one give "
        "--local-origin";
    return;
  }
  Fix fix;
  fix.velocity_mps = velocity_mps_of(at);
  fix.height_m = -static_cast<double>(at.z);
  take(at.time_boot_ms, *local_origin_m_ + offset_m_of(at), fix);
}

void Fixes::take(const GpsGlobalOrigin& at) {
  if (!origin_) return;
  local_origin_m_ = local_m(*origin_, place_of(at));
}

/// False for a message that was overtaken.
bool Fixes::note_time(std::uint32_t boot_ms) {
  if (boot_ms < newest_ms_) {
    if (newest_ms_ - boot_ms < kOvertaken_ms) return false;
    restarted_ = true;
    clock_.forget();
    newest_.reset();
    last_m_.reset();
    has_global_ = sends_global_ = false;
    if (origin_) local_origin_m_.reset();  // not a stated one
    unsteady_ = "the autopilot has started anew: waits until its positions are steady";
    steady_since_ms_ = boot_ms;
  }
  newest_ms_ = boot_ms;
  return true;
}

void Fixes::note_way(std::uint32_t boot_ms, const Eigen::Vector3d& position_m) {
  const double way_m = last_m_ ? (position_m - *last_m_).norm() : 0;
  const double passed_s = (boot_ms - last_ms_) * 1e-3;
  if (way_m > kGreatestJump_m + 2 * speed_limit_mps_ * passed_s) {
    if (unsteady_.empty()) unsteady_ = "the position jumped by " + metres(way_m);
    steady_since_ms_ = boot_ms;
  }
  if (boot_ms - steady_since_ms_ >= kSteady_ms) unsteady_.clear();
  last_m_ = position_m;
  last_ms_ = boot_ms;
}

void Fixes::take(std::uint32_t boot_ms, const std::optional<Eigen::Vector3d>& position_m, Fix fix) {
  if (!note_time(boot_ms)) return;
  newest_.reset();
  if (!position_m || !position_m->allFinite() || !fix.velocity_mps.allFinite()) {
    problem_ = position_m ? "the autopilot's position is no number"
                          : "the vehicle is more than " + metres(kFarthestVehicle_m) +
                                " from --origin: give the scenario's origin";
    return;
  }
  note_way(boot_ms, *position_m);
  const auto not_before = clock_.not_before(boot_ms);
  if (!not_before) {
    problem_ = "the autopilot has not answered TIMESYNC, so the age of its positions is not known";
    return;
  }
  fix.position_m = *position_m;
  fix.not_before = *not_before;
  newest_ = fix;
}

bool Fixes::is_of_the_future(Instant now) const {
  return newest_ && newest_->not_before > now + kFuture;
}

std::optional<Fix> Fixes::at(Instant now) const {
  if (!newest_ || !unsteady_.empty()) return std::nullopt;
  const bool young = now - newest_->not_before <= seconds(oldest_s_);
  return young && !is_of_the_future(now) ? newest_ : std::nullopt;
}

std::string Fixes::problem(Instant now) const {
  if (at(now)) return "";
  if (!unsteady_.empty()) return unsteady_;
  if (is_of_the_future(now)) return "the time of the newest position is in the future";
  return newest_ ? "the newest position is older than " + short_seconds(oldest_s_) : problem_;
}

}  // namespace ergocast::mavlink
