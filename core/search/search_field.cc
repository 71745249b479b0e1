// SPDX-License-Identifier: BSD-3-Clause
// Factorises the equation once, because it is the same for every source.
#include "core/search/search_field.h"

#include <algorithm>
#include <array>

#include "core/base/portable_math.h"
#include "core/base/rings.h"

namespace ergocast {
namespace {

/// The neighbour of a cell along an axis.
std::array<int, 2> next(int axis, int i, int j) {
  return axis == 0 ? std::array{i + 1, j} : std::array{i, j + 1};
}

}  // namespace

SearchField::SearchField(const Cells& cells, const Rings& walls, double smoothing_m)
    : cells_(cells),
      u_(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(cells.total()))),
      ordered_(u_) {
  find_links(walls);
  std::vector<Eigen::Triplet<double>> entries;
  const auto index = [&](int i, int j) { return static_cast<int>(cells_.column(i, 0)) + j; };
  for (int i = 0; i < cells_.count.x(); ++i) {
    for (int j = 0; j < cells_.count.y(); ++j) {
      const int here = index(i, j);
      entries.emplace_back(here, here, 1);
      for (const int axis : {0, 1}) {
        if (!linked(axis, i, j)) continue;
        const auto [ni, nj] = next(axis, i, j);
        const int there = index(ni, nj);
        const double exchange = portable::square(smoothing_m / cells_.size_m[axis]);
        entries.emplace_back(here, here, exchange);
        entries.emplace_back(there, there, exchange);
        entries.emplace_back(there, here, -exchange);
        entries.emplace_back(here, there, -exchange);
      }
    }
  }
  Eigen::SparseMatrix<double> equation(u_.size(), u_.size());
  equation.setFromTriplets(entries.begin(), entries.end());
  solver_.compute(equation);
  diagonal_ = solver_.vectorD();  // which returns a copy
}

void SearchField::find_links(const Rings& walls) {
  for (const int axis : {0, 1}) {
    auto& links = links_[static_cast<std::size_t>(axis)];
    links.assign(cells_.total(), 0);
    const int across = 1 - axis;
    for (int line = 0; line < cells_.count[across]; ++line) {
      const std::vector<double> walls_m = crossings_m(walls, across, cells_.center_m(across, line));
      for (int cell = 0; cell + 1 < cells_.count[axis]; ++cell) {
        const auto wall = std::ranges::lower_bound(walls_m, cells_.center_m(axis, cell));
        const bool open = wall == walls_m.end() || *wall > cells_.center_m(axis, cell + 1);
        const int i = axis == 0 ? cell : line, j = axis == 0 ? line : cell;
        links[cells_.column(i, 0) + static_cast<std::size_t>(j)] = open ? 1 : 0;
      }
    }
  }
}

/// The steps of solver_.solve(), without its temporary vectors.
void SearchField::solve(const Eigen::VectorXd& source) {
  ordered_.noalias() = solver_.permutationP() * source;
  solver_.matrixL().solveInPlace(ordered_);
  ordered_.array() /= diagonal_.array();
  solver_.matrixU().solveInPlace(ordered_);
  u_.noalias() = solver_.permutationPinv() * ordered_;
}

/// The slope of u from a cell to the next one; 0 at sides and walls.
double SearchField::slope(int axis, int i, int j) const {
  if (i < 0 || j < 0 || !linked(axis, i, j)) return 0;
  const auto [ni, nj] = next(axis, i, j);
  const auto here = static_cast<Eigen::Index>(cells_.column(i, 0)) + j;
  const auto there = static_cast<Eigen::Index>(cells_.column(ni, 0)) + nj;
  return (u_[there] - u_[here]) / cells_.size_m[axis];
}

double SearchField::mean_slope(int axis, int i, int j) const {
  return (slope(axis, i, j) + slope(axis, axis == 0 ? i - 1 : i, axis == 1 ? j - 1 : j)) / 2;
}

Eigen::Vector3d SearchField::gradient(const Eigen::Vector3d& x_m) const {
  std::array<int, 2> low{}, high{};
  std::array<double, 2> share{};
  for (const int axis : {0, 1}) {
    const auto a = static_cast<std::size_t>(axis);
    const double middle = (x_m[axis] - cells_.domain.origin_m[axis]) / cells_.size_m[axis] - 0.5;
    const double inside = std::clamp(middle, 0.0, cells_.count[axis] - 1.0);
    low[a] = static_cast<int>(inside);
    high[a] = std::min(low[a] + 1, cells_.count[axis] - 1);
    share[a] = inside - low[a];
  }
  Eigen::Vector3d gradient(0, 0, 0);
  for (const int far_x : {0, 1}) {
    for (const int far_y : {0, 1}) {
      const int i = far_x ? high[0] : low[0], j = far_y ? high[1] : low[1];
      const double weight = (far_x ? share[0] : 1 - share[0]) * (far_y ? share[1] : 1 - share[1]);
      gradient += weight * Eigen::Vector3d(mean_slope(0, i, j), mean_slope(1, i, j), 0);
    }
  }
  return gradient;
}

}  // namespace ergocast
