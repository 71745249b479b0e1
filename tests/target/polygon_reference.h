// SPDX-License-Identifier: BSD-3-Clause
// Integrals over polygons by another method than core/'s: triangles from the first corner, each
// with its sign, and in each a product of Gauss rules on panels (Duffy's map of the square).
#pragma once

#include <cmath>
#include <functional>
#include <numbers>

#include "core/basis/basis.h"
#include "target/polygon.h"
#include "target/rectangle.h"

namespace ergocast::test {

using Density = std::function<double(const Eigen::Vector2d&)>;

/// f_mn at any point, by std::cos alone.
inline PlaneCoefficients cosines_at(const Eigen::Vector2d& x_m, const Rectangle& domain,
                                    const Basis& basis) {
  const Eigen::Vector2d at = (x_m - domain.origin_m).cwiseQuotient(domain.size_m);
  Eigen::VectorXd along_x(basis.modes_x), along_y(basis.modes_y);
  for (int m = 0; m < basis.modes_x; ++m) along_x[m] = std::cos(m * std::numbers::pi * at.x());
  for (int n = 0; n < basis.modes_y; ++n) along_y[n] = std::cos(n * std::numbers::pi * at.y());
  return along_x * along_y.transpose();
}

/// ∫ f_mn density over the triangle, positive if it is counter-clockwise.
inline PlaneCoefficients over_triangle(const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                                       const Eigen::Vector2d& c, const Density& density,
                                       const Rectangle& domain, const Basis& basis, int panels) {
  constexpr double kNode[] = {-0.906179845938664, -0.5384693101056831, 0, 0.5384693101056831,
                              0.906179845938664};
  constexpr double kWeight[] = {0.2369268850561891, 0.4786286704993665, 0.5688888888888889,
                                0.4786286704993665, 0.2369268850561891};
  const auto node = [&](int i) { return (2 * (i / 5) + 1 + kNode[i % 5]) / (2 * panels); };
  const auto weight = [&](int i) { return kWeight[i % 5] / (2 * panels); };
  const double twice = (b - a).x() * (c - a).y() - (b - a).y() * (c - a).x();
  PlaneCoefficients sum = PlaneCoefficients::Zero(basis.modes_x, basis.modes_y);
  for (int i = 0; i < 5 * panels; ++i) {
    for (int j = 0; j < 5 * panels; ++j) {
      const double u = node(i), v = node(j);
      const Eigen::Vector2d x_m = a + u * (b - a) + u * v * (c - b);
      sum += weight(i) * weight(j) * u * twice * density(x_m) * cosines_at(x_m, domain, basis);
    }
  }
  return sum;
}

/// The same over a ring written counter-clockwise.
inline PlaneCoefficients over_ring(const Ring& ring, const Density& density,
                                   const Rectangle& domain, const Basis& basis, int panels) {
  PlaneCoefficients sum = PlaneCoefficients::Zero(basis.modes_x, basis.modes_y);
  for (std::size_t i = 2; i < ring.size(); ++i) {
    sum += over_triangle(ring[0], ring[i - 1], ring[i], density, domain, basis, panels);
  }
  return sum;
}

inline double largest_difference(const PlaneCoefficients& a, const PlaneCoefficients& b) {
  return (a - b).cwiseAbs().maxCoeff();
}

inline double one(const Eigen::Vector2d&) { return 1; }

}  // namespace ergocast::test
