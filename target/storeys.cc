// SPDX-License-Identifier: BSD-3-Clause
// Cuts the domain's height where a keep-out begins or ends.
#include "target/storeys.h"

#include <algorithm>

namespace ergocast {
namespace {

Storey storey_of(const Heights& heights, bool planar, std::span<const KeepOut> keep_outs) {
  Storey storey{heights, {}};
  for (const KeepOut& keep_out : keep_outs) {
    const Heights& stands = keep_out.heights;
    if (planar || (stands.low_m <= heights.low_m && stands.high_m >= heights.high_m))
      storey.keep_outs.push_back(keep_out.polygon);
  }
  return storey;
}

}  // namespace

std::vector<Storey> storeys_of(double height_m, std::span<const KeepOut> keep_outs) {
  const Heights all{0, height_m};
  if (height_m == 0) return {storey_of(all, true, keep_outs)};
  std::vector<double> levels_m{all.low_m, all.high_m};
  for (const KeepOut& keep_out : keep_outs) {
    for (const double z_m : {keep_out.heights.low_m, keep_out.heights.high_m})
      if (all.contain(z_m)) levels_m.push_back(z_m);
  }
  std::sort(levels_m.begin(), levels_m.end());
  levels_m.erase(std::unique(levels_m.begin(), levels_m.end()), levels_m.end());
  std::vector<Storey> storeys;
  for (std::size_t i = 1; i < levels_m.size(); ++i)
    storeys.push_back(storey_of({levels_m[i - 1], levels_m[i]}, false, keep_outs));
  return storeys;
}

}  // namespace ergocast
