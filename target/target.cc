// SPDX-License-Identifier: BSD-3-Clause
// Adds the integrals of all parts, storey by storey, and divides by their mass.
#include "target/target.h"

#include <vector>

#include "core/base/require.h"
#include "target/cosine_integrals.h"
#include "target/gaussian_integrals.h"
#include "target/leaning_gaussian.h"
#include "target/trapezoids.h"

namespace ergocast {
namespace {

PlaneIntegrals zero(const Basis& basis) {
  return {PlaneCoefficients::Zero(basis.modes_x, basis.modes_y), 0};
}

PlaneIntegrals over_pieces(const std::vector<Trapezoid>& pieces, double density_per_m2,
                           const Eigen::Vector2d& size_m, const Basis& basis) {
  PlaneIntegrals sum = zero(basis);
  for (const Trapezoid& piece : pieces)
    sum.error_bound += add_polygon(piece.corners(), density_per_m2, size_m, sum.values);
  return sum;
}

/// What all parts have in common.
class TargetIntegrals {
 public:
  /// @param target  from the domain's corner
  TargetIntegrals(const TargetDensity& target, const Eigen::Vector3d& size_m, const Basis& basis)
      : target_(target),
        size_m_(size_m),
        base_m_(size_m.head<2>()),
        basis_(basis),
        along_z_(size_m.z(), basis),
        storeys_(storeys_of(size_m.z(), target.keep_outs)),
        sum_{Coefficients::Zero(basis.mode_count()), 0} {}

  void add_smooth_parts() {
    for (const Storey& storey : storeys_) {
      const std::vector<Trapezoid> free = storey.free(base_m_);
      add_uniform(storey, free);
      for (const Gaussian& gaussian : target_.gaussians) add_gaussian(gaussian, storey, free);
    }
  }

  void add_region(const Region& region) {
    for (const Storey& storey : storeys_) {
      const auto inside = free_area_within(region.polygon, base_m_, storey.keep_outs);
      const Eigen::VectorXd along_z = along_z_.uniform(region.heights, storey.heights);
      add_product(region.weight, over_pieces(inside, 1 / area_m2(region.polygon), base_m_, basis_),
                  along_z, sum_);
    }
  }

  TargetCoefficients take() { return std::move(sum_); }

 private:
  void add_uniform(const Storey& storey, const std::vector<Trapezoid>& free) {
    const Eigen::VectorXd along_z = along_z_.uniform({0, size_m_.z()}, storey.heights);
    PlaneIntegrals plane = zero(basis_);
    if (storey.keep_outs.empty()) {
      plane.values(0, 0) = target_.uniform_weight;
    } else {
      plane = over_pieces(free, target_.uniform_weight / base_m_.prod(), base_m_, basis_);
    }
    add_product(1, plane, along_z, sum_);
  }

  void add_gaussian(const Gaussian& gaussian, const Storey& storey,
                    const std::vector<Trapezoid>& free) {
    const GaussianAtHeight g(gaussian);
    if (size_m_.z() > 0 && g.leans())
      return add_leaning(gaussian, free, storey.heights, size_m_, basis_, sum_);
    const PlaneGaussian above{gaussian.mean_m.head<2>(),
                              gaussian.covariance_m2.topLeftCorner<2, 2>()};
    const PlaneIntegrals plane = storey.keep_outs.empty()
                                     ? integrals_over_domain(above, base_m_, basis_)
                                     : integrals_over(above, free, base_m_, basis_);
    add_product(gaussian.weight, plane,
                along_z_.gaussian(g.mean_z_m(), g.deviation_z_m(), storey.heights), sum_);
  }

