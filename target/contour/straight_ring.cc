// SPDX-License-Identifier: BSD-3-Clause
// Each corner of cells on the line has a gate, a short segment across the band. Between two
// neighbouring gates the band is a convex quadrilateral, and these do not overlap. So a ring whose
// corners are on gates, and whose edges pass the gates between them in order, stays in the band and
// does not touch itself. From each corner the ring goes straight on as far as it can.
//
// All coordinates are whole numbers of sixteenths of a cell, so every test is exact.
#include "target/contour/straight_ring.h"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <limits>

namespace ergocast {
namespace {

constexpr int kParts = 16;  // of a cell's side
/// Less than half a cell, so that bands on both sides of a cell are apart.
constexpr int kWithin = 7;
/// Where solid cells have only a corner in common, a bridge of this width on either side joins
/// them.
constexpr int kBridge = 2;

struct Vector {
  std::int64_t x, y;

  friend Vector operator-(Vector a, Vector b) { return {a.x - b.x, a.y - b.y}; }
};

/// Above 0 if `b` is to the left of `a`.
std::int64_t cross(Vector a, Vector b) { return a.x * b.y - a.y * b.x; }

/// The points corner + t · across, for low <= t <= high; positive is towards free.
struct Gate {
  CellCorner corner, across;
  int low, high;

  Vector point(int t) const {
    return {std::int64_t{corner.x} * kParts + std::int64_t{across.x} * t,
            std::int64_t{corner.y} * kParts + std::int64_t{across.y} * t};
  }
};

CellCorner to_the_right_of(CellCorner along) { return {along.y, -along.x}; }

class GateRow {
 public:
  GateRow(const CellRing& line, const CellGrid& cells, Straightening straightening)
      : cells_(cells), low_(straightening == Straightening::kOutwards ? 0 : -kWithin) {
    const std::size_t count = line.sides.size();
    for (std::size_t i = 0; i < count; ++i)
      gates_.push_back(gate(line.sides[(i + count - 1) % count].along, line.sides[i]));
    gates_.push_back(gates_.front());
  }

  const std::vector<Gate>& gates() const { return gates_; }

 private:
  bool solid(CellCorner cell) const {
    return cells_.has(cell.x, cell.y) && cells_.at(cell.x, cell.y) > 0;
  }

  Gate gate(CellCorner before, const CellSide& side) const {
    if (before == side.along) return {side.from, to_the_right_of(before), low_, kWithin};
    const CellCorner across = to_the_right_of(before) + to_the_right_of(side.along);
    const bool right_turn = side.along == to_the_right_of(before);
    const int low = side.pinched ? kBridge : low_;
    return {side.from, across, low,
            right_turn && is_open(side.from, across) ? kParts / 2 : kWithin};
  }

  /// Whether the free cell in the direction `across` of a corner is solid on the corner's two sides
  /// alone, so that the band may reach its middle.
  bool is_open(CellCorner corner, CellCorner across) const {
    const CellCorner cell{corner.x + (across.x - 1) / 2, corner.y + (across.y - 1) / 2};
    return !solid(cell + CellCorner{across.x, 0}) && !solid(cell + CellCorner{0, across.y}) &&
           !solid(cell + across);
  }

  const CellGrid& cells_;
  const int low_;
  std::vector<Gate> gates_;
};

/// What can be seen straight through gates from one point.
class View {
 public:
  explicit View(Vector from) : from_(from) {}

  /// Looks through one more gate; false if nothing of it can be seen.
  bool through(const Gate& gate) {
    const Vector left = gate.point(gate.low) - from_, right = gate.point(gate.high) - from_;
    if (cross(right, left) <= 0) return false;
    if (first_ || cross(left_, left) < 0) left_ = left;
    if (first_ || cross(right_, right) > 0) right_ = right;
    first_ = false;
    return cross(right_, left_) >= 0;
  }

  bool sees(Vector point) const {
    const Vector to = point - from_;
    return cross(right_, to) >= 0 && cross(left_, to) <= 0;
  }

 private:
  Vector from_, left_{}, right_{};
  bool first_ = true;
};

/// A corner of the ring on a gate, and the corner before it.
struct Corner {
  std::size_t gate;
  int t;
  std::size_t before;
};

class StraightWay {
 public:
  /// @param end_t  the place on the first gate at which the ring begins and ends
  StraightWay(const std::vector<Gate>& gates, int end_t) : gates_(gates), end_t_(end_t) {
    corners_.push_back({0, end_t, 0});
  }

  /// The corners from the last to the first.
  std::vector<Corner> run() {
    std::size_t begin = 0, end = 1;  // of the corners on the same gate
    while (corners_[begin].gate != gates_.size() - 1) {
      farthest_ = 0;
      for (std::size_t i = begin; i < end; ++i) look_from(i, end);
      begin = end;
      end = corners_.size();
    }
    std::vector<Corner> way;
    for (std::size_t i = corners_[begin].before; way.empty() || way.back().gate != 0;
         i = corners_[i].before)
      way.push_back(corners_[i]);
    return way;
  }

 private:
  /// Adds the places on the farthest gate that can be seen from corner `i`, unless an earlier
  /// corner has seen farther.
  void look_from(std::size_t i, std::size_t kept) {
    const std::size_t gate = corners_[i].gate;
    View view(gates_[gate].point(corners_[i].t));
    std::size_t farthest = 0;
    std::vector<int> seen;
    for (std::size_t next = gate + 1; next < gates_.size() && view.through(gates_[next]); ++next) {
      auto now = places(next, view);
      if (now.empty()) continue;
      farthest = next;
      seen = std::move(now);
    }
    if (farthest < farthest_) return;
    if (farthest > farthest_) corners_.resize(kept);
    farthest_ = farthest;
    for (const int t : seen) {
      const auto is_it = [&](const Corner& corner) { return corner.t == t; };
      if (std::none_of(corners_.begin() + static_cast<std::ptrdiff_t>(kept), corners_.end(), is_it))
        corners_.push_back({farthest, t, i});
    }
  }

  std::vector<int> places(std::size_t gate, const View& view) const {
    const Gate& one = gates_[gate];
    std::vector<int> seen;
    if (gate == gates_.size() - 1) {
      if (view.sees(one.point(end_t_))) seen.push_back(end_t_);
      return seen;
    }
    for (int t = one.low; t <= one.high; ++t)
      if (view.sees(one.point(t))) seen.push_back(t);
    return seen;
  }

  const std::vector<Gate>& gates_;
  const int end_t_;
  std::vector<Corner> corners_;
  std::size_t farthest_ = 0;
};

}  // namespace

Ring straight_ring(const CellRing& line, const CellGrid& cells, Straightening straightening) {
  const GateRow row(line, cells, straightening);
  const std::vector<Gate>& gates = row.gates();
  std::vector<Corner> best;
  for (const int t : {std::max(0, gates[0].low), gates[0].low, gates[0].high}) {
    auto way = StraightWay(gates, t).run();
    if (best.empty() || way.size() < best.size()) best = std::move(way);
  }
  Ring ring;
  for (auto corner = best.rbegin(); corner != best.rend(); ++corner) {
    const Vector at = gates[corner->gate].point(corner->t);
    ring.emplace_back(static_cast<double>(at.x) / kParts, static_cast<double>(at.y) / kParts);
  }
  return ring;
}

}  // namespace ergocast
