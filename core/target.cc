#include "core/target.h"

#include <algorithm>
#include <Eigen/LU>
#include <cmath>
#include <numbers>

#include "core/require.h"

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
// A bell is below 1e-16 of its peak nine standard deviations away.
constexpr double kReach = 9;

struct Interval {
  double low = 0, high = 0;
  double length() const { return high - low; }
};

/// The part of [low, low + length] that a bell reaches.
Interval reached(double mean, double deviation, double low, double length) {
  const double high = low + length;
  return {std::clamp(mean - kReach * deviation, low, high),
          std::clamp(mean + kReach * deviation, low, high)};
}

/// Panels that resolve both the bell and the fastest cosine to rounding.
int panels_for(const Interval& over, double deviation, int modes, double length) {
  const double wavelength = 2 * length / std::max(1, modes - 1);
  return std::clamp(static_cast<int>(std::ceil(over.length() / std::min(deviation, wavelength))),
                    1, 4096) * 2;
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

double bell(const Gaussian& g, const Eigen::Matrix2d& precision, const Eigen::Vector2d& x_m) {
  const Eigen::Vector2d d = x_m - g.mean_m;
  return std::exp(-0.5 * d.dot(precision * d)) /
         (2 * std::numbers::pi * std::sqrt(g.covariance_m2.determinant()));
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

Coefficients correlated_at(const Gaussian& g, const Rectangle& domain, const Basis& basis,
                           int panels) {
  const Interval over_x = reached(g.mean_m.x(), std::sqrt(g.covariance_m2(0, 0)),
                                  domain.origin_m.x(), domain.size_m.x());
  const Interval over_y = reached(g.mean_m.y(), std::sqrt(g.covariance_m2(1, 1)),
                                  domain.origin_m.y(), domain.size_m.y());
  const Rule x = panel_rule(over_x, panels), y = panel_rule(over_y, panels);
  const Eigen::Matrix2d precision = g.covariance_m2.inverse();
  Eigen::MatrixXd mass(x.x.size(), y.x.size());
  for (Eigen::Index i = 0; i < mass.rows(); ++i) {
    for (Eigen::Index j = 0; j < mass.cols(); ++j) {
      mass(i, j) = x.weight[i] * y.weight[j] * bell(g, precision, {x.x[i], y.x[j]});
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
    Coefficients finer = correlated_at(g, domain, basis, panels);
    result.error_bound = (finer - result.values).cwiseAbs().maxCoeff();
    result.values = std::move(finer);
  }
  return result;
}

TargetCoefficients gaussian_coefficients(const Gaussian& g, const Rectangle& domain,
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

TargetCoefficients unscaled(const TargetDensity& target, const Rectangle& domain,
                            const Basis& basis) {
  TargetCoefficients sum{Coefficients::Zero(basis.modes_x, basis.modes_y), 0};
  sum.values(0, 0) = target.uniform_weight;
  for (const Gaussian& g : target.gaussians) {
    const TargetCoefficients part = gaussian_coefficients(g, domain, basis);
    sum.values += g.weight * part.values;
    sum.error_bound += g.weight * part.error_bound;
  }
  return sum;
}

}  // namespace

TargetCoefficients target_coefficients(const TargetDensity& target, const Rectangle& domain,
                                       const Basis& basis) {
  TargetCoefficients result = unscaled(target, domain, basis);
  const double mass = result.values(0, 0);
  ERGOCAST_REQUIRE(mass > 0);
  result.values /= mass;
  result.error_bound *= 2 / mass;
  return result;
}

double mass_inside(const TargetDensity& target, const Rectangle& domain) {
  return unscaled(target, domain, Basis{}).values(0, 0);
}

double density_unscaled(const TargetDensity& target, const Rectangle& domain,
                        const Eigen::Vector2d& x_m) {
  double density = target.uniform_weight / (domain.size_m.x() * domain.size_m.y());
  for (const Gaussian& g : target.gaussians) {
    density += g.weight * bell(g, g.covariance_m2.inverse(), x_m);
  }
  return density;
}

}  // namespace ergocast
