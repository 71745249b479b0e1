// SPDX-License-Identifier: BSD-3-Clause
// Looks along the lines between neighbouring cells, keeps the largest connected part, and gives
// each part of a cell to the nearest free cell that it sees.
#include "modes/free_grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "core/basis/free_modes.h"

namespace ergocast {
namespace {

/// For a square domain. A finer grid takes more time, so it comes only where a coarser one shows no
/// way between parts.
constexpr double kCellsAlongSide[] = {80, 113, 160, 226};
constexpr int kFewestCells = 8, kMostCells = 640;
/// The share of free cells that may be cut off, such as corners behind a wall that is nearer to a
/// side than a cell's width.
constexpr double kMostCutOff = 0.01;
/// How much longer than straight a way of bodies may be between two cells: a factor, and as many
/// cells of their region.
constexpr double kDetour = 1.1, kDetourCells = 0.5;

constexpr std::pair<int, int> kBeside[] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}};

/// Finds which cells see each other. Every cell of the grid has a number, column · rows + row.
class GridBuilder {
 public:
  GridBuilder(const Box& domain, double along_side, const Sees& sees, const FreeRegion* bodies)
      : sees_(sees), bodies_(bodies) {
    grid_.origin_m = domain.origin_m.head<2>();
    grid_.size_m = domain.size_m.head<2>();
    const double shape = std::sqrt(grid_.size_m.x() / grid_.size_m.y());
    grid_.columns = cells_along(along_side * shape);
    grid_.rows = cells_along(along_side / shape);
  }

  Result<FreeGrid> run() {
    look();
    if (bodies_ != nullptr) close_gaps();
    if (auto problem = keep_the_largest_part()) return failure(*problem);
    number_cells();
    set_around();
    set_owners();
    return std::move(grid_);
  }

 private:
  static int cells_along(double wanted) {
    return std::clamp(static_cast<int>(std::lround(wanted)), kFewestCells, kMostCells);
  }
  int all() const { return grid_.columns * grid_.rows; }
  Eigen::Vector2d middle_m(int at) const {
    const int column = at / grid_.rows, row = at % grid_.rows;
    return at_m(column + 0.5, row + 0.5);
  }
  Eigen::Vector2d at_m(double column, double row) const {
    return Eigen::Vector2d(column / grid_.columns, row / grid_.rows).cwiseProduct(grid_.size_m);
  }
  /// The cell (a, b) away from another one; −1 outside the grid.
  int beside(int at, int a, int b) const {
    const int column = at / grid_.rows + a, row = at % grid_.rows + b;
    const bool inside = column >= 0 && column < grid_.columns && row >= 0 && row < grid_.rows;
    return inside ? column * grid_.rows + row : -1;
  }
  /// Whether a cell sees the cell beside it, along one axis.
  bool open(int at, int a, int b) const {
    const int other = beside(at, a, b);
    if (at < 0 || other < 0) return false;
    const auto lower = static_cast<std::size_t>(std::min(at, other));
    return a != 0 ? open_x_[lower] : open_y_[lower];
  }

  void look() {
    const auto count = static_cast<std::size_t>(all());
    free_.assign(count, false);
    open_x_ = open_y_ = free_;
    for (int at = 0; at < all(); ++at)
      free_[static_cast<std::size_t>(at)] = sees_(middle_m(at), middle_m(at));
    const auto look_at = [&](int at, int other) {
      return other >= 0 && free_[static_cast<std::size_t>(at)] &&
             free_[static_cast<std::size_t>(other)] && sees_(middle_m(at), middle_m(other));
    };
    for (int at = 0; at < all(); ++at) {
      open_x_[static_cast<std::size_t>(at)] = look_at(at, beside(at, 1, 0));
      open_y_[static_cast<std::size_t>(at)] = look_at(at, beside(at, 0, 1));
    }
  }

