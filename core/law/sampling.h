// SPDX-License-Identifier: BSD-3-Clause
// What one step of an agent at a place adds to its row, g f dt, as a forecast computes it for
// teammates.
#pragma once

#include "core/base/geometry.h"
#include "core/base/line_aligned.h"
#include "core/basis/basis.h"
#include "core/law/block_layout.h"
#include "core/law/forecast_sums.h"
#include "core/mission/kinds.h"
#include "core/mission/mission.h"

namespace ergocast {

class Sampling {
 public:
  explicit Sampling(const Mission& mission);

  const Box& domain() const { return domain_; }
  const Basis& basis() const { return basis_; }
  double dt_s() const { return dt_s_; }
  const BlockLayout& layout() const { return layout_; }
  /// Whether all sensors are alike, the usual case.
  bool uniform() const { return uniform_; }

  /// g of a kind in the order of the basis; null if all are 1.
  const double* footprint(int kind) const {
    return uniform_ ? nullptr : sensors_.of(kind).footprint();
  }
  /// The gain of an agent of `kind`, in the order of the basis. It refers to `at` and to this.
  sums::PlaceGain gain(const CosinesAt& at, int kind) const {
    return {at, basis_, dt_s_, footprint(kind)};
  }
  /// The gain of every mode in its slot. `slots` has a number for each slot.
  /// @pre not layout().in_basis_order()
  void set_in_slots(const CosinesAt& at, int kind, double* slots);

 private:
  Box domain_;
  Basis basis_;
  double dt_s_;
  BlockLayout layout_;
  Sensors sensors_;
  bool uniform_;
  AlignedDoubles by_mode_;  // before they are sorted into slots; empty where slots are modes
};

}  // namespace ergocast
