// SPDX-License-Identifier: BSD-3-Clause
// Lays equal panels of one rule side by side.
#include "target/panels.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/portable_math.h"

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

/// The number of panels that resolves both the Gaussian and the fastest cosine to rounding.
int panels_for(const Interval& over, double deviation, int modes, double length) {
  const double wavelength = 2 * length / std::max(1, modes - 1);
  return std::clamp(static_cast<int>(std::ceil(over.length() / std::min(deviation, wavelength))), 1,
                    4096) *
         2;
}

}  // namespace

Interval reached(double mean, double deviation, const Interval& side) {
  return {std::clamp(mean - kReach * deviation, side.low, side.high),
          std::clamp(mean + kReach * deviation, side.low, side.high)};
}

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

Rule panels_on(const Interval& over, double scale, int refinement) {
  constexpr double kMostPanels = 4096;
  const double panels = std::clamp(std::ceil(over.length() / scale), 1.0, kMostPanels);
  return panel_rule(over, static_cast<int>(panels) * refinement);
}

double panel_scale(double bell, double wave, Eigen::Index modes) {
  const double fastest = wave * static_cast<double>(std::max<Eigen::Index>(1, modes - 1));
  return std::min(bell, 2 * std::numbers::pi / fastest);
}

void add_cosines(double mass, double angle, Eigen::VectorXd& sums) {
  const double first_cos = portable::cos(angle), first_sin = portable::sin(angle);
  double c = mass, s = 0;
  for (double& sum : sums) {
    sum += c;
    const double next = c * first_cos - s * first_sin;
    s = s * first_cos + c * first_sin;
    c = next;
  }
}

Eigen::VectorXd integrals_along(double mean, double deviation, const Interval& part, double length,
                                int modes) {
  Eigen::VectorXd result = Eigen::VectorXd::Zero(modes);
  const Interval over = reached(mean, deviation, part);
  const int panels = panels_for(over, deviation, modes, length);
  const double half = 0.5 * over.length() / panels;
  const double scale = 1 / (deviation * std::sqrt(2 * std::numbers::pi));
  for (int panel = 0; panel < panels; ++panel) {
    for (int i = 0; i < kNodes; ++i) {
      const double x = over.low + half * (2 * panel + 1 + kNode[i]);
      const double z = (x - mean) / deviation;
      const double mass = half * kWeight[i] * scale * portable::exp(-0.5 * z * z);
      const double angle = std::numbers::pi * x / length;
      for (int m = 0; m < modes; ++m) result[m] += mass * portable::cos(m * angle);
    }
  }
  return result;
}

}  // namespace ergocast
