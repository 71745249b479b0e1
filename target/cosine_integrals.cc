// SPDX-License-Identifier: BSD-3-Clause
// Turns the integral over a polygon into sums over its edges, with a series where a divisor
// vanishes.
#include "target/cosine_integrals.h"

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/base/portable_math.h"

namespace ergocast {
namespace {

/// sin(z)/z, where `sine` is sin(z) to rounding. A sine near 0 that was computed from two products
/// has no exact digits; there the series is exact.
double sinc(double z, double sine) {
  if (std::abs(z) > 0.1) return sine / z;
  const double z2 = z * z;
  return 1 - z2 / 6 * (1 - z2 / 20 * (1 - z2 / 42 * (1 - z2 / 72)));
}

/// Sines and cosines of k·angle, k = 0 … count − 1.
struct Multiples {
  std::array<double, kMaxModesPerAxis> sine, cosine;

  Multiples(double angle, int count) {
    for (int k = 0; k < count; ++k) {
      sine[k] = portable::sin(k * angle);
      cosine[k] = portable::cos(k * angle);
    }
  }
};

/// Adds the contribution of the edge from `a` to `b` to the integrals around the polygon.
void add_edge(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double density,
              const Eigen::Vector2d& size_m, PlaneCoefficients& sums) {
  const Eigen::Vector2d wave = std::numbers::pi * size_m.cwiseInverse();  // of the first modes
  const Eigen::Vector2d middle = wave.cwiseProduct(0.5 * (a + b));
  const Eigen::Vector2d half = wave.cwiseProduct(0.5 * (b - a));
  const int modes_x = static_cast<int>(sums.rows()), modes_y = static_cast<int>(sums.cols());
  const Multiples mid_y(middle.y(), modes_y), half_y(half.y(), modes_y);
  for (int n = 1; n < modes_y; ++n) {
    sums(0, n) -= density * (b.x() - a.x()) / (n * wave.y()) * mid_y.sine[n] *
                  sinc(n * half.y(), half_y.sine[n]);
  }
  if (a.y() == b.y()) return;
  const Multiples mid_x(middle.x(), modes_x), half_x(half.x(), modes_x);
  for (int m = 1; m < modes_x; ++m) {
    const double scale = density * (b.y() - a.y()) / (2 * m * wave.x());
    for (int n = 0; n < modes_y; ++n) {
      const double sc = mid_x.sine[m] * mid_y.cosine[n], cs = mid_x.cosine[m] * mid_y.sine[n];
      const double hsc = half_x.sine[m] * half_y.cosine[n], hcs = half_x.cosine[m] * half_y.sine[n];
      const double zx = m * half.x(), zy = n * half.y();
      sums(m, n) +=
          scale * ((sc + cs) * sinc(zx + zy, hsc + hcs) + (sc - cs) * sinc(zx - zy, hsc - hcs));
    }
  }
}

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

}  // namespace

Eigen::VectorXd cosine_integrals(double low, double high, double length, int modes) {
  const double wave = std::numbers::pi / length;
  const double middle = wave * 0.5 * (low + high), half = wave * 0.5 * (high - low);
  Eigen::VectorXd integrals(modes);
  for (int m = 0; m < modes; ++m) {
    integrals[m] =
        (high - low) * portable::cos(m * middle) * sinc(m * half, portable::sin(m * half));
  }
  return integrals;
}

double add_polygon(std::span<const Eigen::Vector2d> corners, double density,
                   const Eigen::Vector2d& size_m, PlaneCoefficients& sums) {
  double perimeter_m = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector2d &a = corners[i], &b = corners[(i + 1) % corners.size()];
    if (i >= 2) sums(0, 0) += 0.5 * density * cross(corners[i - 1] - corners[0], a - corners[0]);
    perimeter_m += (b - a).norm();
    add_edge(a, b, density, size_m, sums);
  }
  // Each edge's contribution is at most its length · L/π, with an error of a few roundings and
  // sinc's 2e-15.
  constexpr double kRoundings = 16 * std::numeric_limits<double>::epsilon();
  return kRoundings * density * perimeter_m * size_m.maxCoeff();
}

}  // namespace ergocast