  /// The place of bodies nearest to each cell, by steps along the axes: a cell of their region, or
  /// −1 where no body comes near.
  std::vector<int> places_of_bodies() const {
    std::vector<int> place(free_.size(), -1), reached;
    for (int at = 0; at < all(); ++at) {
      const Eigen::Vector2d at_m = middle_m(at);
      if (!free_[static_cast<std::size_t>(at)] || !bodies_->part_at(at_m)) continue;
      place[static_cast<std::size_t>(at)] = bodies_->cell_at(at_m);
      reached.push_back(at);
    }
    for (std::size_t i = 0; i < reached.size(); ++i) {
      for (const auto& [a, b] : kBeside) {
        if (!open(reached[i], a, b)) continue;
        const int next = beside(reached[i], a, b);
        if (place[static_cast<std::size_t>(next)] >= 0) continue;
        place[static_cast<std::size_t>(next)] = place[static_cast<std::size_t>(reached[i])];
        reached.push_back(next);
      }
    }
    return place;
  }

  /// Parts cells that see each other through a gap which is too narrow for bodies. A cell in it
  /// stays with the side from which bodies come nearest.
  void close_gaps() {
    const std::vector<int> place = places_of_bodies();
    const auto passes = [&](int at, int other) {
      const int from = place[static_cast<std::size_t>(at)],
                to = place[static_cast<std::size_t>(other)];
      if (from < 0 || to < 0 || from == to) return true;
      const double straight_m = (bodies_->center_m(to) - bodies_->center_m(from)).norm();
      return bodies_->has_way(from, to,
                              kDetour * straight_m + kDetourCells * bodies_->cell_size_m());
    };
    for (int at = 0; at < all(); ++at) {
      const auto lower = static_cast<std::size_t>(at);
      if (open_x_[lower] && !passes(at, beside(at, 1, 0))) open_x_[lower] = false;
      if (open_y_[lower] && !passes(at, beside(at, 0, 1))) open_y_[lower] = false;
    }
  }

  /// The cells that are connected with one.
  std::vector<int> part_of(int first, std::vector<bool>& seen) const {
    std::vector<int> part{first};
    seen[static_cast<std::size_t>(first)] = true;
    for (std::size_t i = 0; i < part.size(); ++i) {
      for (const auto& [a, b] : kBeside) {
        if (!open(part[i], a, b)) continue;
        const int next = beside(part[i], a, b);
        if (seen[static_cast<std::size_t>(next)]) continue;
        seen[static_cast<std::size_t>(next)] = true;
        part.push_back(next);
      }
    }
    return part;
  }

  std::optional<std::string> keep_the_largest_part() {
    std::vector<bool> seen(free_.size(), false);
    std::vector<int> largest;
    for (int at = 0; at < all(); ++at) {
      if (!free_[static_cast<std::size_t>(at)] || seen[static_cast<std::size_t>(at)]) continue;
      if (auto part = part_of(at, seen); part.size() > largest.size()) largest = std::move(part);
    }
    if (largest.empty()) return "nothing of the domain is free";
    const auto free = static_cast<double>(std::ranges::count(free_, true));
    if (static_cast<double>(largest.size()) < (1 - kMostCutOff) * free) {
      const double cell_m =
          std::max(grid_.size_m.x() / grid_.columns, grid_.size_m.y() / grid_.rows);
      return "its cells of " + std::to_string(cell_m) + " m show no way between its parts";
    }
    free_.assign(free_.size(), false);
    for (const int at : largest) free_[static_cast<std::size_t>(at)] = true;
    return std::nullopt;
  }

  void number_cells() {
    number_.assign(free_.size(), -1);
    for (int at = 0; at < all(); ++at) {
      if (!free_[static_cast<std::size_t>(at)]) continue;
      number_[static_cast<std::size_t>(at)] = grid_.cell_count();
      grid_.place.push_back(at);
    }
    for (const int at : grid_.place) {
      if (open(at, 1, 0)) grid_.doors_x.emplace_back(number(at), number(beside(at, 1, 0)));
      if (open(at, 0, 1)) grid_.doors_y.emplace_back(number(at), number(beside(at, 0, 1)));
    }
  }
  int number(int at) const { return number_[static_cast<std::size_t>(at)]; }

