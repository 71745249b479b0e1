// SPDX-License-Identifier: BSD-3-Clause
// The cosine basis (2) on a rectangle, its gradient, and the weights that compare coefficients.
//
// Equation numbers are those of Lee & Martinez, "Breaking Symmetry-Induced Degeneracy in
// Multi-Agent Ergodic Coverage via Stochastic Spectral Control".
#pragma once

#include <Eigen/Core>
#include <array>

#include "core/geometry.h"
#include "core/ids.h"

namespace ergocast {

/// One number per mode, modes_x × modes_y; row m, column n belongs to f_mn. Row-major, so that
/// data()[m · modes_y + n] is the order of the wire.
using Coefficients = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

enum class SobolevForm {
  kSquaredNorm,  ///< λ = (1 + |k|²)^−s
  kNorm,         ///< λ = (1 + |k|)^−s
};

/// Which modes are used and how they are weighed; |k|² = m² + n².
struct Basis {
  int modes_x = 1;
  int modes_y = 1;
  SobolevForm sobolev_form = SobolevForm::kSquaredNorm;
  double sobolev_exponent = 1.5;
  /// Whether f is divided by h_k = sqrt(Π L_i · (1/2)^[k_i > 0]) where coefficients are compared.
  bool normalized = false;

  int mode_count() const { return modes_x * modes_y; }
};

/// Cosines of every mode along both axes at one point: all that f needs.
struct CosinesAt {
  using Table = std::array<double, kMaxModesPerAxis>;
  Table cos_x, cos_y;  ///< cos(mπx/Lx), cos(nπy/Ly)

  /// @pre x_m is finite; up to kMaxModesPerAxis modes an axis.
  /// Outside the domain f continues, even about each edge and periodic.
  /// By recurrence from one cosine and sine an axis: |cos| may exceed 1 by about 1e-15 · modes.
  CosinesAt(const Eigen::Vector2d& x_m, const Rectangle& domain, const Basis& basis);

 protected:
  CosinesAt() = default;
};

/// With their derivatives: all that f and ∇f need.
struct BasisAt : CosinesAt {
  Table slope_x, slope_y;  ///< −(mπ/Lx) sin(mπx/Lx) …  [1/m]

  /// @pre as for CosinesAt, whose bits it has.
  BasisAt(const Eigen::Vector2d& x_m, const Rectangle& domain, const Basis& basis);
};

/// f_mn(x) of every mode, (2): not divided by h_k.
Coefficients basis_values(const Eigen::Vector2d& x_m, const Rectangle& domain, const Basis& basis);

/// sums(m,n) = f_mn · dt_s. `sums` points to mode_count() doubles.
void set_basis(const CosinesAt& at, const Basis& basis, double dt_s, double* sums);

/// sums(m,n) += f_mn · dt_s, for the running sums of (4). `sums` points to mode_count() doubles.
void accumulate_basis(const CosinesAt& at, const Basis& basis, double dt_s, double* sums);

/// Σ_mn weights(m,n) ∇f_mn: (6) when weights are λ_mn (c_mn − μ_mn) [unit of weights per metre].
/// `weights` points to mode_count() doubles. The order of the sum is the same on every processor.
Eigen::Vector2d weighted_gradient(const BasisAt& at, const Basis& basis, const double* weights);

/// weighted_gradient() and its Jacobian, Σ_mn weights(m,n) ∂²f_mn [its unit per metre].
struct FieldAt {
  Eigen::Vector2d gradient{0, 0};                        ///< bit for bit weighted_gradient()
  Eigen::Matrix2d hessian = Eigen::Matrix2d::Zero();     ///< symmetric
};
FieldAt weighted_field(const BasisAt& at, const Basis& basis, const Rectangle& domain,
                       const double* weights);

/// λ_mn, divided by h_mn² where the basis is normalised: the one weight of both φ² and (6).
Coefficients sobolev_weights(const Basis& basis, const Rectangle& domain);

/// g_mn with  mean over the domain of ‖Σ a_mn ∇f_mn‖² = Σ a_mn² g_mn  (Parseval) [1/m²]:
/// [(mπ/Lx)² η_n + (nπ/Ly)² η_m] / 2, η_0 = 1, else ½.
Coefficients gradient_energies(const Basis& basis, const Rectangle& domain);

/// φ² = Σ λ_k (c_k − μ_k)² / h_k², `weights` as sobolev_weights() gives them.
double ergodic_metric(const Coefficients& coverage, const Coefficients& target,
                      const Coefficients& weights);

}  // namespace ergocast
