// SPDX-License-Identifier: BSD-3-Clause
// Converts between places on the earth (WGS 84) and a scenario's plane around such a place.
#pragma once

#include <Eigen/Core>
#include <memory>

namespace ergocast {

/// Latitudes north of the equator and longitudes east of Greenwich are positive.
struct GeoPlace {
  double latitude_deg = 0;   ///< −90 to 90
  double longitude_deg = 0;  ///< −180 to 180
};

/// The greatest distance from its origin at which a plane is used [m]. The error of an area there
/// is 0.4 %.
/// Limit (Files of a scenario): distance of a place in a file of polygons from the origin [m].
/// Beyond it: the scenario is refused.
inline constexpr double kFarthest_m = 1e6;

/// The azimuthal equidistant projection on the ellipsoid: x is east, y is north. Distances and
/// directions from the origin are true, and every place of the earth has coordinates. At a distance
/// d from the origin, lengths at right angles to the direction of the origin are too great by the
/// share d²/(6 R²): 4e-7 at 10 km, 4e-5 at 100 km.
class LocalPlane {
 public:
  /// @pre within the limits of GeoPlace
  explicit LocalPlane(const GeoPlace& origin);
  ~LocalPlane();
  LocalPlane(LocalPlane&&) noexcept;
  LocalPlane& operator=(LocalPlane&&) noexcept;

  Eigen::Vector2d to_local_m(const GeoPlace& place) const;
  GeoPlace to_place(const Eigen::Vector2d& x_m) const;

 private:
  struct Projection;
  std::unique_ptr<Projection> projection_;
};

}  // namespace ergocast
