// SPDX-License-Identifier: BSD-3-Clause
// Follows each line from its first side that looks west, in the order of rows.
#include "target/contour/cell_rings.h"

#include <algorithm>
#include <array>
#include <tuple>
#include <utility>

namespace ergocast {
namespace {

/// East, north, west, south: each is a left turn from the one before.
constexpr std::array<CellCorner, 4> kAlong = {{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};
constexpr int kNorth = 1, kSouth = 3;
/// The cell on the left of a side that begins at a corner, from the cell north-east of that corner.
constexpr std::array<CellCorner, 4> kLeftCell = {{{0, 0}, {-1, 0}, {-1, -1}, {0, -1}}};

class RingFollower {
 public:
  RingFollower(const CellGrid& cells, std::size_t most_sides)
      : cells_(cells), most_sides_(most_sides), followed_(cells.size(), false) {}

  std::optional<std::vector<CellRing>> run() {
    for (int row = 0; row < cells_.rows(); ++row) {
      for (int column = 0; column < cells_.columns(); ++column) {
        const bool begins = solid(column, row) && !solid(column - 1, row);
        if (!begins || followed_[cells_.index(column, row)]) continue;
        if (!follow(column, row)) return std::nullopt;
      }
    }
    find_outlines();
    return std::move(rings_);
  }

 private:
  /// A side between a solid cell in `column` and a free one beside it, and its ring.
  struct Upright {
    int row, column, ring;
    friend auto operator<=>(const Upright& a, const Upright& b) = default;
  };

  bool solid(int column, int row) const {
    return cells_.has(column, row) && cells_.at(column, row) > 0;
  }
  bool solid(CellCorner cell) const { return solid(cell.x, cell.y); }

  /// Follows the line down the western side of a cell; false if there are too many sides.
  bool follow(int column, int row) {
    CellRing& ring = rings_.emplace_back();
    const CellCorner begin{column, row + 1};
    CellCorner at = begin;
    int along = kSouth;
    bool pinched = false;
    Upright east{cells_.rows(), 0, 0};
    long area = 0;  // twice
    do {
      if (++sides_ > most_sides_) return false;
      ring.sides.push_back({at, kAlong[static_cast<std::size_t>(along)], pinched});
      const CellCorner cell = at + kLeftCell[static_cast<std::size_t>(along)];
      const Upright side{cell.y, cell.x, static_cast<int>(rings_.size()) - 1};
      if (along == kSouth) {
        followed_[cells_.index(cell.x, cell.y)] = true;
        west_.push_back(side);
      } else if (along == kNorth) {
        east = std::min(east, side);
      }
      const CellCorner next = at + kAlong[static_cast<std::size_t>(along)];
      area += static_cast<long>(at.x) * next.y - static_cast<long>(at.y) * next.x;
      at = next;
      std::tie(along, pinched) = turned(at, along);
    } while (!(at == begin && along == kSouth));
    ring.sides.front().pinched = pinched;
    std::rotate(ring.sides.begin(), ring.sides.begin() + 1, ring.sides.end());
    if (area < 0) holes_.push_back({east.row, east.column, static_cast<int>(rings_.size()) - 1});
    return true;
  }

  /// The direction after `along` at a corner, and whether two solid cells only touch there.
  std::pair<int, bool> turned(CellCorner at, int along) const {
    const bool left = solid(at + kLeftCell[static_cast<std::size_t>(along)]);
    const int right_turn = (along + 3) % 4;
    const bool right = solid(at + kLeftCell[static_cast<std::size_t>(right_turn)]);
    if (right) return {right_turn, !left};
    return {left ? along : (along + 1) % 4, false};
  }

  /// West of a hole's first eastern side are solid cells up to a ring that is known already.
  void find_outlines() {
    std::ranges::sort(west_);
    std::ranges::sort(holes_);
    for (const Upright& hole : holes_) {
      int column = hole.column;
      while (solid(column - 1, hole.row)) --column;
      const int beside = std::ranges::lower_bound(west_, Upright{hole.row, column, 0})->ring;
      const int around = rings_[static_cast<std::size_t>(beside)].hole_of;
      rings_[static_cast<std::size_t>(hole.ring)].hole_of = around < 0 ? beside : around;
    }
  }

  const CellGrid& cells_;
  const std::size_t most_sides_;
  std::size_t sides_ = 0;
  std::vector<bool> followed_;  // for each cell, whether the line along its western side is known
  std::vector<CellRing> rings_;
  std::vector<Upright> west_, holes_;
};

}  // namespace

std::optional<std::vector<CellRing>> rings_of_cells(const CellGrid& cells, std::size_t most_sides) {
  return RingFollower(cells, most_sides).run();
}

}  // namespace ergocast
