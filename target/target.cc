// SPDX-License-Identifier: BSD-3-Clause
// Adds the integrals of all parts, and divides by their mass.
#include "target/target.h"

#include <vector>

#include "core/require.h"
#include "target/cosine_integrals.h"
#include "target/gaussian_integrals.h"
#include "target/trapezoids.h"

namespace ergocast {
namespace {

double area_of(const Rectangle& domain) { return domain.size_m.x() * domain.size_m.y(); }

void add_pieces(const std::vector<Trapezoid>& pieces, double density_per_m2,
                const Rectangle& domain, TargetCoefficients& sum) {
  for (const Trapezoid& piece : pieces) {
    sum.error_bound += add_polygon(piece.corners(), density_per_m2, domain.size_m, sum.values);
  }
}

void add(double weight, const TargetCoefficients& part, TargetCoefficients& sum) {
  sum.values += weight * part.values;
  sum.error_bound += weight * part.error_bound;
}

/// The uniform part and the Gaussians.
TargetCoefficients smooth_parts(const TargetDensity& target, const Rectangle& domain,
                                const Basis& basis) {
  TargetCoefficients sum{PlaneCoefficients::Zero(basis.modes_x, basis.modes_y), 0};
  if (target.keep_outs.empty()) {
    sum.values(0, 0) = target.uniform_weight;
    for (const Gaussian& g : target.gaussians) {
      add(g.weight, integrals_over_domain(g, domain, basis), sum);
    }
    return sum;
  }
  const std::vector<Trapezoid> free = free_area(domain, target.keep_outs);
  add_pieces(free, target.uniform_weight / area_of(domain), domain, sum);
  for (const Gaussian& g : target.gaussians) {
    add(g.weight, integrals_over(g, free, domain, basis), sum);
  }
  return sum;
}

}  // namespace

TargetCoefficients region_integrals(const Region& region, const TargetDensity& target,
                                    const Rectangle& domain, const Basis& basis) {
  TargetCoefficients sum{PlaneCoefficients::Zero(basis.modes_x, basis.modes_y), 0};
  add_pieces(free_area_within(region.polygon, domain, target.keep_outs),
             1 / area_m2(region.polygon), domain, sum);
  return sum;
}

TargetCoefficients target_integrals(const TargetDensity& target, const Rectangle& domain,
                                    const Basis& basis) {
  TargetCoefficients sum = smooth_parts(target, domain, basis);
  for (const Region& region : target.regions) {
    add(region.weight, region_integrals(region, target, domain, basis), sum);
  }
  return sum;
}

TargetCoefficients normalized(TargetCoefficients integrals) {
  const double mass = integrals.values(0, 0);
  ERGOCAST_REQUIRE(mass > 0);
  integrals.values /= mass;
  integrals.error_bound *= 2 / mass;
  return integrals;
}

TargetCoefficients target_coefficients(const TargetDensity& target, const Rectangle& domain,
                                       const Basis& basis) {
  return normalized(target_integrals(target, domain, basis));
}

double mass_inside(const TargetDensity& target, const Rectangle& domain) {
  return target_integrals(target, domain, Basis{}).values(0, 0);
}

double density_unscaled(const TargetDensity& target, const Rectangle& domain,
                        const Eigen::Vector2d& x_m) {
  for (const Polygon& keep_out : target.keep_outs) {
    if (contains(keep_out, x_m)) return 0;
  }
  double density = target.uniform_weight / area_of(domain);
  for (const Gaussian& g : target.gaussians) density += g.weight * GaussianDensity(g)(x_m);
  for (const Region& region : target.regions) {
    if (contains(region.polygon, x_m)) density += region.weight / area_m2(region.polygon);
  }
  return density;
}

}  // namespace ergocast