  const TargetDensity& target_;
  Eigen::Vector3d size_m_;
  Eigen::Vector2d base_m_;
  const Basis& basis_;
  AlongZ along_z_;
  std::vector<Storey> storeys_;
  TargetCoefficients sum_;
};

/// N(x) of one Gaussian, without its weight.
double density_of(const Gaussian& gaussian, const Box& domain, const Eigen::Vector3d& x_m) {
  if (domain.planar()) {
    return GaussianDensity(
        {gaussian.mean_m.head<2>(), gaussian.covariance_m2.topLeftCorner<2, 2>()})(x_m.head<2>());
  }
  const GaussianAtHeight g(gaussian);
  return g.density_z(x_m.z()) * GaussianDensity(g.at(x_m.z()))(x_m.head<2>());
}

}  // namespace

Gaussian plane_gaussian(double weight, const Eigen::Vector2d& mean_m,
                        const Eigen::Matrix2d& covariance_m2) {
  Gaussian gaussian{weight, on_ground(mean_m)};
  gaussian.covariance_m2.topLeftCorner<2, 2>() = covariance_m2;
  return gaussian;
}

TargetDensity from_corner(const TargetDensity& target, const Box& domain) {
  const Eigen::Vector2d corner_m = domain.origin_m.head<2>();
  TargetDensity moved = target;
  for (Gaussian& gaussian : moved.gaussians) gaussian.mean_m -= domain.origin_m;
  for (Region& region : moved.regions) {
    region.polygon = from_corner(region.polygon, corner_m);
    region.heights = above_floor(region.heights, domain);
  }
  for (KeepOut& keep_out : moved.keep_outs) {
    keep_out.polygon = from_corner(keep_out.polygon, corner_m);
    keep_out.heights = above_floor(keep_out.heights, domain);
  }
  return moved;
}

void add_product(double weight, const PlaneIntegrals& plane, const Eigen::VectorXd& along_z,
                 TargetCoefficients& sum) {
  const Eigen::Index modes = plane.values.size();
  const auto values = plane.values.reshaped<Eigen::RowMajor>();
  for (Eigen::Index l = 0; l < along_z.size(); ++l)
    sum.values.segment(l * modes, modes) += weight * along_z[l] * values;
  // An entry of along_z is at most its mass; a few roundings of it do not count.
  sum.error_bound += weight * along_z[0] * plane.error_bound;
}

TargetCoefficients target_integrals(const TargetDensity& target, const Box& domain,
                                    const Basis& basis) {
  const TargetDensity moved = from_corner(target, domain);
  TargetIntegrals integrals(moved, domain.size_m, basis);
  integrals.add_smooth_parts();
  for (const Region& region : moved.regions) integrals.add_region(region);
  return integrals.take();
}

double free_share(const Region& region, const TargetDensity& target, const Box& domain) {
  const Basis one;
  TargetDensity moved = from_corner({{}, 0, {region}, target.keep_outs}, domain);
  moved.regions[0].weight = 1;
  TargetIntegrals integrals(moved, domain.size_m, one);
  integrals.add_region(moved.regions[0]);
  return integrals.take().values[0];
}

TargetCoefficients normalized(TargetCoefficients integrals) {
  const double mass = integrals.values[0];
  ERGOCAST_REQUIRE(mass > 0);
  integrals.values /= mass;
  integrals.error_bound *= 2 / mass;
  return integrals;
}

TargetCoefficients target_coefficients(const TargetDensity& target, const Box& domain,
                                       const Basis& basis) {
  return normalized(target_integrals(target, domain, basis));
}

double mass_inside(const TargetDensity& target, const Box& domain) {
  return target_integrals(target, domain, Basis{}).values[0];
}

double density_unscaled(const TargetDensity& target, const Box& domain,
                        const Eigen::Vector3d& x_m) {
  const Eigen::Vector2d above_m = x_m.head<2>();
  const auto stands = [&](const Heights& heights) {
    return domain.planar() || heights.contain(x_m.z());
  };
  for (const KeepOut& keep_out : target.keep_outs) {
    if (stands(keep_out.heights) && contains(keep_out.polygon, above_m)) return 0;
  }
  double density = target.uniform_weight / domain.content();
  for (const Gaussian& g : target.gaussians) density += g.weight * density_of(g, domain, x_m);
  for (const Region& region : target.regions) {
    if (!stands(region.heights) || !contains(region.polygon, above_m)) continue;
    const double height = domain.planar() ? 1 : region.heights.length_m();
    density += region.weight / (area_m2(region.polygon) * height);
  }
  return density;
}

}  // namespace ergocast