  /// The cell that a cell sees at (a, b): by one step, or by two around a corner.
  int seen_from(int at, int a, int b) const {
    const bool along_x = a != 0 && open(at, a, 0), along_y = b != 0 && open(at, 0, b);
    if (a != 0 && b != 0) {
      const bool over_x = along_x && open(beside(at, a, 0), 0, b);
      const bool over_y = along_y && open(beside(at, 0, b), a, 0);
      if (over_x || over_y) return beside(at, a, b);
    }
    if (along_x) return beside(at, a, 0);
    return along_y ? beside(at, 0, b) : at;
  }

  void set_around() {
    for (const int at : grid_.place) {
      for (int a = -1; a <= 1; ++a) {
        for (int b = -1; b <= 1; ++b) grid_.around.push_back(number(seen_from(at, a, b)));
      }
    }
  }

  void set_owners() {
    const std::vector<int> nearest = nearest_free_cells();
    const int parts_x = grid_.columns * kPartsPerCell, parts_y = grid_.rows * kPartsPerCell;
    grid_.owner.reserve(static_cast<std::size_t>(parts_x) * static_cast<std::size_t>(parts_y));
    for (int i = 0; i < parts_x; ++i) {
      for (int j = 0; j < parts_y; ++j) {
        const int at = i / kPartsPerCell * grid_.rows + j / kPartsPerCell;
        const Eigen::Vector2d x_m = at_m((i + 0.5) / kPartsPerCell, (j + 0.5) / kPartsPerCell);
        grid_.owner.push_back(number(owner_of(x_m, at, nearest)));
      }
    }
  }

  /// The nearest of the nine free cells around that a place sees; else the nearest free cell of
  /// all.
  int owner_of(const Eigen::Vector2d& x_m, int at, const std::vector<int>& nearest) const {
    int best = -1, best_seen = -1;
    double distance_m = 0, seen_m = 0;
    for (int a = -1; a <= 1; ++a) {
      for (int b = -1; b <= 1; ++b) {
        const int other = beside(at, a, b);
        if (other < 0 || !free_[static_cast<std::size_t>(other)]) continue;
        const double away_m = (middle_m(other) - x_m).norm();
        if (best < 0 || away_m < distance_m) best = other, distance_m = away_m;
        if (best_seen >= 0 && away_m >= seen_m) continue;
        if (sees_(x_m, middle_m(other))) best_seen = other, seen_m = away_m;
      }
    }
    if (best_seen >= 0) return best_seen;
    return best >= 0 ? best : nearest[static_cast<std::size_t>(at)];
  }

  /// The nearest free cell of each cell of the grid, by steps along the axes.
  std::vector<int> nearest_free_cells() const {
    std::vector<int> nearest(free_.size(), -1);
    std::vector<int> reached = {grid_.place.begin(), grid_.place.end()};
    for (const int at : reached) nearest[static_cast<std::size_t>(at)] = at;
    for (std::size_t i = 0; i < reached.size(); ++i) {
      const int at = reached[i];
      for (const auto& [a, b] : kBeside) {
        const int next = beside(at, a, b);
        if (next < 0 || nearest[static_cast<std::size_t>(next)] >= 0) continue;
        nearest[static_cast<std::size_t>(next)] = nearest[static_cast<std::size_t>(at)];
        reached.push_back(next);
      }
    }
    return nearest;
  }

  const Sees& sees_;
  const FreeRegion* const bodies_;  // null: points
  FreeGrid grid_;
  std::vector<bool> free_, open_x_, open_y_;  // to the next column, to the next row
  std::vector<int> number_;                   // of the free cells, else −1
};

}  // namespace

Result<FreeGrid> free_grid(const Box& domain, const Sees& sees, const FreeRegion* bodies) {
  Result<FreeGrid> grid = failure(std::string());
  for (const double along_side : kCellsAlongSide) {
    grid = GridBuilder(domain, along_side, sees, bodies).run();
    if (grid) return grid;
  }
  return bodies != nullptr ? free_grid(domain, sees, nullptr) : grid;
}

}  // namespace ergocast
