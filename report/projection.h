// SPDX-License-Identifier: BSD-3-Clause
// A mission seen along one axis: a mission in a plane, which figures draw.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/mission.h"
#include "logger/run_data.h"

namespace ergocast {

/// The axes of space that are seen; x and y for a mission in a plane.
struct View {
  int across = 0, up = 1;

  /// "x", "y" or "z".
  std::string across_name() const { return {"xyz"[across]}; }
  std::string up_name() const { return {"xyz"[up]}; }
  /// What the names of its figures end with: "", "_xz" or "_yz".
  std::string ending() const { return up == 1 ? "" : '_' + across_name() + up_name(); }
};

/// From above alone for a plane; in a box also from the side and from the front.
std::vector<View> views_of(const Box& domain);

/// The mission in the plane of the view. Its target is the average along the axis that is not seen,
/// which leaves the modes without waves along it; so does the coverage of the same mission.
Mission projected(const Mission& mission, const View& view);
Coefficients projected(const Coefficients& coefficients, const Basis& basis, const View& view);

/// Its tracks; the rest of the record is left out.
RunData projected(const RunData& run, const View& view);

}  // namespace ergocast
