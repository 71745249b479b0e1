// SPDX-License-Identifier: BSD-3-Clause
// Which modes travel in which block of a contribution, and in which order.
//
// Usually all travel in the order of the basis (core/basis/basis.h), and blocks are full. With a
// high_mode_period_factor above 1 they travel by ascending |k|, those of one |k| in the order of
// the basis. The first block then ends after kLowModes, because the others are sent less often.
//
// A slot is the place of a mode in the order of the wire: block b begins at slot b · block_size(),
// also after a shorter first block.
// Tables and forecasts add up slots. Only here a slot becomes a mode of the basis, or the reverse.
#pragma once

#include <vector>

#include "core/base/contribution.h"
#include "core/basis/basis.h"

namespace ergocast {

struct Mission;

/// Whether the modes above the kLowModes lowest ones are sent less often.
bool separates_low_modes(const Mission& mission);

/// Into how many blocks the modes of a mission fall.
int block_count_of(const Mission& mission);

class BlockLayout {
 public:
  /// Consecutive slots.
  struct Slots {
    int first, count;
  };

  /// All modes in the order of the basis.
  BlockLayout(const Basis& basis, ContributionEncoding encoding);
  /// The layout that the mission asks for.
  explicit BlockLayout(const Mission& mission);

  ContributionEncoding encoding() const { return encoding_; }
  int block_size() const { return block_size_of(encoding_); }
  int block_count() const { return block_count_; }

  /// Whether mode k of the basis has slot k.
  bool in_basis_order() const { return mode_by_rank_.empty(); }

  /// The slots of a block that have a mode.
  Slots slots_of(int block) const;
  /// How many numbers a block has on the wire; those without a mode are 0.
  int size_of(int block) const {
    return block == 0 && !in_basis_order() ? kLowModes : block_size();
  }
  /// The number of slots up to the last one that has a mode.
  int slot_count() const;

  /// The numbers of the basis's modes, each in its slot; slots without a mode stay what they are.
  /// @pre not in_basis_order()
  void to_slots(const double* modes, double* slots) const;
  /// The reverse.
  /// @pre not in_basis_order()
  void from_slots(const double* slots, double* modes) const;

 private:
  template <class Each>
  void for_each_mode(const Each& each) const;

  ContributionEncoding encoding_;
  int mode_count_, block_count_;
  std::vector<int> mode_by_rank_;  // by ascending |k|; empty: in the order of the basis
};

}  // namespace ergocast
