// SPDX-License-Identifier: BSD-3-Clause
// A separable Gaussian takes one integral for each axis; a correlated or cut one takes rules in
// two dimensions.
#include "target/gaussian_integrals.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/ordered_product.h"
#include "core/base/portable_math.h"
#include "target/panels.h"

namespace ergocast {
namespace {

Eigen::MatrixXd cosines_at(const Eigen::VectorXd& x, double length, int modes) {
  Eigen::MatrixXd table(modes, x.size());
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    for (int m = 0; m < modes; ++m) {
      table(m, i) = portable::cos(m * std::numbers::pi * x[i] / length);
    }
  }
  return table;
}

PlaneCoefficients correlated_at(const PlaneGaussian& g, const Eigen::Vector2d& size_m,
                                const Basis& basis, int panels) {
  const Interval over_x = reached(g.mean_m.x(), std::sqrt(g.covariance_m2(0, 0)), {0, size_m.x()});
  const Interval over_y = reached(g.mean_m.y(), std::sqrt(g.covariance_m2(1, 1)), {0, size_m.y()});
  const Rule x = panel_rule(over_x, panels), y = panel_rule(over_y, panels);
  const GaussianDensity density(g);
  Eigen::MatrixXd mass(x.x.size(), y.x.size());
  for (Eigen::Index i = 0; i < mass.rows(); ++i) {
    for (Eigen::Index j = 0; j < mass.cols(); ++j) {
      mass(i, j) = x.weight[i] * y.weight[j] * density({x.x[i], y.x[j]});
    }
  }
  return ordered_product(ordered_product(cosines_at(x.x, size_m.x(), basis.modes_x), mass),
                         cosines_at(y.x, size_m.y(), basis.modes_y).transpose());
}

PlaneIntegrals correlated(const PlaneGaussian& g, const Eigen::Vector2d& size_m,
                          const Basis& basis) {
  constexpr int kMaxPanels = 128;
  constexpr double kTolerance = 1e-12;
  int panels = 8;
  PlaneIntegrals result{correlated_at(g, size_m, basis, panels), 1};
  while (result.error_bound > kTolerance && panels < kMaxPanels) {
    panels *= 2;
    PlaneCoefficients finer = correlated_at(g, size_m, basis, panels);
    result.error_bound = (finer - result.values).cwiseAbs().maxCoeff();
    result.values = std::move(finer);
  }
  return result;
}

/// The Gaussian at one y: its marginal density there and its conditional density along x.
class AcrossAt {
 public:
  explicit AcrossAt(const PlaneGaussian& g)
      : mean_m_(g.mean_m),
        deviation_y_(std::sqrt(g.covariance_m2(1, 1))),
        slope_(g.covariance_m2(0, 1) / g.covariance_m2(1, 1)),
        deviation_x_(std::sqrt(g.covariance_m2.determinant() / g.covariance_m2(1, 1))) {}

  double density_y(double y) const {
    return normal((y - mean_m_.y()) / deviation_y_) / deviation_y_;
  }
  double density_x(double x, double y) const {
    return normal((x - mean_x(y)) / deviation_x_) / deviation_x_;
  }
  Interval reached_y(double low, double high) const {
    return reached(mean_m_.y(), deviation_y_, {low, high});
  }
  Interval reached_x(double y, double low, double high) const {
    return reached(mean_x(y), deviation_x_, {low, high});
  }
  double deviation_x() const { return deviation_x_; }

  /// The length in y over which the mass between two sides of these slopes changes.
  double scale_y(double left_slope, double right_slope) const {
    const double steepest = std::max(std::abs(left_slope - slope_), std::abs(right_slope - slope_));
    return std::min(deviation_y_, deviation_x_ / steepest);
  }

 private:
  static double normal(double z) {
    return portable::exp(-0.5 * z * z) / std::sqrt(2 * std::numbers::pi);
  }
  double mean_x(double y) const { return mean_m_.x() + slope_ * (y - mean_m_.y()); }

