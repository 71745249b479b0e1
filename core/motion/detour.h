// SPDX-License-Identifier: BSD-3-Clause
// A way round bodies that stand for good, because no agent drives them any more.
//
// The filter (core/motion/separation.h) lets a body slide along one such body. Two of them that are
// too near to each other to pass between form a pocket, from which the straight way never leads
// out. Each body is a disc that the own anchor keeps out of. If discs are in the straight way, the
// agent turns its way to one side until no disc is in it, the side to which it has to turn less. It
// keeps that side until the straight way is free. If it gets hardly further, as between a disc and
// an edge, it tries the other side.
//
// This changes the way that the filter is asked for, not what the filter allows. A disc that the
// end of the way lies in does not count: the filter holds the body beside it.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace ergocast {

class Detour {
 public:
  /// @param patience_ticks  for how many ticks it may get hardly further
  /// @param step_m  the way of an undisturbed tick
  Detour(std::int64_t patience_ticks, double step_m)
      : patience_ticks_(patience_ticks), step_m_(step_m) {}

  /// Forgets all bodies. Up to `count` of them do not allocate.
  void begin(std::size_t count) {
    discs_.clear();
    discs_.reserve(count);
  }
  /// @param kept_m  the distance that the own anchor keeps from it
  void add(const Eigen::Vector2d& center_m, double kept_m) { discs_.push_back({center_m, kept_m}); }

  /// The way to take in a tick from `x_m`, where the straight way is `way_m`: that bit for bit if
  /// it is free or all ways end at bodies, else one as long in a free direction. It depends on
  /// earlier calls. Only + − × ÷ √. Does not allocate.
  Eigen::Vector2d round(const Eigen::Vector2d& x_m, const Eigen::Vector2d& way_m);

 private:
  struct Disc {
    Eigen::Vector2d center_m;
    double kept_m;
  };
  const Disc* in_the_way(const Eigen::Vector2d& x_m, const Eigen::Vector2d& way_m,
                         const Eigen::Vector2d& direction, bool straight) const;
  std::optional<Eigen::Vector2d> turned(const Eigen::Vector2d& x_m, const Eigen::Vector2d& way_m,
                                        double side) const;
  void choose_side(const Eigen::Vector2d& x_m, const Eigen::Vector2d& way_m);

  std::int64_t patience_ticks_;
  double step_m_;
  std::vector<Disc> discs_;
  double side_ = 0;  // 1: it turns to the left; 0: the straight way was free
  std::int64_t ticks_ = 0;
  Eigen::Vector2d from_m_{0, 0};  // where it was `ticks_` ago
};

}  // namespace ergocast
