// SPDX-License-Identifier: BSD-3-Clause
// Cells of a plane, row by row from the south.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace ergocast {

/// A grid of cells with side 1. Column 0 is in the west, row 0 in the south.
class CellGrid {
 public:
  CellGrid(int columns, int rows, std::uint8_t value = 0)
      : columns_(columns),
        rows_(rows),
        cells_(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), value) {}

  int columns() const { return columns_; }
  int rows() const { return rows_; }
  std::size_t size() const { return cells_.size(); }
  bool has(int column, int row) const {
    return column >= 0 && column < columns_ && row >= 0 && row < rows_;
  }
  std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(column);
  }
  std::uint8_t& operator[](std::size_t cell) { return cells_[cell]; }
  std::uint8_t operator[](std::size_t cell) const { return cells_[cell]; }
  /// @pre has(column, row)
  std::uint8_t& at(int column, int row) { return cells_[index(column, row)]; }
  std::uint8_t at(int column, int row) const { return cells_[index(column, row)]; }

 private:
  int columns_, rows_;
  std::vector<std::uint8_t> cells_;
};

}  // namespace ergocast
