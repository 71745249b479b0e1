// SPDX-License-Identifier: BSD-3-Clause
// Turns the way past the edge of each disc in it, one after the other.
#include "core/motion/detour.h"

#include <algorithm>
#include <cmath>

namespace ergocast {
namespace {

/// The share of a disc that rounding may take.
constexpr double kRoundedShare = 1e-9;
/// An agent gets hardly further if it moves less than this share of its undisturbed way.
constexpr double kHardlyFurtherShare = 0.2;

double across(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

double norm_of(const Eigen::Vector2d& v) { return std::sqrt(v.squaredNorm()); }

}  // namespace

/// A disc in the `direction`, a unit vector; null: none. Discs beyond the end of the way do not
/// count. That end is exact if the direction is `straight`, else the length of the way counts.
const Detour::Disc* Detour::in_the_way(const Eigen::Vector2d& x_m, const Eigen::Vector2d& way_m,
                                       const Eigen::Vector2d& direction, bool straight) const {
  const double far_m = norm_of(way_m);
  for (const Disc& disc : discs_) {
    const Eigen::Vector2d to_m = disc.center_m - x_m;
    const double kept_m = disc.kept_m * (1 - kRoundedShare), ahead_m = direction.dot(to_m);
    if (norm_of(to_m - way_m) < disc.kept_m) continue;
    if (ahead_m <= kRoundedShare * norm_of(to_m)) continue;
    if (straight ? ahead_m >= far_m : norm_of(to_m) - disc.kept_m >= far_m) continue;
    if (std::abs(across(direction, to_m)) < kept_m) return &disc;
  }
  return nullptr;
}

/// The first free direction to one side of the way. Nothing if there is none: then it has passed
/// the edge of each disc once.
std::optional<Eigen::Vector2d> Detour::turned(const Eigen::Vector2d& x_m,
                                              const Eigen::Vector2d& way_m, double side) const {
  Eigen::Vector2d direction = way_m / norm_of(way_m);
  for (std::size_t i = 0; i <= discs_.size(); ++i) {
    const Disc* const disc = in_the_way(x_m, way_m, direction, false);
    if (disc == nullptr) return direction;
    const Eigen::Vector2d to_m = disc->center_m - x_m;
    const double apart_m = norm_of(to_m), sine = std::min(1.0, disc->kept_m / apart_m);
    const Eigen::Vector2d n = to_m / apart_m, left(-n.y(), n.x());
    direction = std::sqrt(1 - sine * sine) * n + side * sine * left;
  }
  return std::nullopt;
}

void Detour::choose_side(const Eigen::Vector2d& x_m, const Eigen::Vector2d& way_m) {
  const auto left = turned(x_m, way_m, 1), right = turned(x_m, way_m, -1);
  const bool turns_right = right && (!left || right->dot(way_m) > left->dot(way_m));
  side_ = turns_right ? -1 : 1;
}

Eigen::Vector2d Detour::round(const Eigen::Vector2d& x_m, const Eigen::Vector2d& way_m) {
  const double far_m = norm_of(way_m);
  if (far_m == 0 || in_the_way(x_m, way_m, way_m / far_m, true) == nullptr) {
    side_ = 0;
    return way_m;
  }
  if (side_ == 0) {
    choose_side(x_m, way_m);
    from_m_ = x_m;
    ticks_ = 0;
  }
  if (ticks_ == patience_ticks_) {
    const double free_m = static_cast<double>(ticks_) * step_m_;
    if (norm_of(x_m - from_m_) < kHardlyFurtherShare * free_m) side_ = -side_;
    from_m_ = x_m;
    ticks_ = 0;
  }
  ++ticks_;
  const auto direction = turned(x_m, way_m, side_);
  return direction ? far_m * *direction : way_m;
}

}  // namespace ergocast
