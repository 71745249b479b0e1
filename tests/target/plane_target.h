// SPDX-License-Identifier: BSD-3-Clause
// The functions of target/target.h for planes, in the numbers of a plane.
#pragma once

#include "target/density_picture.h"
#include "target/target.h"

namespace ergocast {

inline Box plane_of(const Rectangle& domain) {
  return {on_ground(domain.origin_m), on_ground(domain.size_m)};
}

inline PlaneIntegrals in_plane(const TargetCoefficients& coefficients, const Basis& basis) {
  return {in_plane(coefficients.values, basis), coefficients.error_bound};
}

inline PlaneIntegrals target_coefficients(const TargetDensity& target, const Rectangle& domain,
                                          const Basis& basis) {
  return in_plane(target_coefficients(target, plane_of(domain), basis), basis);
}

inline PlaneIntegrals target_integrals(const TargetDensity& target, const Rectangle& domain,
                                       const Basis& basis) {
  return in_plane(target_integrals(target, plane_of(domain), basis), basis);
}

inline double mass_inside(const TargetDensity& target, const Rectangle& domain) {
  return mass_inside(target, plane_of(domain));
}

inline double density_unscaled(const TargetDensity& target, const Rectangle& domain,
                               const Eigen::Vector2d& x_m) {
  return density_unscaled(target, plane_of(domain), on_ground(x_m));
}

/// The picture of a target whose maps are empty.
inline DensityGrid picture_of(const TargetDensity& target, const Box& domain, int cells_x,
                              int cells_y) {
  const TargetDensity moved = from_corner(target, domain);
  const std::vector<DensityGrid> maps(storeys_of(domain.size_m.z(), moved.keep_outs).size(),
                                      DensityGrid::Zero(cells_x, cells_y));
  return density_picture(moved, maps, domain.size_m);
}

}  // namespace ergocast
