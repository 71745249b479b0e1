// SPDX-License-Identifier: BSD-3-Clause
// A product of matrices whose sums have the same order on every processor.
//
// Eigen's own divides long sums by the sizes of the caches, and fuses multiply and add on arm64.
#pragma once

#include <Eigen/Core>

namespace ergocast {

/// A·B; each number is Σ_k A_ik B_kj by ascending k.
template <class A, class B>
Eigen::MatrixXd ordered_product(const Eigen::MatrixBase<A>& a, const Eigen::MatrixBase<B>& b) {
  Eigen::MatrixXd product = Eigen::MatrixXd::Zero(a.rows(), b.cols());
  for (Eigen::Index j = 0; j < b.cols(); ++j)
    for (Eigen::Index k = 0; k < b.rows(); ++k) product.col(j) += a.col(k) * b(k, j);
  return product;
}

}  // namespace ergocast
