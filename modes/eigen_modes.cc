// SPDX-License-Identifier: BSD-3-Clause
// Lanczos iterations on the inverse of the shifted Laplacian, by Spectra and Eigen.
#include "modes/eigen_modes.h"

#include <Spectra/SymEigsShiftSolver.h>

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <algorithm>
#include <numbers>
#include <vector>

#include "core/base/require.h"

namespace ergocast {
namespace {

using Sparse = Eigen::SparseMatrix<double>;

/// The Laplacian times the cells' area, so that its entries are of order 1.
Sparse laplacian(const FreeGrid& grid) {
  const double wide_m = grid.size_m.x() / grid.columns, high_m = grid.size_m.y() / grid.rows;
  std::vector<Eigen::Triplet<double>> entries;
  const auto add = [&](const std::vector<std::pair<int, int>>& doors, double weight) {
    for (const auto& [one, other] : doors) {
      entries.emplace_back(one, one, weight);
      entries.emplace_back(other, other, weight);
      entries.emplace_back(one, other, -weight);
      entries.emplace_back(other, one, -weight);
    }
  };
  add(grid.doors_x, high_m / wide_m);
  add(grid.doors_y, wide_m / high_m);
  Sparse matrix(grid.cell_count(), grid.cell_count());
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

/// (A − σ)⁻¹ x, as Spectra asks for it. Its own factorisation takes several times as long.
class ShiftedInverse {
 public:
  using Scalar = double;

  explicit ShiftedInverse(const Sparse& matrix) : matrix_(matrix) {}
  Eigen::Index rows() const { return matrix_.rows(); }
  Eigen::Index cols() const { return matrix_.cols(); }
  void set_shift(double sigma) {
    Sparse identity(matrix_.rows(), matrix_.cols());
    identity.setIdentity();
    factors_.compute(matrix_ - sigma * identity);
    ERGOCAST_REQUIRE(factors_.info() == Eigen::Success);
  }
  void perform_op(const double* x, double* y) const {
    Eigen::Map<Eigen::VectorXd>(y, rows()) =
        factors_.solve(Eigen::Map<const Eigen::VectorXd>(x, cols()));
  }

 private:
  const Sparse& matrix_;
  Eigen::SimplicialLDLT<Sparse> factors_;
};

/// An eigenvector's sign is arbitrary: the first of its large entries is above 0.
void settle(Eigen::Ref<Eigen::VectorXd> values) {
  const double largest = values.cwiseAbs().maxCoeff();
  const auto first = std::find_if(values.begin(), values.end(),
                                  [&](double value) { return std::abs(value) > largest / 2; });
  values /= *first > 0 ? largest : -largest;
}

}  // namespace

std::optional<EigenModes> eigen_modes(const FreeGrid& grid, int count) {
  ERGOCAST_REQUIRE(count >= 2 && count <= grid.cell_count() / 4);
  const Sparse matrix = laplacian(grid);
  ShiftedInverse inverse(matrix);
  // Below all eigenvalues, about as far as the second is above the first.
  const double shift = -std::numbers::pi * std::numbers::pi / grid.cell_count();
  Spectra::SymEigsShiftSolver<ShiftedInverse> solver(inverse, count, 2 * count, shift);
  solver.init();
  solver.compute(Spectra::SortRule::LargestMagn, 100, 1e-10, Spectra::SortRule::SmallestAlge);
  if (solver.info() != Spectra::CompInfo::Successful) return std::nullopt;
  const double cell_m2 = grid.size_m.prod() / grid.columns / grid.rows;
  EigenModes modes{solver.eigenvalues() / cell_m2, solver.eigenvectors(count)};
  // Exact, without rounding.
  modes.eigenvalues_per_m2[0] = 0;
  modes.values.col(0).setOnes();
  for (int k = 1; k < count; ++k) settle(modes.values.col(k));
  return modes;
}

}  // namespace ergocast
