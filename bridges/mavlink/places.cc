// SPDX-License-Identifier: BSD-3-Clause
// The geodesic is found by the iteration of T. Vincenty, "Direct and inverse solutions of geodesics
// on the ellipsoid", Survey Review 23 (1975), which converges for near places.
#include "bridges/mavlink/places.h"

#include <array>
#include <charconv>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace ergocast::mavlink {
namespace {

// WGS 84
constexpr double kMajor_m = 6378137, kFlattening = 1 / 298.257223563;
constexpr double kMinor_m = kMajor_m * (1 - kFlattening);

constexpr double radians(double degrees) { return degrees * std::numbers::pi / 180; }

constexpr double degrees(double radians) { return radians * 180 / std::numbers::pi; }

/// Vincenty's A and B for the length of the geodesic.
struct Series {
  explicit Series(double u2)
      : a(1 + u2 / 16384 * (4096 + u2 * (-768 + u2 * (320 - 175 * u2)))),
        b(u2 / 1024 * (256 + u2 * (-128 + u2 * (74 - 47 * u2)))) {}
  double a, b;
};

/// u², of a geodesic with that cos² of the azimuth at the equator.
double u2_of(double cos2_a) { return cos2_a * (kMajor_m * kMajor_m / (kMinor_m * kMinor_m) - 1); }

std::optional<Eigen::Vector2d> in_plane_m(const EarthPlace& from, const EarthPlace& to) {
  constexpr double f = kFlattening;
  const double u1 = std::atan((1 - f) * std::tan(radians(from.latitude_deg)));
  const double u2 = std::atan((1 - f) * std::tan(radians(to.latitude_deg)));
  const double sin1 = std::sin(u1), cos1 = std::cos(u1), sin2 = std::sin(u2), cos2 = std::cos(u2);
  const double apart =
      std::remainder(radians(to.longitude_deg - from.longitude_deg), 2 * std::numbers::pi);
  double lambda = apart;
  for (int round = 0; round < 50; ++round) {
    const double east = cos2 * std::sin(lambda);
    const double north = cos1 * sin2 - sin1 * cos2 * std::cos(lambda);
    const double sin_s = std::hypot(east, north);
    if (sin_s == 0) return Eigen::Vector2d(0, 0);
    const double cos_s = sin1 * sin2 + cos1 * cos2 * std::cos(lambda);
    const double s = std::atan2(sin_s, cos_s);
    const double sin_a = cos1 * east / sin_s, cos2_a = 1 - sin_a * sin_a;
    const double cos_2m = cos2_a == 0 ? 0 : cos_s - 2 * sin1 * sin2 / cos2_a;
    const double c = f / 16 * cos2_a * (4 + f * (4 - 3 * cos2_a));
    const double square = 2 * cos_2m * cos_2m - 1;
    const double next =
        apart + (1 - c) * f * sin_a * (s + c * sin_s * (cos_2m + c * cos_s * square));
    if (!(std::abs(next - lambda) < 1e-13)) {
      lambda = next;
      continue;
    }
    const Series series(u2_of(cos2_a));
    const double b = series.b;
    const double bent = b * sin_s *
                        (cos_2m + b / 4 *
                                      (cos_s * square - b / 6 * cos_2m * (4 * sin_s * sin_s - 3) *
                                                            (4 * cos_2m * cos_2m - 3)));
    const double length_m = kMinor_m * series.a * (s - bent);
    return length_m * Eigen::Vector2d(east, north) / sin_s;
  }
  return std::nullopt;  // nearly opposite places
}

/// Two or three finite numbers with commas between them, as they are.
std::optional<std::vector<double>> numbers_in(std::string_view text) {
  std::vector<double> all;
  for (;;) {
    const std::string_view word = text.substr(0, text.find(','));
    double value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(value))
      return std::nullopt;
    all.push_back(value);
    if (word.size() == text.size()) break;
    text.remove_prefix(word.size() + 1);
  }
  if (all.size() < 2 || all.size() > 3) return std::nullopt;
  return all;
}

}  // namespace

std::optional<Eigen::Vector3d> local_m(const EarthPlace& origin, const EarthPlace& place) {
  const auto plane_m = in_plane_m(origin, place);
  if (!plane_m || !(plane_m->norm() <= kFarthestVehicle_m)) return std::nullopt;
  return Eigen::Vector3d(plane_m->x(), plane_m->y(), place.altitude_m - origin.altitude_m);
}

