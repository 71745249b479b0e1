// SPDX-License-Identifier: BSD-3-Clause
// All conversions between frames of reference: places and velocities of a scenario (x east, y
// north, z up, in metres) and those of autopilots (north, east, down; 1e-7 degrees; millimetres;
// centimetres a second).
//
// The plane of a scenario is the azimuthal equidistant projection of WGS 84 around its origin, as
// target/geo/local_plane.h has it: (s sin α, s cos α) is the place that the geodesic from the
// origin with the azimuth α reaches after the distance s.
#pragma once

#include <ergocast/core/base/result.h>

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "bridges/mavlink/messages.h"

namespace ergocast::mavlink {

/// A place on the earth. The altitude [m] is above mean sea level.
struct EarthPlace {
  double latitude_deg = 0, longitude_deg = 0, altitude_m = 0;
  bool has_altitude = true;
};

/// Farther from the origin than this [m], the vehicle counts as lost, or the origin as wrong.
/// Limit (MAVLink): distance of a vehicle from the origin of its scenario [m]. Beyond it: its
/// positions are not used.
inline constexpr double kFarthestVehicle_m = 100e3;

/// x and y of a place in the plane around `origin`, and its height above the origin. Returns
/// nothing if the place is farther away than kFarthestVehicle_m. The error is less than 1 mm.
std::optional<Eigen::Vector3d> local_m(const EarthPlace& origin, const EarthPlace& place);

/// The place at a point of the plane around `origin`: the inverse of local_m(). The error is less
/// than 1 mm.
/// @pre |x_m| ≤ kFarthestVehicle_m
EarthPlace place_at(const EarthPlace& origin, const Eigen::Vector2d& x_m);

/// "47.6535,9.175" or "47.6535,9.175,402.5".
Result<EarthPlace> read_place(std::string_view text);
/// "1.5,-2" or "1.5,-2,0".
Result<Eigen::Vector3d> read_point(std::string_view text);

/// Converts a vector from the scenario's axes to those of autopilots, and back.
inline Eigen::Vector3d ned_of(const Eigen::Vector3d& enu) { return {enu.y(), enu.x(), -enu.z()}; }
inline Eigen::Vector3d enu_of(const Eigen::Vector3d& ned) { return {ned.y(), ned.x(), -ned.z()}; }

EarthPlace place_of(const GlobalPositionInt& at);
EarthPlace place_of(const GpsGlobalOrigin& at);
Eigen::Vector3d velocity_mps_of(const GlobalPositionInt& at);  ///< east, north, up

/// A place and a velocity relative to the start of the local frame: east, north, up.
Eigen::Vector3d offset_m_of(const LocalPositionNed& at);
Eigen::Vector3d velocity_mps_of(const LocalPositionNed& at);

/// Asks for this velocity (east, north, up) and nothing else: place, acceleration, heading and its
/// rate are ignored.
SetPositionTargetLocalNed setpoint_of(const Eigen::Vector3d& velocity_mps);

}  // namespace ergocast::mavlink
