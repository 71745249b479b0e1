// SPDX-License-Identifier: BSD-3-Clause
// Floods the free cells of a grid, starting from each cell that no flood has reached.
#include "core/motion/free_region.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <queue>
#include <utility>

#include "core/base/portable_math.h"
#include "core/motion/walls.h"

namespace ergocast {
namespace {

constexpr double kFewestCells = 16;
constexpr double kLeastPart = 1e-3;
constexpr int kNotFree = -1, kUnreached = -2;
/// Two ways whose lengths differ by a smaller factor than this are equally short: rounding alone
/// makes that difference.
constexpr double kSameWay = 1 + 1e-9;

struct Offset {
  int column, row;
};
/// Each of the last four is opposite to one of the first four, in the same order.
constexpr std::array<Offset, 8> kNeighbours = {
    {{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}}};

}  // namespace

FreeRegion::FreeRegion(const IndexedRings& walls, const Box& domain, double kept_m, int cells)
    : domain_(domain) {
  const Eigen::Vector2d size_m = domain.size_m.head<2>();
  const Eigen::Vector2d counts = (size_m / size_m.maxCoeff() * cells).cwiseMax(kFewestCells);
  columns_ = static_cast<int>(std::lround(counts.x()));
  rows_ = static_cast<int>(std::lround(counts.y()));
  for (int cell = 0; cell < this->cells(); ++cell) {
    clearance_m_.push_back(ergocast::clearance_m(walls, center_m(cell)));
    part_.push_back(clearance_m_.back() >= kept_m ? kUnreached : kNotFree);
  }
  for (std::size_t i = 0; i < kNeighbours.size(); ++i) {
    steps_m_[i] = portable::hypot(kNeighbours[i].column * size_m.x() / columns_,
                                  kNeighbours[i].row * size_m.y() / rows_);
  }
  join(walls, kept_m);
  for (int cell = 0; cell < this->cells(); ++cell) {
    if (part_[static_cast<std::size_t>(cell)] != kUnreached) continue;
    sizes_.push_back(0);
    grow(cell, static_cast<int>(sizes_.size()) - 1);
  }
  sort_parts();
}

Eigen::Vector2d FreeRegion::center_m(int cell) const {
  const int column = cell % columns_, row = cell / columns_;
  const Eigen::Vector2d share((column + 0.5) / columns_, (row + 0.5) / rows_);
  return domain_.origin_m.head<2>() + share.cwiseProduct(domain_.size_m.head<2>());
}

int FreeRegion::cell_at(const Eigen::Vector2d& x_m) const {
  const Eigen::Vector2d share =
      (x_m - domain_.origin_m.head<2>()).cwiseQuotient(domain_.size_m.head<2>());
  const int column = std::clamp(static_cast<int>(share.x() * columns_), 0, columns_ - 1);
  const int row = std::clamp(static_cast<int>(share.y() * rows_), 0, rows_ - 1);
  return row * columns_ + column;
}

bool FreeRegion::joined(const IndexedRings& walls, int from, int to, double kept_m) const {
  const Segment way{center_m(from), center_m(to)};
  const double spare_m = clearance_m_[static_cast<std::size_t>(from)] - kept_m;
  if (spare_m * spare_m > (way.to_m - way.from_m).squaredNorm()) return true;
  return is_clear(walls, way, kept_m);
}

/// Each pair of neighbours once: a bit and the opposite one.
void FreeRegion::join(const IndexedRings& walls, double kept_m) {
  joins_.assign(part_.size(), 0);
  for (int cell = 0; cell < cells(); ++cell) {
    for (std::size_t i = 0; i < kNeighbours.size() / 2; ++i) {
      const int column = cell % columns_ + kNeighbours[i].column;
      const int row = cell / columns_ + kNeighbours[i].row;
      if (column < 0 || column >= columns_ || row < 0 || row >= rows_) continue;
      const int next = row * columns_ + column;
      const auto one = static_cast<std::size_t>(cell), other = static_cast<std::size_t>(next);
      if (part_[one] == kNotFree || part_[other] == kNotFree) continue;
      if (!joined(walls, cell, next, kept_m)) continue;
      joins_[one] = static_cast<std::uint8_t>(joins_[one] | 1U << i);
      joins_[other] = static_cast<std::uint8_t>(joins_[other] | 1U << (i + kNeighbours.size() / 2));
    }
  }
}

void FreeRegion::for_joined(int cell, auto&& each) const {
  for (std::size_t i = 0; i < kNeighbours.size(); ++i) {
    if ((joins_[static_cast<std::size_t>(cell)] >> i & 1) != 0)
      each(cell + kNeighbours[i].row * columns_ + kNeighbours[i].column, steps_m_[i]);
  }
}

void FreeRegion::grow(int seed, int part) {
  std::vector<int> front = {seed};
  part_[static_cast<std::size_t>(seed)] = part;
  while (!front.empty()) {
    const int cell = front.back();
    front.pop_back();
    ++sizes_[static_cast<std::size_t>(part)];
    for_joined(cell, [&](int next, double) {
      int& its = part_[static_cast<std::size_t>(next)];
      if (its != kUnreached) return;
      its = part;
      front.push_back(next);
    });
  }
}

std::vector<double> FreeRegion::ways_m(int from) const { return ways_m({from}, {}); }

std::vector<double> FreeRegion::ways_m(const std::vector<int>& from,
                                       const std::vector<bool>& crossed) const {
  std::vector<double> ways(part_.size(), std::numeric_limits<double>::infinity());
  using Reached = std::pair<double, int>;
  std::priority_queue<Reached, std::vector<Reached>, std::greater<>> front;
  for (const int cell : from) {
    ways[static_cast<std::size_t>(cell)] = 0;
    front.emplace(0, cell);
  }
  while (!front.empty()) {
    const auto [way_m, cell] = front.top();
    front.pop();
    if (way_m > ways[static_cast<std::size_t>(cell)]) continue;
    const double so_far_m = way_m;
    for_joined(cell, [&](int next, double step_m) {
      if (!crossed.empty() && !crossed[static_cast<std::size_t>(next)]) return;
      const double longer_m = so_far_m + step_m;
      double& its_m = ways[static_cast<std::size_t>(next)];
      if (longer_m >= its_m) return;
      its_m = longer_m;
      front.emplace(longer_m, next);
    });
  }
  return ways;
}

bool FreeRegion::has_way(int from, int to, double most_m) const {
  std::vector<std::pair<double, int>> reached = {{0, from}};  // the shortest way to each cell
  for (std::size_t i = 0; i < reached.size(); ++i) {
    std::swap(reached[i],
              *std::min_element(reached.begin() + static_cast<std::ptrdiff_t>(i), reached.end()));
    const auto [way_m, cell] = reached[i];
    if (cell == to) return true;
    const double so_far_m = way_m;
    for_joined(cell, [&](int next, double step_m) {
      const double longer_m = so_far_m + step_m;
      if (longer_m > most_m) return;
      const auto at = std::ranges::find(reached, next, &std::pair<double, int>::second);
      if (at == reached.end()) {
        reached.emplace_back(longer_m, next);
      } else {
        at->first = std::min(at->first, longer_m);
      }
    });
  }
  return false;
}

int FreeRegion::nearer(const std::vector<double>& ways_m, int cell) const {
  int best = cell;
  double best_m = std::numeric_limits<double>::infinity(), best_step_m = 0;
  const double way_m = ways_m[static_cast<std::size_t>(cell)];
  for_joined(cell, [&](int next, double step_m) {
    const double its_m = ways_m[static_cast<std::size_t>(next)], through_m = its_m + step_m;
    if (its_m >= way_m || through_m >= kSameWay * best_m) return;
    if (through_m * kSameWay > best_m && step_m <= best_step_m) return;
    best_m = through_m;
    best_step_m = step_m;
    best = next;
  });
  return best;
}

std::optional<int> FreeRegion::free_cell_near(const Eigen::Vector2d& x_m) const {
  std::optional<int> best;
  double best_m2 = std::numeric_limits<double>::infinity();
  for_cells_near(x_m, [&](int cell) {
    const double apart_m2 = (center_m(cell) - x_m).squaredNorm();
    if (apart_m2 >= best_m2) return;
    best_m2 = apart_m2;
    best = cell;
  });
  return best;
}

/// Sorts the parts, the largest first. The cells of parts that are too small then belong to no
/// part.
void FreeRegion::sort_parts() {
  std::vector<int> order(sizes_.size());
  std::iota(order.begin(), order.end(), 0);
  const auto size = [&](int part) { return sizes_[static_cast<std::size_t>(part)]; };
  std::ranges::stable_sort(order, [&](int a, int b) { return size(a) > size(b); });
  const int all = std::accumulate(sizes_.begin(), sizes_.end(), 0);
  std::vector<int> rank(sizes_.size(), kNotFree), sizes;
  for (const int part : order) {
    if (size(part) < kLeastPart * all) continue;
    rank[static_cast<std::size_t>(part)] = static_cast<int>(sizes.size());
    sizes.push_back(size(part));
  }
  for (int& part : part_) part = part < 0 ? kNotFree : rank[static_cast<std::size_t>(part)];
  sizes_ = std::move(sizes);
}

double FreeRegion::free_share() const {
  return std::accumulate(sizes_.begin(), sizes_.end(), 0.0) / cells();
}

double FreeRegion::share_of(int part) const {
  return sizes_[static_cast<std::size_t>(part)] /
         std::accumulate(sizes_.begin(), sizes_.end(), 0.0);
}

std::optional<int> FreeRegion::part_at(const Eigen::Vector2d& x_m) const {
  const int part = part_[static_cast<std::size_t>(cell_at(x_m))];
  return part < 0 ? std::nullopt : std::optional(part);
}

Eigen::Vector2d FreeRegion::middle_m(int part) const {
  int best = -1;
  for (int cell = 0; cell < cells(); ++cell) {
    const auto i = static_cast<std::size_t>(cell);
    if (part_[i] != part) continue;
    if (best < 0 || clearance_m_[i] > clearance_m_[static_cast<std::size_t>(best)]) best = cell;
  }
  return center_m(best);
}

}  // namespace ergocast
