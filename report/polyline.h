// SPDX-License-Identifier: BSD-3-Clause
// Reduces curves with far more points than pixels, without a visible change.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace ergocast {

using Polyline = std::vector<Eigen::Vector2d>;

/// A subset of `points`, first and last included, whose polyline passes within `tolerance` of all
/// of them (Douglas–Peucker).
Polyline simplify(const Polyline& points, double tolerance);

/// At most four points of each column one unit wide: the first, lowest, highest and last, which
/// cover the same pixels as all points. @pre x ascends.
Polyline thin_columns(const Polyline& points);

/// The data of an SVG path through `points`, to a tenth of a pixel; empty if there are none. A
/// single point becomes a dot if the line has round caps.
std::string path_data(const Polyline& points);

}  // namespace ergocast
