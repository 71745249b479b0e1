// SPDX-License-Identifier: BSD-3-Clause
// The numbers of types and modes are those of mavlink.io, PX4 and ArduPilot.
#include "bridges/mavlink/autopilots.h"

#include <algorithm>
#include <iterator>

namespace ergocast::mavlink {
namespace {

struct ModeName {
  std::uint32_t mode;
  const char* name;
};
constexpr ModeName kPx4Modes[] = {{1, "MANUAL"}, {2, "ALTCTL"},   {3, "POSCTL"},    {4, "AUTO"},
                                  {5, "ACRO"},   {6, "OFFBOARD"}, {7, "STABILIZED"}};
constexpr ModeName kCopterModes[] = {{0, "STABILIZE"}, {2, "ALT_HOLD"}, {3, "AUTO"},
                                     {4, "GUIDED"},    {5, "LOITER"},   {6, "RTL"},
                                     {9, "LAND"},      {16, "POSHOLD"}, {17, "BRAKE"}};
constexpr ModeName kRoverModes[] = {{0, "MANUAL"}, {3, "STEERING"}, {4, "HOLD"},   {5, "LOITER"},
                                    {10, "AUTO"},  {11, "RTL"},     {15, "GUIDED"}};
constexpr std::uint32_t kPx4Offboard = 6, kCopterGuided = 4, kRoverGuided = 15;

}  // namespace

std::optional<Body> body_of(std::uint8_t type) {
  constexpr std::uint8_t kCopters[] = {2, 3, 4, 13, 14, 15, 29, 35}, kRovers[] = {10, 11};
  if (std::ranges::find(kCopters, type) != std::end(kCopters)) return Body::kCopter;
  if (std::ranges::find(kRovers, type) != std::end(kRovers)) return Body::kRover;
  return std::nullopt;
}

std::string why_refused(std::uint8_t type) {
  if (type == 1) return "is a fixed wing, which cannot be stopped in the air";
  if (type >= 19 && type <= 25)
    return "is a VTOL, which cannot be stopped while its wing carries it";
  return "is of type " + std::to_string(type) + " (MAV_TYPE), and no multicopter or rover";
}

std::uint32_t external_mode_of(Make make, Body body) {
  if (make == Make::kPx4) return kPx4Offboard;
  return body == Body::kCopter ? kCopterGuided : kRoverGuided;
}

std::string mode_name(Make make, Body body, std::uint32_t mode) {
  const auto named = [&](const auto& modes) {
    const auto found = std::ranges::find(modes, mode, &ModeName::mode);
    return found == std::end(modes) ? "mode " + std::to_string(mode) : std::string(found->name);
  };
  if (make == Make::kPx4) return named(kPx4Modes);
  return body == Body::kCopter ? named(kCopterModes) : named(kRoverModes);
}

}  // namespace ergocast::mavlink
