// SPDX-License-Identifier: BSD-3-Clause
// The makes of autopilots and bodies of vehicles that can be driven, and the names of their modes.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace ergocast::mavlink {

enum class Make { kPx4, kArduPilot };
enum class Body { kCopter, kRover };

/// By MAV_TYPE; nothing for a vehicle that is refused.
std::optional<Body> body_of(std::uint8_t type);
/// "is a fixed wing, …"
std::string why_refused(std::uint8_t type);

/// The mode in which the autopilot obeys setpoints.
std::uint32_t external_mode_of(Make make, Body body);
inline std::string external_mode_name(Make make) {
  return make == Make::kPx4 ? "OFFBOARD" : "GUIDED";
}
std::string mode_name(Make make, Body body, std::uint32_t mode);

}  // namespace ergocast::mavlink
