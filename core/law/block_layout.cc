// SPDX-License-Identifier: BSD-3-Clause
// Sorts the modes by |k|, and leaves the rest of the first block empty.
#include "core/law/block_layout.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "core/base/require.h"
#include "core/mission/mission.h"

namespace ergocast {
namespace {

/// The modes of a free domain already ascend.
int squared_wave_number(const Basis& basis, int mode) {
  if (basis.free_domain) return mode;
  const int n = mode % basis.modes_y, m = mode / basis.modes_y % basis.modes_x;
  const int l = mode / basis.modes_y / basis.modes_x;
  return l * l + m * m + n * n;
}

}  // namespace

bool separates_low_modes(const Mission& mission) {
  return mission.timing.high_mode_period_factor > 1 && mission.basis.mode_count() > kLowModes;
}

int block_count_of(const Mission& mission) {
  const ContributionEncoding encoding = mission.timing.contribution_encoding;
  const int modes = mission.basis.mode_count();
  return separates_low_modes(mission) ? 1 + block_count_of(modes - kLowModes, encoding)
                                      : block_count_of(modes, encoding);
}

BlockLayout::BlockLayout(const Basis& basis, ContributionEncoding encoding)
    : encoding_(encoding),
      mode_count_(basis.mode_count()),
      block_count_(block_count_of(mode_count_, encoding)) {}

BlockLayout::BlockLayout(const Mission& mission)
    : BlockLayout(mission.basis, mission.timing.contribution_encoding) {
  if (!separates_low_modes(mission)) return;
  block_count_ = block_count_of(mission);
  mode_by_rank_.resize(static_cast<std::size_t>(mode_count_));
  std::iota(mode_by_rank_.begin(), mode_by_rank_.end(), 0);
  std::ranges::sort(mode_by_rank_, {}, [&](int mode) {
    return std::pair(squared_wave_number(mission.basis, mode), mode);
  });
}

BlockLayout::Slots BlockLayout::slots_of(int block) const {
  const int first = block * block_size();
  if (in_basis_order()) return {first, std::min(block_size(), mode_count_ - first)};
  if (block == 0) return {0, size_of(block)};
  const int before = kLowModes + first - block_size();
  return {first, std::min(block_size(), mode_count_ - before)};
}

int BlockLayout::slot_count() const {
  const Slots last = slots_of(block_count_ - 1);
  return last.first + last.count;
}

/// Calls each(mode of the basis, its slot).
template <class Each>
void BlockLayout::for_each_mode(const Each& each) const {
  ERGOCAST_REQUIRE(!in_basis_order());
  for (int block = 0, rank = 0; block < block_count_; ++block) {
    const Slots slots = slots_of(block);
    for (int i = 0; i < slots.count; ++i, ++rank)
      each(mode_by_rank_[static_cast<std::size_t>(rank)], slots.first + i);
  }
}

void BlockLayout::to_slots(const double* modes, double* slots) const {
  for_each_mode([=](int mode, int slot) { slots[slot] = modes[mode]; });
}

void BlockLayout::from_slots(const double* slots, double* modes) const {
  for_each_mode([=](int mode, int slot) { modes[mode] = slots[slot]; });
}

}  // namespace ergocast
