// SPDX-License-Identifier: BSD-3-Clause
// Halves ranges where the sum is nearest to what is wanted.
#include "core/law/equal_shares.h"

#include <cmath>

namespace ergocast {
namespace {

/// The range before the cut, which is along x or along y.
CellRange before(CellRange range, bool along_x, int cut) {
  (along_x ? range.last_i : range.last_j) = cut;
  return range;
}
CellRange after(CellRange range, bool along_x, int cut) {
  (along_x ? range.first_i : range.first_j) = cut;
  return range;
}

/// Where the mass before the cut is nearest to `wanted`; at least one cell stays on each side.
int best_cut(const RangeSums& mass, const CellRange& range, bool along_x, double wanted) {
  const int first = along_x ? range.first_i : range.first_j;
  const int last = along_x ? range.last_i : range.last_j;
  int best = first + 1;
  double apart = std::abs(mass.of(before(range, along_x, best)) - wanted);
  for (int cut = first + 2; cut < last; ++cut) {
    const double next = std::abs(mass.of(before(range, along_x, cut)) - wanted);
    if (next >= apart) continue;
    apart = next;
    best = cut;
  }
  return best;
}

}  // namespace

RangeSums::RangeSums(const Cells& cells, const std::vector<double>& values)
    : rows_(static_cast<std::size_t>(cells.count.y()) + 1),
      below_((static_cast<std::size_t>(cells.count.x()) + 1) * rows_, 0) {
  for (int i = 0; i < cells.count.x(); ++i) {
    double column = 0;
    for (int j = 0; j < cells.count.y(); ++j) {
      column += values[cells.column(i, 0) + static_cast<std::size_t>(j)];
      below_[index(i + 1, j + 1)] = at(i, j + 1) + column;
    }
  }
}

double RangeSums::of(const CellRange& range) const {
  return at(range.last_i, range.last_j) - at(range.first_i, range.last_j) -
         at(range.last_i, range.first_j) + at(range.first_i, range.first_j);
}

CellRange equal_share(const Cells& cells, const RangeSums& mass, int rank, int count) {
  CellRange share{0, cells.count.x(), 0, cells.count.y()};
  while (count > 1) {
    const int columns = share.last_i - share.first_i, rows = share.last_j - share.first_j;
    if (columns * rows < 2) break;  // agents without a cell of their own share one
    const bool along_x =
        rows < 2 || (columns >= 2 && columns * cells.size_m.x() >= rows * cells.size_m.y());
    const int half = count / 2;
    const double wanted = mass.of(share) * half / count;
    const int cut = best_cut(mass, share, along_x, wanted);
    const bool is_before = rank < half;
    share = is_before ? before(share, along_x, cut) : after(share, along_x, cut);
    rank -= is_before ? 0 : half;
    count = is_before ? half : count - half;
  }
  return share;
}

}  // namespace ergocast
