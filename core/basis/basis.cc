// SPDX-License-Identifier: BSD-3-Clause
// Sums over modes are products of two short tables of cosines, which recurrences fill, one for
// each axis.
#include "core/basis/basis.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>
#include <type_traits>

#include "core/base/portable_math.h"
#include "core/base/require.h"
#include "core/base/vectorized.h"
#include "core/basis/free_gains.h"

namespace ergocast {
namespace {

double half_unless_zero(int mode) { return mode == 0 ? 1.0 : 0.5; }

Eigen::Vector2d wave_numbers_of(const Box& domain) {
  return {std::numbers::pi / domain.size_m.x(), std::numbers::pi / domain.size_m.y()};
}

/// cos(mα) and sin(mα).
struct Wave {
  double cosine, sine;
  /// The wave of the next mode, from this one and that of the first mode.
  Wave after(const Wave& first) const {
    return {cosine * first.cosine - sine * first.sine, sine * first.cosine + cosine * first.sine};
  }
};

Wave first_wave(double angle) {
  const portable::SinCos at = portable::sin_cos(angle);
  return {at.cos, at.sin};
}

/// Calls each(m, wave along x, wave along y) for every mode of the axis that has more of them. One
/// loop serves both axes: neither waits for the other, and the shorter one's tables have room.
template <class Each>
inline void for_each_mode(const Eigen::Vector3d& x_m, const Box& domain, const Basis& basis,
                          const Each& each) {
  ERGOCAST_REQUIRE(x_m.allFinite());
  ERGOCAST_REQUIRE(basis.modes_x <= kMaxModesPerAxis && basis.modes_y <= kMaxModesPerAxis);
  const Eigen::Vector2d angle =
      wave_numbers_of(domain).cwiseProduct(x_m.head<2>() - domain.origin_m.head<2>());
  const Wave first_x = first_wave(angle.x()), first_y = first_wave(angle.y());
  Wave x{1, 0}, y{1, 0};
  for (int m = 0, end = std::max(basis.modes_x, basis.modes_y); m < end; ++m) {
    each(m, x, y);
    x = x.after(first_x);
    y = y.after(first_y);
  }
}

/// Calls each(l, wave along z, wave number of l = 1) for every mode along z of a box that has more
/// than one.
template <class Each>
void for_each_mode_along_z(double z_m, const Box& domain, const Basis& basis, const Each& each) {
  ERGOCAST_REQUIRE(basis.modes_z <= kMaxModesPerAxis && !domain.planar());
  const double wave_number = std::numbers::pi / domain.size_m.z();
  const double angle = wave_number * (z_m - domain.origin_m.z());
  const Wave first = first_wave(angle);
  Wave z{1, 0};
  for (int l = 0; l < basis.modes_z; ++l) {
    each(l, z, wave_number);
    z = z.after(first);
  }
}

}  // namespace

const FreeModes* Basis::free_modes() const {
  ERGOCAST_REQUIRE(!free_domain || table != nullptr);
  return free_domain ? table.get() : nullptr;
}

CosinesAt::CosinesAt(const Eigen::Vector3d& x_m, const Box& domain, const Basis& basis) {
  if (const FreeModes* const modes = basis.free_modes()) {
    free = FreePlace(x_m.head<2>(), *modes);
    return;
  }
  for_each_mode(x_m, domain, basis, [this](int m, const Wave& x, const Wave& y) {
    cos_x[m] = x.cosine;
    cos_y[m] = y.cosine;
  });
  cos_z[0] = 1;
  if (basis.planar()) return;
  for_each_mode_along_z(x_m.z(), domain, basis,
                        [this](int l, const Wave& z, double) { cos_z[l] = z.cosine; });
}

BasisAt::BasisAt(const Eigen::Vector3d& x_m, const Box& domain, const Basis& basis) {
  if (const FreeModes* const modes = basis.free_modes()) {
    free = FreePlace(x_m.head<2>(), *modes);
    return;
  }
  const Eigen::Vector2d wave_numbers = wave_numbers_of(domain);
  for_each_mode(x_m, domain, basis, [&](int m, const Wave& x, const Wave& y) {
    cos_x[m] = x.cosine;
    cos_y[m] = y.cosine;
    slope_x[m] = -m * wave_numbers.x() * x.sine;
    slope_y[m] = -m * wave_numbers.y() * y.sine;
  });
  cos_z[0] = 1;
  slope_z[0] = 0;
  if (basis.planar()) return;
  for_each_mode_along_z(x_m.z(), domain, basis, [this](int l, const Wave& z, double wave_number) {
    cos_z[l] = z.cosine;
    slope_z[l] = -l * wave_number * z.sine;
  });
}

Coefficients basis_values(const Eigen::Vector3d& x_m, const Box& domain, const Basis& basis) {
  Coefficients values = Coefficients::Zero(basis.mode_count());
  accumulate_basis(CosinesAt(x_m, domain, basis), basis, 1.0, values.data());
  return values;
}

namespace {

/// Calls each(sum, f_lmn · dt_s) for every mode; in a plane f_mn, bit for bit, for cos_z = {1}.
template <class Each>
ERGOCAST_VECTORIZED_PART void for_each_sum(const CosinesAt& at, const Basis& basis, double dt_s,
                                           double* sums, const Each& each) {
  if (at.free.modes != nullptr) {
    return for_free_gains(at.free, dt_s, 0, at.free.modes->mode_count,
                          [&](int k, double value) { each(sums[k], value); });
  }
  double* row = sums;
  for (int l = 0; l < basis.modes_z; ++l) {
    const double along_z = at.cos_z[l] * dt_s;
    for (int m = 0; m < basis.modes_x; ++m, row += basis.modes_y) {
      const double along_x = at.cos_x[m] * along_z;
      for (int n = 0; n < basis.modes_y; ++n) each(row[n], along_x * at.cos_y[n]);
    }
  }
}

}  // namespace

ERGOCAST_VECTORIZED
void set_basis(const CosinesAt& at, const Basis& basis, double dt_s, double* sums) {
  for_each_sum(at, basis, dt_s, sums, [](double& sum, double value) { sum = value; });
}

ERGOCAST_VECTORIZED
void accumulate_basis(const CosinesAt& at, const Basis& basis, double dt_s, double* sums) {
  for_each_sum(at, basis, dt_s, sums, [](double& sum, double value) { sum += value; });
}

ERGOCAST_VECTORIZED
void accumulate_basis(const CosinesAt& at, const Basis& basis, double dt_s, const double* share,
                      double* sums) {
  for_each_sum(at, basis, dt_s, sums,
               [=](double& sum, double value) { sum += value * share[&sum - sums]; });
}

// ---- the field: sums over the modes of a plane, which space uses three times ----

namespace {

/// Sums over the rows of a plane's weights, one for each column: of f, f' and f'' along x.
struct ColumnSums {
  BasisAt::Table over_bend, over_slope, over_cos;
};

/// Adds kRows rows, from row m on and in this order. Adding several at a time reads and writes the
/// sums less often.
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

ERGOCAST_VECTORIZED_PART void sum_columns(const BasisAt& at, const BasisAt::Table& bend,
                                          const Basis& basis, const double* weights,
                                          ColumnSums& sums) {
  for (int n = 0; n < basis.modes_y; ++n) {
    sums.over_bend[n] = sums.over_slope[n] = sums.over_cos[n] = 0;
  }
  int m = 0;
  for (; m + 2 <= basis.modes_x; m += 2) add_rows<2>(at, bend, basis, weights, m, sums);
  for (; m < basis.modes_x; ++m) add_rows<1>(at, bend, basis, weights, m, sums);
}

double wave_number_squared(double length_m) {
  const double wave_number = std::numbers::pi * (1 / length_m);
  return wave_number * wave_number;
}

/// f'' of every mode along an axis.
ERGOCAST_VECTORIZED_PART void set_bends(const BasisAt::Table& cosines, double length_m, int modes,
                                        BasisAt::Table& bend) {
  const double squared = wave_number_squared(length_m);
  for (int m = 0; m < modes; ++m) bend[m] = -squared * m * m * cosines[m];
}

ERGOCAST_VECTORIZED_PART Eigen::Vector2d plane_gradient(const BasisAt& at, const Basis& basis,
                                                        const double* weights,
                                                        BasisAt::Table& over_cos) {
  // Column sums first: their loops run over n, so they vectorise without reordering an addition.
  BasisAt::Table over_slope;
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

/// Σ_n columns[n] along_y[n].
double across_columns(const BasisAt::Table& columns, const BasisAt::Table& along_y, int modes_y) {
  double sum = 0;
  for (int n = 0; n < modes_y; ++n) sum += columns[n] * along_y[n];
  return sum;
}

/// Weights of a plane's modes: what remains of a box's weights at a given z.
using Slab = std::array<double, static_cast<std::size_t>(kMaxModesPerAxis) * kMaxModesPerAxis>;

/// Four doubles, added and multiplied one by one. With many tables the compiler does not vectorise
/// by itself.
using Four [[gnu::vector_size(4 * sizeof(double))]] = double;

/// Sums over l of the modes in kCount values, from the slab's mode `first` on, for each table along
/// z.
template <class Value, int kCount, std::size_t kTables>
ERGOCAST_VECTORIZED_PART void contract_some(
    const std::array<const BasisAt::Table*, kTables>& along_z, const Basis& basis,
    const double* weights, int first, std::array<Slab, kTables>& slabs) {
  constexpr int kWidth = std::is_same_v<Value, double> ? 1 : 4;
  Value sums[kTables][kCount] = {};
  const double* slab = weights + first;
  for (int l = 0; l < basis.modes_z; ++l, slab += basis.modes_x * basis.modes_y) {
    for (int k = 0; k < kCount; ++k) {
      Value value;
      std::memcpy(&value, slab + k * kWidth, sizeof value);
      for (std::size_t i = 0; i < kTables; ++i) sums[i][k] += (*along_z[i])[l] * value;
    }
  }
  for (std::size_t i = 0; i < kTables; ++i) std::memcpy(&slabs[i][first], sums[i], sizeof sums[i]);
}

/// slabs_i(m,n) = Σ_l along_z_i[l] weights(l,m,n).
template <std::size_t kTables>
ERGOCAST_VECTORIZED_PART void contract_z(const std::array<const BasisAt::Table*, kTables>& along_z,
                                         const Basis& basis, const double* weights,
                                         std::array<Slab, kTables>& slabs) {
  const int end = basis.modes_x * basis.modes_y;
  if (end < 8) {
    for (int k = 0; k < end; ++k) contract_some<double, 1>(along_z, basis, weights, k, slabs);
    return;
  }
  // The last stride ends at the last mode, and may overlap the stride before.
  for (int k = 0; k < end; k += 8) {
    contract_some<Four, 2>(along_z, basis, weights, std::min(k, end - 8), slabs);
  }
}

ERGOCAST_VECTORIZED
Eigen::Vector3d gradient_in_space(const BasisAt& at, const Basis& basis, const double* weights) {
  std::array<Slab, 2> slabs;
  contract_z<2>({&at.cos_z, &at.slope_z}, basis, weights, slabs);
  BasisAt::Table over_cos;
  const Eigen::Vector2d in_plane = plane_gradient(at, basis, slabs[0].data(), over_cos);
  plane_gradient(at, basis, slabs[1].data(), over_cos);
  return {in_plane.x(), in_plane.y(), across_columns(over_cos, at.cos_y, basis.modes_y)};
}

/// The field of one slab: the gradient along x and y and its Jacobian.
ERGOCAST_VECTORIZED_PART FieldAt plane_field(const BasisAt& at, const Basis& basis,
                                             const Box& domain, const ColumnSums& over) {
  const double squared = wave_number_squared(domain.size_m.y());
  FieldAt field;
  double xx = 0, xy = 0, yy = 0;
  for (int n = 0; n < basis.modes_y; ++n) {
    field.gradient.x() += over.over_slope[n] * at.cos_y[n];
    field.gradient.y() += over.over_cos[n] * at.slope_y[n];
    xx += over.over_bend[n] * at.cos_y[n];
    xy += over.over_slope[n] * at.slope_y[n];
    yy -= over.over_cos[n] * (squared * n * n * at.cos_y[n]);
  }
  field.hessian.topLeftCorner<2, 2>() << xx, xy, xy, yy;
  return field;
}

ERGOCAST_VECTORIZED
FieldAt field_in_space(const BasisAt& at, const BasisAt::Table& bend, const Basis& basis,
                       const Box& domain, const double* weights) {
  BasisAt::Table bend_z;
  set_bends(at.cos_z, domain.size_m.z(), basis.modes_z, bend_z);
  std::array<Slab, 3> slabs;
  contract_z<3>({&at.cos_z, &at.slope_z, &bend_z}, basis, weights, slabs);
  ColumnSums over;
  sum_columns(at, bend, basis, slabs[0].data(), over);
  FieldAt field = plane_field(at, basis, domain, over);
  const auto across = [&](const BasisAt::Table& columns, const BasisAt::Table& along_y) {
    return across_columns(columns, along_y, basis.modes_y);
  };
  sum_columns(at, bend, basis, slabs[1].data(), over);
  field.gradient.z() = across(over.over_cos, at.cos_y);
  field.hessian(0, 2) = field.hessian(2, 0) = across(over.over_slope, at.cos_y);
  field.hessian(1, 2) = field.hessian(2, 1) = across(over.over_cos, at.slope_y);
  sum_columns(at, bend, basis, slabs[2].data(), over);
  field.hessian(2, 2) = across(over.over_cos, at.cos_y);
  return field;
}

}  // namespace

ERGOCAST_VECTORIZED
Eigen::Vector3d weighted_gradient(const BasisAt& at, const Basis& basis, const double* weights) {
  if (at.free.modes != nullptr) {
    const Eigen::Vector2d gradient = free_field(at.free, weights).gradient;
    return {gradient.x(), gradient.y(), 0};
  }
  if (!basis.planar()) return gradient_in_space(at, basis, weights);
  BasisAt::Table over_cos;
  const Eigen::Vector2d gradient = plane_gradient(at, basis, weights, over_cos);
  return {gradient.x(), gradient.y(), 0};
}

ERGOCAST_VECTORIZED
FieldAt weighted_field(const BasisAt& at, const Basis& basis, const Box& domain,
                       const double* weights) {
  if (at.free.modes != nullptr) {
    const FreeField flat = free_field(at.free, weights);
    FieldAt field;
    field.gradient.head<2>() = flat.gradient;
    field.hessian.topLeftCorner<2, 2>() = flat.hessian;
    return field;
  }
  BasisAt::Table bend;
  set_bends(at.cos_x, domain.size_m.x(), basis.modes_x, bend);
  if (!basis.planar()) return field_in_space(at, bend, basis, domain, weights);
  ColumnSums over;
  sum_columns(at, bend, basis, weights, over);
  return plane_field(at, basis, domain, over);
}

namespace {

/// Calls each(l, m, n, number of the mode) for every mode in the order of the basis.
template <class Each>
void for_every_mode(const Basis& basis, const Each& each) {
  int k = 0;
  for (int l = 0; l < basis.modes_z; ++l) {
    for (int m = 0; m < basis.modes_x; ++m) {
      for (int n = 0; n < basis.modes_y; ++n) each(l, m, n, k++);
    }
  }
}

/// It is 0 for a plane's one mode along z.
double wave_number(int mode, double length_m) {
  return mode == 0 ? 0 : mode * std::numbers::pi / length_m;
}

}  // namespace

Coefficients sobolev_weights(const Basis& basis, const Box& domain) {
  if (const FreeModes* const modes = basis.free_modes()) {
    return free_weights(*modes, basis.sobolev_form == SobolevForm::kSquaredNorm,
                        basis.sobolev_exponent, basis.normalized);
  }
  Coefficients weights(basis.mode_count());
  for_every_mode(basis, [&](int l, int m, int n, int k) {
    const double squared =
        static_cast<double>(m) * m + static_cast<double>(n) * n + static_cast<double>(l) * l;
    const double base =
        1 + (basis.sobolev_form == SobolevForm::kSquaredNorm ? squared : std::sqrt(squared));
    const double h_squared = basis.normalized ? domain.content() * half_unless_zero(m) *
                                                    half_unless_zero(n) * half_unless_zero(l)
                                              : 1.0;
    weights[k] = portable::pow(base, -basis.sobolev_exponent) / h_squared;
  });
  return weights;
}

Coefficients gradient_energies(const Basis& basis, const Box& domain) {
  Coefficients energies(basis.mode_count());
  if (const FreeModes* const modes = basis.free_modes()) {
    for (int k = 0; k < modes->mode_count; ++k) {
      const auto mode = static_cast<std::size_t>(k);
      energies[k] = modes->eigenvalues_per_m2[mode] * modes->mean_squares[mode];
    }
    return energies;
  }
  for_every_mode(basis, [&](int l, int m, int n, int k) {
    const double kx = wave_number(m, domain.size_m.x());
    const double ky = wave_number(n, domain.size_m.y());
    const double kz = wave_number(l, domain.size_m.z());
    const double along_x = half_unless_zero(m), along_y = half_unless_zero(n);
    const double along_z = half_unless_zero(l);
    energies[k] = 0.5 * (kx * kx * along_y * along_z + ky * ky * along_x * along_z +
                         kz * kz * along_x * along_y);
  });
  return energies;
}

double ergodic_metric(const Coefficients& coverage, const Coefficients& target,
                      const Coefficients& weights) {
  double metric = 0;
  for (Eigen::Index k = 0; k < weights.size(); ++k) {
    const double residual = coverage[k] - target[k];
    metric += weights[k] * residual * residual;
  }
  return metric;
}

}  // namespace ergocast
