// SPDX-License-Identifier: BSD-3-Clause
// Curves with far more points than pixels, made small without changing the picture.
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
/// cover the same pixels as all of them. @pre x ascends.
Polyline thin_columns(const Polyline& points);

/// The data of an SVG path through `points`, to a tenth of a pixel; empty if there are none. A
/// single point becomes a dot where the line's caps are round.
std::string path_data(const Polyline& points);

}  // namespace ergocast
