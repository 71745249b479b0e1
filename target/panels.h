// SPDX-License-Identifier: BSD-3-Clause
// Gauss–Legendre panels for one-dimensional Gaussians and cosines.
#pragma once

#include <Eigen/Core>

namespace ergocast {

struct Interval {
  double low = 0, high = 0;
  double length() const { return high - low; }
};

/// The part of `side` where the Gaussian is not negligible: above 1e-16 of its peak.
Interval reached(double mean, double deviation, const Interval& side);

/// Nodes and their weights.
struct Rule {
  Eigen::VectorXd x, weight;
};

/// Eight nodes in each of `panels` equal parts of `over`.
Rule panel_rule(const Interval& over, int panels);

/// Panels of at most `scale` on `over`, times `refinement`.
Rule panels_on(const Interval& over, double scale, int refinement);

/// The length that a panel may have: that of the bell, or a wavelength of the fastest of `modes`
/// cosines cos(m · wave · x).
double panel_scale(double bell, double wave, Eigen::Index modes);

/// sums[k] += mass · cos(k·angle), by recurrence.
void add_cosines(double mass, double angle, Eigen::VectorXd& sums);

/// ∫ cos(mπx/length) N(x; mean, deviation²) dx over `part` of the domain's side [0, length],
/// m = 0 … modes − 1, exact to rounding.
Eigen::VectorXd integrals_along(double mean, double deviation, const Interval& part, double length,
                                int modes);

}  // namespace ergocast