EarthPlace place_at(const EarthPlace& origin, const Eigen::Vector2d& x_m) {
  constexpr double f = kFlattening;
  const double way_m = x_m.norm();
  if (way_m == 0) return origin;
  const double sin_1 = x_m.x() / way_m, cos_1 = x_m.y() / way_m;  // of the azimuth at the origin
  const double u1 = std::atan((1 - f) * std::tan(radians(origin.latitude_deg)));
  const double sin_u = std::sin(u1), cos_u = std::cos(u1);
  const double from_equator = std::atan2(std::tan(u1), cos_1);
  const double sin_a = cos_u * sin_1, cos2_a = 1 - sin_a * sin_a;
  const Series series(u2_of(cos2_a));
  const double b = series.b, first = way_m / (kMinor_m * series.a);
  double s = first, cos_2m = 1;
  for (int round = 0; round < 50; ++round) {
    cos_2m = std::cos(2 * from_equator + s);
    const double sin_s = std::sin(s), square = 2 * cos_2m * cos_2m - 1;
    const double bent =
        b * sin_s *
        (cos_2m + b / 4 *
                      (std::cos(s) * square -
                       b / 6 * cos_2m * (4 * sin_s * sin_s - 3) * (4 * cos_2m * cos_2m - 3)));
    if (std::abs(first + bent - std::exchange(s, first + bent)) < 1e-14) break;
  }
  const double sin_s = std::sin(s), cos_s = std::cos(s), square = 2 * cos_2m * cos_2m - 1;
  const double inward = sin_u * sin_s - cos_u * cos_s * cos_1;
  const double latitude =
      std::atan2(sin_u * cos_s + cos_u * sin_s * cos_1, (1 - f) * std::hypot(sin_a, inward));
  const double lambda = std::atan2(sin_s * sin_1, cos_u * cos_s - sin_u * sin_s * cos_1);
  const double c = f / 16 * cos2_a * (4 + f * (4 - 3 * cos2_a));
  const double east =
      lambda - (1 - c) * f * sin_a * (s + c * sin_s * (cos_2m + c * cos_s * square));
  EarthPlace there = origin;
  there.latitude_deg = degrees(latitude);
  there.longitude_deg = std::remainder(origin.longitude_deg + degrees(east), 360);
  return there;
}

Result<EarthPlace> read_place(std::string_view text) {
  const auto all = numbers_in(text);
  if (!all || std::abs((*all)[0]) > 90 || std::abs((*all)[1]) > 180)
    return failure("'" + std::string(text) +
                   "' is no place: LATITUDE,LONGITUDE in degrees, and in a box the altitude above "
                   "sea level, such as 47.6535,9.175,402.5");
  const bool has_altitude = all->size() == 3;
  return EarthPlace{(*all)[0], (*all)[1], has_altitude ? (*all)[2] : 0, has_altitude};
}

Result<Eigen::Vector3d> read_point(std::string_view text) {
  const auto all = numbers_in(text);
  if (!all)
    return failure("'" + std::string(text) +
                   "' is no point: X,Y or X,Y,Z in metres, such as 20,35");
  return Eigen::Vector3d((*all)[0], (*all)[1], all->size() == 3 ? (*all)[2] : 0);
}

EarthPlace place_of(const GlobalPositionInt& at) {
  return {at.lat * 1e-7, at.lon * 1e-7, at.alt * 1e-3};
}

EarthPlace place_of(const GpsGlobalOrigin& at) {
  return {at.latitude * 1e-7, at.longitude * 1e-7, at.altitude * 1e-3};
}

Eigen::Vector3d velocity_mps_of(const GlobalPositionInt& at) {
  return enu_of(Eigen::Vector3d(at.vx, at.vy, at.vz) * 0.01);
}

Eigen::Vector3d offset_m_of(const LocalPositionNed& at) {
  return enu_of(Eigen::Vector3d(at.x, at.y, at.z));
}

Eigen::Vector3d velocity_mps_of(const LocalPositionNed& at) {
  return enu_of(Eigen::Vector3d(at.vx, at.vy, at.vz));
}

SetPositionTargetLocalNed setpoint_of(const Eigen::Vector3d& velocity_mps) {
  constexpr std::uint8_t kLocalNed = 1;
  constexpr std::uint16_t kPlace = 7, kAcceleration = 7 << 6, kHeading = 1 << 10, kRate = 1 << 11;
  const Eigen::Vector3f ned = ned_of(velocity_mps).cast<float>();
  SetPositionTargetLocalNed setpoint;
  setpoint.vx = ned.x();
  setpoint.vy = ned.y();
  setpoint.vz = ned.z();
  setpoint.type_mask = kPlace | kAcceleration | kHeading | kRate;
  setpoint.coordinate_frame = kLocalNed;
  return setpoint;
}

}  // namespace ergocast::mavlink
