// SPDX-License-Identifier: BSD-3-Clause
// Values each way by the cells near the agent, and takes the first of the best.
#include "core/search/search_heading.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "core/base/portable_math.h"

namespace ergocast {
namespace {

/// The length of a way in radii of the sensor, the weight of the potential in areas r², and that of
/// what was searched around a cell.
constexpr double kReach = 1.5, kPull = 10, kBeside = 4;
/// Squared, in cells: the neighbours that make a cell worth more.
constexpr int kAround = 4;

/// How far the ray from 0 along a direction comes before it crosses an edge, at most `reach_m`.
double before_edge_m(const Segment& edge, const Eigen::Vector2d& from_m,
                     const Eigen::Vector2d& along, double reach_m) {
  const Eigen::Vector2d side_m = edge.to_m - edge.from_m, off_m = edge.from_m - from_m;
  const double across = along.x() * side_m.y() - along.y() * side_m.x();
  if (across == 0) return reach_m;
  const double share = (off_m.x() * along.y() - off_m.y() * along.x()) / across;
  const double length_m = (off_m.x() * side_m.y() - off_m.y() * side_m.x()) / across;
  return share >= 0 && share <= 1 && length_m >= 0 ? std::min(reach_m, length_m) : reach_m;
}

}  // namespace

SearchHeading::SearchHeading(const SearchCells& cells, IndexedRings walls, double rate_per_s)
    : cells_(cells.cells),
      radius_m_(cells.radius_m),
      rate_per_s_(rate_per_s),
      pull_(kPull * portable::square(radius_m_) / (cells_.size_m.x() * cells_.size_m.y())),
      walls_(std::move(walls)) {
  for (std::size_t way = 0; way < ways_.size(); ++way) {
    const double turn = static_cast<double>(way) / static_cast<double>(ways_.size());
    const portable::SinCos angle = portable::sin_cos(2 * std::numbers::pi * turn);
    ways_[way] = {angle.cos, angle.sin};
  }
  near_.reserve(cells_.total());
}

Eigen::Vector3d SearchHeading::best(const Eigen::Vector3d& x_m, const SearchKnowledge& known,
                                    const Eigen::Vector3d& gradient, double speed_mps,
                                    double hold_s) {
  const double reach_m = std::max(kReach * radius_m_, speed_mps * hold_s);
  find_near(x_m, known, reach_m);
  double most = -std::numeric_limits<double>::infinity(), least = -most;
  Eigen::Vector3d heading(0, 0, 0);
  for (const Eigen::Vector2d& along : ways_) {
    const double length_m = free_m(x_m, along, reach_m);
    const double value = found(along, length_m, rate_per_s_ / speed_mps) -
                         pull_ * length_m * gradient.head<2>().dot(along);
    least = std::min(least, value);
    if (value <= most) continue;
    most = value;
    heading.head<2>() = along;
  }
  if (!(most > least)) heading.setZero();
  return heading;
}

void SearchHeading::find_near(const Eigen::Vector3d& x_m, const SearchKnowledge& known,
                              double reach_m) {
  near_.clear();
  const double most = known.left.maxCoeff();
  cells_.for_near(x_m, reach_m + radius_m_, [&](int i, int j, int) {
    const double left = known.left[static_cast<Eigen::Index>(cells_.column(i, 0)) + j];
    if (left > 0)
      near_.push_back({cells_.center_m(0, i) - x_m.x(), cells_.center_m(1, j) - x_m.y(),
                       left * left / most * (1 + kBeside * searched_around(known.missed, i, j))});
  });
}

/// q of a cell.
double SearchHeading::searched_around(const Eigen::VectorXd& missed, int i, int j) const {
  double searched = 0;
  int count = 0;
  for (int off_i = -2; off_i <= 2; ++off_i) {
    for (int off_j = -2; off_j <= 2; ++off_j) {
      const int square = off_i * off_i + off_j * off_j;
      if (square == 0 || square > kAround) continue;
      ++count;
      const int ni = i + off_i, nj = j + off_j;
      const bool inside = ni >= 0 && nj >= 0 && ni < cells_.count.x() && nj < cells_.count.y();
      searched += 1 - (inside ? missed[static_cast<Eigen::Index>(cells_.column(ni, 0)) + nj] : 0);
    }
  }
  return searched / count;
}

/// How long a way is, before it ends at a side or wall.
double SearchHeading::free_m(const Eigen::Vector3d& x_m, const Eigen::Vector2d& along,
                             double reach_m) const {
  double length_m = reach_m;
  for (const int axis : {0, 1}) {
    if (along[axis] == 0) continue;
    const double side_m =
        cells_.domain.origin_m[axis] + (along[axis] > 0 ? cells_.domain.size_m[axis] : 0);
    length_m = std::min(length_m, std::max(0.0, (side_m - x_m[axis]) / along[axis]));
  }
  const Eigen::Vector2d from_m = x_m.head<2>();
  walls_.find_near({from_m, from_m + length_m * along}, 0, [&](const Edge& edge) {
    length_m = before_edge_m(edge.segment, from_m, along, length_m);
    return false;
  });
  return length_m;
}

/// The first sum of V.
double SearchHeading::found(const Eigen::Vector2d& along, double length_m,
                            double nats_per_m) const {
  double sum = 0;
  for (const Near& cell : near_) {
    const double aside_m = cell.x_m * along.y() - cell.y_m * along.x();
    const double square_m2 = radius_m_ * radius_m_ - aside_m * aside_m;
    if (!(square_m2 > 0)) continue;
    const double middle_m = cell.x_m * along.x() + cell.y_m * along.y();
    const double half_m = std::sqrt(square_m2);
    const double seen_m = std::min(length_m, middle_m + half_m) - std::max(0.0, middle_m - half_m);
    if (seen_m > 0) sum += cell.worth * (1 - portable::exp(-nats_per_m * seen_m));
  }
  return sum;
}

}  // namespace ergocast
