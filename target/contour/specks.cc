// SPDX-License-Identifier: BSD-3-Clause
// Floods each patch once to measure it, and once more to change it.
#include "target/contour/specks.h"

#include <utility>
#include <vector>

namespace ergocast {
namespace {

constexpr std::uint8_t kReached = 0x80;

struct Patch {
  std::size_t size = 0;
  bool has_occupied = false, at_edge = false;
};

class Flood {
 public:
  Flood(CellGrid& cells, bool of_free) : cells_(cells), of_free_(of_free) {}

  /// Replaces all patches for which `is_speck(patch)` by cells of `value`.
  void replace(std::uint8_t value, auto&& is_speck) {
    for (int row = 0; row < cells_.rows(); ++row) {
      for (int column = 0; column < cells_.columns(); ++column) {
        if (!belongs(cells_.at(column, row))) continue;
        const Patch patch = pass(
            column, row, [&](std::uint8_t cell) { return belongs(cell); },
            [](std::uint8_t& cell) { cell = static_cast<std::uint8_t>(cell | kReached); });
        if (!is_speck(patch)) continue;
        pass(
            column, row, [&](std::uint8_t cell) { return cell != value && (cell & kReached) != 0; },
            [&](std::uint8_t& cell) { cell = value; });
      }
    }
    for (std::size_t i = 0; i < cells_.size(); ++i)
      cells_[i] = static_cast<std::uint8_t>(cells_[i] & ~kReached);
  }

 private:
  bool belongs(std::uint8_t cell) const {
    return cell < kReached && (cell == kFreeCell) == of_free_;
  }

  /// Visits the cells that `wanted` holds for, and changes each with `mark`, after which `wanted`
  /// no longer holds.
  Patch pass(int column, int row, auto&& wanted, auto&& mark) {
    Patch patch;
    std::vector<std::pair<int, int>> front, next;
    const auto enter = [&](int x, int y) {
      if (!cells_.has(x, y)) {
        patch.at_edge = true;
        return;
      }
      std::uint8_t& cell = cells_.at(x, y);
      if (!wanted(cell)) return;
      ++patch.size;
      patch.has_occupied = patch.has_occupied || cell == kOccupiedCell;
      mark(cell);
      next.emplace_back(x, y);
    };
    enter(column, row);
    while (!next.empty()) {
      front.swap(next);
      next.clear();
      for (const auto& [x, y] : front) {
        for (int dy = -1; dy <= 1; ++dy) {
          for (int dx = -1; dx <= 1; ++dx)
            if (!of_free_ || dx == 0 || dy == 0) enter(x + dx, y + dy);
        }
      }
    }
    return patch;
  }

  CellGrid& cells_;
  const bool of_free_;
};

}  // namespace

std::size_t count_free(const CellGrid& cells) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < cells.size(); ++i) count += cells[i] == kFreeCell ? 1 : 0;
  return count;
}

void free_unknown_specks(CellGrid& cells, std::size_t least) {
  Flood(cells, false).replace(kFreeCell, [&](const Patch& patch) {
    return !patch.has_occupied && !patch.at_edge && patch.size < least;
  });
}

void close_pockets(CellGrid& cells, std::size_t least) {
  Flood(cells, true).replace(kClosedCell, [&](const Patch& patch) { return patch.size < least; });
}

}  // namespace ergocast
