// SPDX-License-Identifier: BSD-3-Clause
// Halves ranges where the sum is nearest to what is wanted.
#include "core/law/equal_shares.h"

#include <cmath>

namespace ergocast {
namespace {

/// The range before a cut across `axis`, and that after it.
CellRange before(CellRange range, int axis, int cut) {
  range.last[axis] = cut;
  return range;
}
CellRange after(CellRange range, int axis, int cut) {
  range.first[axis] = cut;
  return range;
}

/// Where the mass before the cut is nearest to `wanted`; at least one cell stays on each side.
int best_cut(const RangeSums& mass, const CellRange& range, int axis, double wanted) {
  int best = range.first[axis] + 1;
  double apart = std::abs(mass.of(before(range, axis, best)) - wanted);
  for (int cut = best + 1; cut < range.last[axis]; ++cut) {
    const double next = std::abs(mass.of(before(range, axis, cut)) - wanted);
    if (next >= apart) continue;
    apart = next;
    best = cut;
  }
  return best;
}

}  // namespace

int longest_axis(const Cells& cells, const CellRange& range) {
  const Eigen::Array3d sides_m = range.counts().cast<double>() * cells.size_m.array();
  int longest = 0;
  (range.counts() > 1).select(sides_m, 0).maxCoeff(&longest);
  return longest;
}

RangeSums::RangeSums(const Cells& cells, const std::vector<double>& values)
    : columns_(static_cast<std::size_t>(cells.count.x()) + 1),
      rows_(static_cast<std::size_t>(cells.count.y()) + 1),
      below_(columns_ * rows_ * (static_cast<std::size_t>(cells.count.z()) + 1), 0) {
  for (int l = 0; l < cells.count.z(); ++l) {
    std::vector<double> rows(rows_, 0);  // of the layer, over the columns so far
    for (int i = 0; i < cells.count.x(); ++i) {
      double column = 0;
      for (int j = 0; j < cells.count.y(); ++j) {
        column += values[cells.column(i, l) + static_cast<std::size_t>(j)];
        double& row = rows[static_cast<std::size_t>(j) + 1];
        row += column;
        below_[index(i + 1, j + 1, l + 1)] = below_[index(i + 1, j + 1, l)] + row;
      }
    }
  }
}

/// Over the layers before `l`.
double RangeSums::in_plane(const CellRange& range, int l) const {
  const Eigen::Array3i &first = range.first, &last = range.last;
  return below_[index(last.x(), last.y(), l)] - below_[index(first.x(), last.y(), l)] -
         below_[index(last.x(), first.y(), l)] + below_[index(first.x(), first.y(), l)];
}

double RangeSums::of(const CellRange& range) const {
  return in_plane(range, range.last.z()) - in_plane(range, range.first.z());
}

CellRange equal_share(const Cells& cells, const RangeSums& mass, int rank, int count) {
  CellRange share{{0, 0, 0}, cells.count};
  while (count > 1) {
    const int axis = longest_axis(cells, share);
    if (share.counts()[axis] < 2) break;  // agents without a cell of their own share one
    const int half = count / 2;
    const int cut = best_cut(mass, share, axis, mass.of(share) * half / count);
    const bool is_before = rank < half;
    share = is_before ? before(share, axis, cut) : after(share, axis, cut);
    rank -= is_before ? 0 : half;
    count = is_before ? half : count - half;
  }
  return share;
}

}  // namespace ergocast