  Eigen::Vector2d mean_m_;
  double deviation_y_, slope_, deviation_x_;
};

void add_piece(const AcrossAt& across, const Trapezoid& piece, const Eigen::Vector2d& size_m,
               int refinement, double width, PlaneCoefficients& sums) {
  const Interval over_y = across.reached_y(piece.low, piece.high);
  if (!(over_y.length() > 0)) return;
  const Eigen::Vector2d wave = std::numbers::pi * size_m.cwiseInverse();
  const double height = piece.high - piece.low;
  const double change_y = across.scale_y((piece.left_high - piece.left_low) / height,
                                         (piece.right_high - piece.right_low) / height);
  const double scale_x = panel_scale(width * across.deviation_x(), wave.x(), sums.rows());
  const double scale_y = panel_scale(width * change_y, wave.y(), sums.cols());
  const Rule y = panels_on(over_y, scale_y, refinement);
  Eigen::VectorXd row(sums.rows()), column(sums.cols());
  for (Eigen::Index j = 0; j < y.x.size(); ++j) {
    const Trapezoid line = piece.between(y.x[j], y.x[j]);
    const Interval over_x = across.reached_x(y.x[j], line.left_low, line.right_low);
    if (!(over_x.length() > 0)) continue;
    const Rule x = panels_on(over_x, scale_x, refinement);
    row.setZero();
    for (Eigen::Index i = 0; i < x.x.size(); ++i) {
      add_cosines(x.weight[i] * across.density_x(x.x[i], y.x[j]), wave.x() * x.x[i], row);
    }
    column.setZero();
    add_cosines(y.weight[j] * across.density_y(y.x[j]), wave.y() * y.x[j], column);
    sums += row * column.transpose();
  }
}

}  // namespace

GaussianDensity::GaussianDensity(const PlaneGaussian& g)
    : mean_m_(g.mean_m),
      precision_(g.covariance_m2.inverse()),
      scale_(2 * std::numbers::pi * std::sqrt(g.covariance_m2.determinant())) {}

double GaussianDensity::operator()(const Eigen::Vector2d& x_m) const {
  const Eigen::Vector2d d = x_m - mean_m_;
  return portable::exp(-0.5 * d.dot(precision_ * d)) / scale_;
}

PlaneCoefficients integrals_by(const PlaneGaussian& g, std::span<const Trapezoid> pieces,
                               const Eigen::Vector2d& size_m, const Basis& basis, int refinement,
                               double width) {
  const AcrossAt across(g);
  PlaneCoefficients sums = PlaneCoefficients::Zero(basis.modes_x, basis.modes_y);
  for (const Trapezoid& piece : pieces) add_piece(across, piece, size_m, refinement, width, sums);
  return sums;
}

PlaneIntegrals integrals_over(const PlaneGaussian& g, std::span<const Trapezoid> pieces,
                              const Eigen::Vector2d& size_m, const Basis& basis) {
  constexpr int kMostRefined = 8;
  constexpr double kTolerance = 1e-12;
  int refinement = 1;
  PlaneIntegrals result{integrals_by(g, pieces, size_m, basis, refinement), 1};
  while (result.error_bound > kTolerance && refinement < kMostRefined) {
    refinement *= 2;
    PlaneCoefficients finer = integrals_by(g, pieces, size_m, basis, refinement);
    // The agreement of the rules does not show the rounding that they share.
    result.error_bound = (finer - result.values).cwiseAbs().maxCoeff() + 1e-14;
    result.values = std::move(finer);
  }
  return result;
}

PlaneIntegrals integrals_over_domain(const PlaneGaussian& g, const Eigen::Vector2d& size_m,
                                     const Basis& basis) {
  if (g.covariance_m2(0, 1) != 0) return correlated(g, size_m, basis);
  const auto along = [&](int axis, int modes) {
    return integrals_along(g.mean_m[axis], std::sqrt(g.covariance_m2(axis, axis)),
                           {0, size_m[axis]}, size_m[axis], modes);
  };
  const Eigen::VectorXd along_x = along(0, basis.modes_x), along_y = along(1, basis.modes_y);
  return {along_x * along_y.transpose(), 1e-14};
}

}  // namespace ergocast
