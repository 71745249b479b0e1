// SPDX-License-Identifier: BSD-3-Clause
// The cosine basis (2) on a box, its gradient, and the weights that compare coefficients. In a
// plane with walls the modes of the free domain (core/basis/free_modes.h) can take the cosines'
// place. Then f is e_k of that table, which has the same bounds as cosines, and `domain` is not
// read.
//
// Places have three coordinates. A plane has one mode along z, f_lmn = f_mn for l = 0, and its
// numbers are bit for bit those of the two-dimensional sums.
//
// Equation numbers are those of Lee & Martinez, "Breaking Symmetry-Induced Degeneracy in
// Multi-Agent Ergodic Coverage via Stochastic Spectral Control".
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>

#include "core/base/geometry.h"
#include "core/base/ids.h"
#include "core/basis/free_modes.h"

namespace ergocast {

/// One number per mode in the order of the basis: f_lmn at (l · modes_x + m) · modes_y + n, where l
/// counts half waves along z, m along x and n along y.
using Coefficients = Eigen::VectorXd;

/// Numbers of a plane's modes; row m, column n belongs to f_mn.
using PlaneCoefficients = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

enum class SobolevForm {
  kSquaredNorm,  ///< λ = (1 + |k|²)^−s
  kNorm,         ///< λ = (1 + |k|)^−s
};

/// Which modes are used and how they are weighed; |k|² = l² + m² + n².
struct Basis {
  int modes_x = 1;
  int modes_y = 1;
  int modes_z = 1;  ///< 1 in a plane
  SobolevForm sobolev_form = SobolevForm::kSquaredNorm;
  double sobolev_exponent = 1.5;
  /// Whether f is divided by h_k = sqrt(Π L_i · (1/2)^[k_i > 0]) where coefficients are compared;
  /// the product is over x and y in a plane.
  bool normalized = false;
  /// Whether the modes_x · modes_y lowest modes of the free domain are used, by ascending ν.
  bool free_domain = false;
  std::uint64_t table_hash = 0;  ///< hash of their table, else 0
  /// The table of that hash. A plan does not contain it; it is null until it has been provided.
  std::shared_ptr<const FreeModes> table = nullptr;

  int mode_count() const { return modes_x * modes_y * modes_z; }
  bool planar() const { return modes_z == 1; }
  /// The table; null for cosines. @pre a free domain's table has been provided
  const FreeModes* free_modes() const;
};

/// The numbers of the modes l = 0 as a matrix: in a plane all of them.
inline Eigen::Map<const PlaneCoefficients> in_plane(const Coefficients& coefficients,
                                                    const Basis& basis) {
  return {coefficients.data(), basis.modes_x, basis.modes_y};
}
inline Eigen::Map<PlaneCoefficients> in_plane(Coefficients& coefficients, const Basis& basis) {
  return {coefficients.data(), basis.modes_x, basis.modes_y};
}
/// A plane's numbers in the order of the basis.
inline Coefficients in_basis_order(const PlaneCoefficients& coefficients) {
  return coefficients.reshaped<Eigen::RowMajor>();
}

/// Cosines of every mode along each axis at one point, or the place in the table: all that f needs.
struct CosinesAt {
  using Table = std::array<double, kMaxModesPerAxis>;
  FreePlace free;             ///< if it has modes, the cosines are not set
  Table cos_x, cos_y, cos_z;  ///< cos(mπx/Lx), cos(nπy/Ly), cos(lπz/Lz); {1} for one mode

  /// @pre x_m is finite; up to kMaxModesPerAxis modes an axis, one along z if the domain is a
  /// plane. Outside the domain f continues, even about each side and periodic. By recurrence from
  /// one cosine and sine an axis: |cos| may exceed 1 by about 1e-15 · modes.
  CosinesAt(const Eigen::Vector3d& x_m, const Box& domain, const Basis& basis);

 protected:
  CosinesAt() = default;
};

/// The cosines and their derivatives: all that f and ∇f need.
struct BasisAt : CosinesAt {
  Table slope_x, slope_y, slope_z;  ///< −(mπ/Lx) sin(mπx/Lx) …  [1/m]; {0} for one mode

  /// @pre as for CosinesAt; the cosines are bit for bit the same.
  BasisAt(const Eigen::Vector3d& x_m, const Box& domain, const Basis& basis);
};

/// f_lmn(x) of every mode, (2): not divided by h_k.
Coefficients basis_values(const Eigen::Vector3d& x_m, const Box& domain, const Basis& basis);

/// sums(l,m,n) = f_lmn · dt_s. `sums` points to mode_count() doubles.
void set_basis(const CosinesAt& at, const Basis& basis, double dt_s, double* sums);

/// sums(l,m,n) += f_lmn · dt_s, for the running sums of (4). `sums` points to mode_count() doubles.
void accumulate_basis(const CosinesAt& at, const Basis& basis, double dt_s, double* sums);

/// sums(l,m,n) += share(l,m,n) · (f_lmn · dt_s). Both point to mode_count() doubles.
void accumulate_basis(const CosinesAt& at, const Basis& basis, double dt_s, const double* share,
                      double* sums);

/// Σ weights(l,m,n) ∇f_lmn: (6) when weights are λ_k (c_k − μ_k) [unit of weights per metre].
/// `weights` points to mode_count() doubles. The order of the sum is the same on every processor.
/// In a plane the part along z is 0.
Eigen::Vector3d weighted_gradient(const BasisAt& at, const Basis& basis, const double* weights);

/// weighted_gradient() and its Jacobian, Σ weights(l,m,n) ∂²f_lmn [its unit per metre].
struct FieldAt {
  Eigen::Vector3d gradient{0, 0, 0};                  ///< bit for bit weighted_gradient()
  Eigen::Matrix3d hessian = Eigen::Matrix3d::Zero();  ///< symmetric; in a plane 0 along z
};
FieldAt weighted_field(const BasisAt& at, const Basis& basis, const Box& domain,
                       const double* weights);

/// λ_k, divided by h_k² where the basis is normalised: the one weight of both φ² and (6). In a free
/// domain free_weights().
Coefficients sobolev_weights(const Basis& basis, const Box& domain);

/// g_k with  mean over the domain of ‖Σ a_k ∇f_k‖² = Σ a_k² g_k  (Parseval) [1/m²]:
/// [(mπ/Lx)² η_n η_l + (nπ/Ly)² η_m η_l + (lπ/Lz)² η_m η_n] / 2, η_0 = 1, else ½. In a free domain
/// ν_k times the mean square of e_k, over the free cells.
Coefficients gradient_energies(const Basis& basis, const Box& domain);

/// φ² = Σ λ_k (c_k − μ_k)² / h_k², `weights` as sobolev_weights() gives them.
double ergodic_metric(const Coefficients& coverage, const Coefficients& target,
                      const Coefficients& weights);

}  // namespace ergocast
