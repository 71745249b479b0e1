// SPDX-License-Identifier: BSD-3-Clause
// Where slots are not modes, f is computed as a whole and then sorted.
#include "core/law/sampling.h"

namespace ergocast {

Sampling::Sampling(const Mission& mission)
    : domain_(mission.domain),
      basis_(mission.basis),
      dt_s_(mission.timing.dt_s),
      layout_(mission),
      sensors_(mission),
      uniform_(sensors_.uniform()) {
  if (!layout_.in_basis_order()) by_mode_.resize(static_cast<std::size_t>(basis_.mode_count()));
}

void Sampling::set_in_slots(const CosinesAt& at, int kind, double* slots) {
  sums::set_gains(gain(at, kind), {0, basis_.mode_count()}, by_mode_.data());
  layout_.to_slots(by_mode_.data(), slots);
}

}  // namespace ergocast
