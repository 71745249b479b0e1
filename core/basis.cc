// SPDX-License-Identifier: BSD-3-Clause
// Sums over modes are products of two short tables of cosines, which recurrences fill, one for
// each axis.
#include "core/basis.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/require.h"
#include "core/vectorized.h"

namespace ergocast {
namespace {

double half_unless_zero(int mode) { return mode == 0 ? 1.0 : 0.5; }

}  // namespace

BasisAt::BasisAt(const Eigen::Vector2d& x_m, const Rectangle& domain, const Basis& basis) {
  ERGOCAST_REQUIRE(x_m.allFinite());
  ERGOCAST_REQUIRE(basis.modes_x <= kMaxModesPerAxis && basis.modes_y <= kMaxModesPerAxis);
  const double wave_x = std::numbers::pi / domain.size_m.x();
  const double wave_y = std::numbers::pi / domain.size_m.y();
  const double angle_x = wave_x * (x_m.x() - domain.origin_m.x());
  const double angle_y = wave_y * (x_m.y() - domain.origin_m.y());
  const double first_cx = std::cos(angle_x), first_sx = std::sin(angle_x);
  const double first_cy = std::cos(angle_y), first_sy = std::sin(angle_y);
  double cx = 1, sx = 0, cy = 1, sy = 0;
  // Both axes in one loop, for neither waits for the other; the shorter one's tables have room.
  for (int m = 0, end = std::max(basis.modes_x, basis.modes_y); m < end; ++m) {
    cos_x[m] = cx;
    cos_y[m] = cy;
    slope_x[m] = -m * wave_x * sx;
    slope_y[m] = -m * wave_y * sy;
    const double next_x = cx * first_cx - sx * first_sx;
    const double next_y = cy * first_cy - sy * first_sy;
    sx = sx * first_cx + cx * first_sx;
    sy = sy * first_cy + cy * first_sy;
    cx = next_x;
    cy = next_y;
  }
}

Coefficients basis_values(const Eigen::Vector2d& x_m, const Rectangle& domain, const Basis& basis) {
  Coefficients values = Coefficients::Zero(basis.modes_x, basis.modes_y);
  accumulate_basis(BasisAt(x_m, domain, basis), basis, 1.0, values.data());
  return values;
}

ERGOCAST_VECTORIZED
void set_basis(const BasisAt& at, const Basis& basis, double dt_s, double* sums) {
  for (int m = 0; m < basis.modes_x; ++m) {
    const double along_x = at.cos_x[m] * dt_s;
    double* row = sums + m * basis.modes_y;
    for (int n = 0; n < basis.modes_y; ++n) row[n] = along_x * at.cos_y[n];
  }
}

ERGOCAST_VECTORIZED
void accumulate_basis(const BasisAt& at, const Basis& basis, double dt_s, double* sums) {
  for (int m = 0; m < basis.modes_x; ++m) {
    const double along_x = at.cos_x[m] * dt_s;
    double* row = sums + m * basis.modes_y;
    for (int n = 0; n < basis.modes_y; ++n) row[n] += along_x * at.cos_y[n];
  }
}

ERGOCAST_VECTORIZED
Eigen::Vector2d weighted_gradient(const BasisAt& at, const Basis& basis, const double* weights) {
  // Column sums first: their loops run over n, so they vectorise without reordering an addition.
  BasisAt::Table over_slope, over_cos;
  for (int n = 0; n < basis.modes_y; ++n) over_slope[n] = over_cos[n] = 0;
  for (int m = 0; m < basis.modes_x; ++m) {
    const double* row = weights + m * basis.modes_y;
    const double slope = at.slope_x[m], cosine = at.cos_x[m];
    for (int n = 0; n < basis.modes_y; ++n) {
      over_slope[n] += slope * row[n];
      over_cos[n] += cosine * row[n];
    }
  }
  Eigen::Vector2d gradient(0, 0);
  for (int n = 0; n < basis.modes_y; ++n) {
    gradient.x() += over_slope[n] * at.cos_y[n];
    gradient.y() += over_cos[n] * at.slope_y[n];
  }
  return gradient;
}

ERGOCAST_VECTORIZED
FieldAt weighted_field(const BasisAt& at, const Basis& basis, const Rectangle& domain,
                       const double* weights) {
  const Eigen::Vector2d wave_number_squared =
      (std::numbers::pi * domain.size_m.cwiseInverse()).cwiseAbs2();
  // As in weighted_gradient(), with one more column sum: of f'' along x.
  BasisAt::Table over_bend, over_slope, over_cos;
  for (int n = 0; n < basis.modes_y; ++n) over_bend[n] = over_slope[n] = over_cos[n] = 0;
  for (int m = 0; m < basis.modes_x; ++m) {
    const double* row = weights + m * basis.modes_y;
    const double slope = at.slope_x[m], cosine = at.cos_x[m];
    const double bend = -wave_number_squared.x() * m * m * cosine;
    for (int n = 0; n < basis.modes_y; ++n) {
      over_bend[n] += bend * row[n];
      over_slope[n] += slope * row[n];
      over_cos[n] += cosine * row[n];
    }
  }
  FieldAt field;
  double xx = 0, xy = 0, yy = 0;
  for (int n = 0; n < basis.modes_y; ++n) {
    field.gradient.x() += over_slope[n] * at.cos_y[n];
    field.gradient.y() += over_cos[n] * at.slope_y[n];
    xx += over_bend[n] * at.cos_y[n];
    xy += over_slope[n] * at.slope_y[n];
    yy -= over_cos[n] * (wave_number_squared.y() * n * n * at.cos_y[n]);
  }
  field.hessian << xx, xy, xy, yy;
  return field;
}

Coefficients sobolev_weights(const Basis& basis, const Rectangle& domain) {
  Coefficients weights(basis.modes_x, basis.modes_y);
  const double area_m2 = domain.size_m.x() * domain.size_m.y();
  for (int m = 0; m < basis.modes_x; ++m) {
    for (int n = 0; n < basis.modes_y; ++n) {
      const double squared = static_cast<double>(m) * m + static_cast<double>(n) * n;
      const double base =
          1 + (basis.sobolev_form == SobolevForm::kSquaredNorm ? squared : std::sqrt(squared));
      const double h_squared =
          basis.normalized ? area_m2 * half_unless_zero(m) * half_unless_zero(n) : 1.0;
      weights(m, n) = std::pow(base, -basis.sobolev_exponent) / h_squared;
    }
  }
  return weights;
}

Coefficients gradient_energies(const Basis& basis, const Rectangle& domain) {
  Coefficients energies(basis.modes_x, basis.modes_y);
  for (int m = 0; m < basis.modes_x; ++m) {
    for (int n = 0; n < basis.modes_y; ++n) {
      const double kx = m * std::numbers::pi / domain.size_m.x();
      const double ky = n * std::numbers::pi / domain.size_m.y();
      energies(m, n) = 0.5 * (kx * kx * half_unless_zero(n) + ky * ky * half_unless_zero(m));
    }
  }
  return energies;
}

double ergodic_metric(const Coefficients& coverage, const Coefficients& target,
                      const Coefficients& weights) {
  double metric = 0;
  for (Eigen::Index k = 0; k < weights.size(); ++k) {
    const double residual = coverage.data()[k] - target.data()[k];
    metric += weights.data()[k] * residual * residual;
  }
  return metric;
}

}  // namespace ergocast
