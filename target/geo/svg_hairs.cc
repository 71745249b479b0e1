// SPDX-License-Identifier: BSD-3-Clause
// Erodes and dilates the darkness; what that leaves out is followed for a few cells.
#include "target/geo/svg_hairs.h"

#include <algorithm>
#include <initializer_list>
#include <vector>

namespace ergocast {
namespace {

/// The parts of a colour have 8 bits, so equal paint can differ by nearly as much.
constexpr int kAlike = 50;
/// In cells: how far a point is thinner than three cells.
constexpr int kPoint = 4;

struct At {
  int column, row;
};

/// What `pick` makes of each cell and its neighbours. There is paper around the cells.
CellGrid of_squares(const CellGrid& cells, auto pick) {
  const auto along = [&](const CellGrid& from, At step) {
    CellGrid to(from.columns(), from.rows());
    const auto value = [&](int column, int row) {
      return from.has(column, row) ? from.at(column, row) : std::uint8_t{0};
    };
    for (int row = 0; row < from.rows(); ++row)
      for (int column = 0; column < from.columns(); ++column)
        to.at(column, row) =
            pick({value(column - step.column, row - step.row), from.at(column, row),
                  value(column + step.column, row + step.row)});
    return to;
  };
  return along(along(cells, {1, 0}), {0, 1});
}

/// The cells that are darker than every square of 3 × 3 cells around them, row by row.
std::vector<At> thin_cells(const CellGrid& darkness) {
  using Three = std::initializer_list<std::uint8_t>;
  const CellGrid eroded = of_squares(darkness, [](Three three) { return std::min(three); });
  const CellGrid opened = of_squares(eroded, [](Three three) { return std::max(three); });
  std::vector<At> thin;
  for (int row = 0; row < darkness.rows(); ++row) {
    for (int column = 0; column < darkness.columns(); ++column) {
      const std::uint8_t dark = darkness.at(column, row);
      if (dark != kSolidDarkness && dark >= opened.at(column, row) + kAlike)
        thin.push_back({column, row});
    }
  }
  return thin;
}

}  // namespace

std::optional<std::pair<int, int>> first_hair(const CellGrid& darkness) {
  bool any_faint = false;
  for (std::size_t i = 0; i < darkness.size(); ++i)
    any_faint = any_faint || (darkness[i] >= kAlike && darkness[i] != kSolidDarkness);
  if (!any_faint) return std::nullopt;
  const std::vector<At> thin = thin_cells(darkness);
  // The darkest cell near each one. Thin cells do not count at first.
  CellGrid at_hand = darkness;
  for (const At& cell : thin) at_hand.at(cell.column, cell.row) = 0;
  for (int step = 0; step < kPoint; ++step) {
    const CellGrid before = at_hand;
    for (const At& cell : thin) {
      std::uint8_t& darkest = at_hand.at(cell.column, cell.row);
      for (int row = cell.row - 1; row <= cell.row + 1; ++row)
        for (int column = cell.column - 1; column <= cell.column + 1; ++column)
          if (before.has(column, row)) darkest = std::max(darkest, before.at(column, row));
    }
  }
  for (const At& cell : thin)
    if (at_hand.at(cell.column, cell.row) + kAlike <= darkness.at(cell.column, cell.row))
      return std::pair(cell.column, cell.row);
  return std::nullopt;
}

}  // namespace ergocast
