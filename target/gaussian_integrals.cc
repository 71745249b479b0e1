// SPDX-License-Identifier: BSD-3-Clause
// A separable Gaussian takes one integral for each axis; a correlated or cut one takes rules in
// two dimensions.
#include "target/gaussian_integrals.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace ergocast {
namespace {

// Eight-point Gauss–Legendre rule on [−1, 1].
constexpr int kNodes = 8;
constexpr double kNode[kNodes] = {-0.9602898564975363, -0.7966664774136267, -0.5255324099163290,
                                  -0.1834346424956498, 0.1834346424956498,  0.5255324099163290,
                                  0.7966664774136267,  0.9602898564975363};
constexpr double kWeight[kNodes] = {0.1012285362903763, 0.2223810344533745, 0.3137066458778873,
                                    0.3626837833783620, 0.3626837833783620, 0.3137066458778873,
                                    0.2223810344533745, 0.1012285362903763};
// A Gaussian is below 1e-16 of its peak at nine standard deviations.
constexpr double kReach = 9;

struct Interval {
  double low = 0, high = 0;
  double length() const { return high - low; }
};

/// The part of [low, low + length] where the Gaussian is not negligible.
Interval reached(double mean, double deviation, double low, double length) {
  const double high = low + length;
  return {std::clamp(mean - kReach * deviation, low, high),
          std::clamp(mean + kReach * deviation, low, high)};
}

/// The number of panels that resolves both the Gaussian and the fastest cosine to rounding.
int panels_for(const Interval& over, double deviation, int modes, double length) {
  const double wavelength = 2 * length / std::max(1, modes - 1);
  return std::clamp(static_cast<int>(std::ceil(over.length() / std::min(deviation, wavelength))), 1,
                    4096) *
         2;
}

/// ∫ cos(mπ(x − low)/length) N(x; mean, deviation²) dx over the domain's side, m = 0 … modes − 1.
Eigen::VectorXd integrals_along(double mean, double deviation, double low, double length,
                                int modes) {
  Eigen::VectorXd result = Eigen::VectorXd::Zero(modes);
  const Interval over = reached(mean, deviation, low, length);
  const int panels = panels_for(over, deviation, modes, length);
  const double half = 0.5 * over.length() / panels;
  const double scale = 1 / (deviation * std::sqrt(2 * std::numbers::pi));
  for (int panel = 0; panel < panels; ++panel) {
    for (int i = 0; i < kNodes; ++i) {
      const double x = over.low + half * (2 * panel + 1 + kNode[i]);
      const double z = (x - mean) / deviation;
      const double mass = half * kWeight[i] * scale * std::exp(-0.5 * z * z);
      const double angle = std::numbers::pi * (x - low) / length;
      for (int m = 0; m < modes; ++m) result[m] += mass * std::cos(m * angle);
    }
  }
  return result;
}

Eigen::MatrixXd cosines_at(const Eigen::VectorXd& x, double low, double length, int modes) {
  Eigen::MatrixXd table(modes, x.size());
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    for (int m = 0; m < modes; ++m) {
      table(m, i) = std::cos(m * std::numbers::pi * (x[i] - low) / length);
    }
  }
  return table;
}

struct Rule {
  Eigen::VectorXd x, weight;
};

Rule panel_rule(const Interval& over, int panels) {
  Rule rule{Eigen::VectorXd(panels * kNodes), Eigen::VectorXd(panels * kNodes)};
  const double half = 0.5 * over.length() / panels;
  for (int panel = 0; panel < panels; ++panel) {
    for (int i = 0; i < kNodes; ++i) {
      rule.x[panel * kNodes + i] = over.low + half * (2 * panel + 1 + kNode[i]);
      rule.weight[panel * kNodes + i] = half * kWeight[i];
    }
  }
  return rule;
}

PlaneCoefficients correlated_at(const Gaussian& g, const Rectangle& domain, const Basis& basis,
                                int panels) {
  const Interval over_x = reached(g.mean_m.x(), std::sqrt(g.covariance_m2(0, 0)),
                                  domain.origin_m.x(), domain.size_m.x());
  const Interval over_y = reached(g.mean_m.y(), std::sqrt(g.covariance_m2(1, 1)),
                                  domain.origin_m.y(), domain.size_m.y());
  const Rule x = panel_rule(over_x, panels), y = panel_rule(over_y, panels);
  const GaussianDensity density(g);
  Eigen::MatrixXd mass(x.x.size(), y.x.size());
  for (Eigen::Index i = 0; i < mass.rows(); ++i) {
    for (Eigen::Index j = 0; j < mass.cols(); ++j) {
      mass(i, j) = x.weight[i] * y.weight[j] * density({x.x[i], y.x[j]});
    }
  }
  return cosines_at(x.x, domain.origin_m.x(), domain.size_m.x(), basis.modes_x) * mass *
         cosines_at(y.x, domain.origin_m.y(), domain.size_m.y(), basis.modes_y).transpose();
}

TargetCoefficients correlated(const Gaussian& g, const Rectangle& domain, const Basis& basis) {
  constexpr int kMaxPanels = 128;
  constexpr double kTolerance = 1e-12;
  int panels = 8;
  TargetCoefficients result{correlated_at(g, domain, basis, panels), 1};
  while (result.error_bound > kTolerance && panels < kMaxPanels) {
    panels *= 2;
    PlaneCoefficients finer = correlated_at(g, domain, basis, panels);
    result.error_bound = (finer - result.values).cwiseAbs().maxCoeff();
    result.values = std::move(finer);
  }
  return result;
}

