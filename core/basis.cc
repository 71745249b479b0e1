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

Eigen::Vector2d wave_numbers_of(const Rectangle& domain) {
  return {std::numbers::pi / domain.size_m.x(), std::numbers::pi / domain.size_m.y()};
}

/// cos(mα) and sin(mα).
struct Wave {
  double cosine, sine;
  /// Of one mode more, by those of the first.
  Wave after(const Wave& first) const {
    return {cosine * first.cosine - sine * first.sine, sine * first.cosine + cosine * first.sine};
  }
};

/// Calls each(m, wave along x, wave along y) for every mode of the axis that has more of them: both
/// axes in one loop, for neither waits for the other, and the shorter one's tables have room.
template <class Each>
inline void for_each_mode(const Eigen::Vector2d& x_m, const Rectangle& domain, const Basis& basis,
                          const Each& each) {
  ERGOCAST_REQUIRE(x_m.allFinite());
  ERGOCAST_REQUIRE(basis.modes_x <= kMaxModesPerAxis && basis.modes_y <= kMaxModesPerAxis);
  const Eigen::Vector2d angle = wave_numbers_of(domain).cwiseProduct(x_m - domain.origin_m);
  const Wave first_x{std::cos(angle.x()), std::sin(angle.x())};
  const Wave first_y{std::cos(angle.y()), std::sin(angle.y())};
  Wave x{1, 0}, y{1, 0};
  for (int m = 0, end = std::max(basis.modes_x, basis.modes_y); m < end; ++m) {
    each(m, x, y);
    x = x.after(first_x);
    y = y.after(first_y);
  }
}

}  // namespace

CosinesAt::CosinesAt(const Eigen::Vector2d& x_m, const Rectangle& domain, const Basis& basis) {
  for_each_mode(x_m, domain, basis, [this](int m, const Wave& x, const Wave& y) {
    cos_x[m] = x.cosine;
    cos_y[m] = y.cosine;
  });
}

BasisAt::BasisAt(const Eigen::Vector2d& x_m, const Rectangle& domain, const Basis& basis) {
  const Eigen::Vector2d wave_numbers = wave_numbers_of(domain);
  for_each_mode(x_m, domain, basis, [&](int m, const Wave& x, const Wave& y) {
    cos_x[m] = x.cosine;
    cos_y[m] = y.cosine;
    slope_x[m] = -m * wave_numbers.x() * x.sine;
    slope_y[m] = -m * wave_numbers.y() * y.sine;
  });
}

Coefficients basis_values(const Eigen::Vector2d& x_m, const Rectangle& domain, const Basis& basis) {
  Coefficients values = Coefficients::Zero(basis.modes_x, basis.modes_y);
  accumulate_basis(CosinesAt(x_m, domain, basis), basis, 1.0, values.data());
  return values;
}

ERGOCAST_VECTORIZED
void set_basis(const CosinesAt& at, const Basis& basis, double dt_s, double* sums) {
  for (int m = 0; m < basis.modes_x; ++m) {
    const double along_x = at.cos_x[m] * dt_s;
    double* row = sums + m * basis.modes_y;
    for (int n = 0; n < basis.modes_y; ++n) row[n] = along_x * at.cos_y[n];
  }
}

ERGOCAST_VECTORIZED
void accumulate_basis(const CosinesAt& at, const Basis& basis, double dt_s, double* sums) {
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

namespace {

/// As in weighted_gradient(), with one more column sum: of f'' along x.
struct ColumnSums {
  BasisAt::Table over_bend, over_slope, over_cos;
};

/// Adds so many rows, from row m on and in this order. By several at a time the sums are read and
/// written less often.
template <int kRows>
ERGOCAST_VECTORIZED_PART void add_rows(const BasisAt& at, const BasisAt::Table& bend,
                                       const Basis& basis, const double* weights, int m,
                                       ColumnSums& __restrict sums) {
  for (int n = 0; n < basis.modes_y; ++n) {
    double over_bend = sums.over_bend[n], over_slope = sums.over_slope[n];
    double over_cos = sums.over_cos[n];
    for (int row = m; row < m + kRows; ++row) {
      const double weight = weights[row * basis.modes_y + n];
      over_bend += bend[row] * weight;
      over_slope += at.slope_x[row] * weight;
      over_cos += at.cos_x[row] * weight;
    }
    sums.over_bend[n] = over_bend;
    sums.over_slope[n] = over_slope;
    sums.over_cos[n] = over_cos;
  }
}

}  // namespace

ERGOCAST_VECTORIZED
FieldAt weighted_field(const BasisAt& at, const Basis& basis, const Rectangle& domain,
                       const double* weights) {
  const Eigen::Vector2d wave_number_squared =
      (std::numbers::pi * domain.size_m.cwiseInverse()).cwiseAbs2();
  BasisAt::Table bend;
  for (int m = 0; m < basis.modes_x; ++m) bend[m] = -wave_number_squared.x() * m * m * at.cos_x[m];
  ColumnSums over;
  for (int n = 0; n < basis.modes_y; ++n) {
    over.over_bend[n] = over.over_slope[n] = over.over_cos[n] = 0;
  }
  int m = 0;
  for (; m + 2 <= basis.modes_x; m += 2) add_rows<2>(at, bend, basis, weights, m, over);
  for (; m < basis.modes_x; ++m) add_rows<1>(at, bend, basis, weights, m, over);
  FieldAt field;
  double xx = 0, xy = 0, yy = 0;
  for (int n = 0; n < basis.modes_y; ++n) {
    field.gradient.x() += over.over_slope[n] * at.cos_y[n];
    field.gradient.y() += over.over_cos[n] * at.slope_y[n];
    xx += over.over_bend[n] * at.cos_y[n];
    xy += over.over_slope[n] * at.slope_y[n];
    yy -= over.over_cos[n] * (wave_number_squared.y() * n * n * at.cos_y[n]);
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