/// The Gaussian at one y: its marginal density there and its conditional density along x.
class AcrossAt {
 public:
  AcrossAt(const Gaussian& g, const Eigen::Vector2d& mean_m)
      : mean_m_(mean_m),
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
    return reached(mean_m_.y(), deviation_y_, low, high - low);
  }
  Interval reached_x(double y, double low, double high) const {
    return reached(mean_x(y), deviation_x_, low, high - low);
  }
  double deviation_x() const { return deviation_x_; }

  /// The length in y over which the mass between two sides of these slopes changes.
  double scale_y(double left_slope, double right_slope) const {
    const double steepest = std::max(std::abs(left_slope - slope_), std::abs(right_slope - slope_));
    return std::min(deviation_y_, deviation_x_ / steepest);
  }

 private:
  static double normal(double z) {
    return std::exp(-0.5 * z * z) / std::sqrt(2 * std::numbers::pi);
  }
  double mean_x(double y) const { return mean_m_.x() + slope_ * (y - mean_m_.y()); }

  Eigen::Vector2d mean_m_;
  double deviation_y_, slope_, deviation_x_;
};

/// sums[k] += mass · cos(k·angle), by recurrence.
void add_cosines(double mass, double angle, Eigen::VectorXd& sums) {
  const double first_cos = std::cos(angle), first_sin = std::sin(angle);
  double c = mass, s = 0;
  for (double& sum : sums) {
    sum += c;
    const double next = c * first_cos - s * first_sin;
    s = s * first_cos + c * first_sin;
    c = next;
  }
}

/// Panels of at most `scale` on `over`, times `refinement`.
Rule panels_on(const Interval& over, double scale, int refinement) {
  constexpr double kMostPanels = 4096;
  const double panels = std::clamp(std::ceil(over.length() / scale), 1.0, kMostPanels);
  return panel_rule(over, static_cast<int>(panels) * refinement);
}

void add_piece(const AcrossAt& across, const Trapezoid& piece, const Rectangle& domain,
               int refinement, PlaneCoefficients& sums) {
  const Interval over_y = across.reached_y(piece.low, piece.high);
  if (!(over_y.length() > 0)) return;
  const Eigen::Vector2d wave = std::numbers::pi * domain.size_m.cwiseInverse();
  const auto scale = [](double bell, double wave_number, Eigen::Index modes) {
    const double fastest = wave_number * static_cast<double>(std::max<Eigen::Index>(1, modes - 1));
    return std::min(bell, 2 * std::numbers::pi / fastest);
  };
  const double height = piece.high - piece.low;
  const double change_y = across.scale_y((piece.left_high - piece.left_low) / height,
                                         (piece.right_high - piece.right_low) / height);
  const double scale_x = scale(across.deviation_x(), wave.x(), sums.rows());
  const Rule y = panels_on(over_y, scale(change_y, wave.y(), sums.cols()), refinement);
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

PlaneCoefficients over_pieces(const Gaussian& g, std::span<const Trapezoid> pieces,
                              const Rectangle& domain, const Basis& basis, int refinement) {
  const AcrossAt across(g, g.mean_m - domain.origin_m);
  PlaneCoefficients sums = PlaneCoefficients::Zero(basis.modes_x, basis.modes_y);
  for (const Trapezoid& piece : pieces) add_piece(across, piece, domain, refinement, sums);
  return sums;
}

}  // namespace

GaussianDensity::GaussianDensity(const Gaussian& g)
    : mean_m_(g.mean_m),
      precision_(g.covariance_m2.inverse()),
      scale_(2 * std::numbers::pi * std::sqrt(g.covariance_m2.determinant())) {}

double GaussianDensity::operator()(const Eigen::Vector2d& x_m) const {
  const Eigen::Vector2d d = x_m - mean_m_;
  return std::exp(-0.5 * d.dot(precision_ * d)) / scale_;
}

TargetCoefficients integrals_over(const Gaussian& g, std::span<const Trapezoid> pieces,
                                  const Rectangle& domain, const Basis& basis) {
  constexpr int kMostRefined = 8;
  constexpr double kTolerance = 1e-12;
  int refinement = 1;
  TargetCoefficients result{over_pieces(g, pieces, domain, basis, refinement), 1};
  while (result.error_bound > kTolerance && refinement < kMostRefined) {
    refinement *= 2;
    PlaneCoefficients finer = over_pieces(g, pieces, domain, basis, refinement);
    // The rules' agreement says nothing of the rounding that they share.
    result.error_bound = (finer - result.values).cwiseAbs().maxCoeff() + 1e-14;
    result.values = std::move(finer);
  }
  return result;
}

TargetCoefficients integrals_over_domain(const Gaussian& g, const Rectangle& domain,
                                         const Basis& basis) {
  if (g.covariance_m2(0, 1) != 0) return correlated(g, domain, basis);
  const Eigen::VectorXd along_x =
      integrals_along(g.mean_m.x(), std::sqrt(g.covariance_m2(0, 0)), domain.origin_m.x(),
                      domain.size_m.x(), basis.modes_x);
  const Eigen::VectorXd along_y =
      integrals_along(g.mean_m.y(), std::sqrt(g.covariance_m2(1, 1)), domain.origin_m.y(),
                      domain.size_m.y(), basis.modes_y);
  return {along_x * along_y.transpose(), 1e-14};
}

}  // namespace ergocast
