// SPDX-License-Identifier: BSD-3-Clause
// Missions that steer by the modes of their free domain: their target.
#pragma once

#include <optional>
#include <string>

#include "core/mission/mission.h"
#include "target/density_picture.h"

namespace ergocast {

/// Gives a mission with basis.free_domain, whose μ is that of the cosines, its table and its own μ:
/// μ_k = ∫ e_k ρ, each cell of `density` with the value of e_k in its middle.
/// @return  why it cannot, as a sentence; nothing for a mission without free domain
std::optional<std::string> use_free_domain(const DensityGrid& density, Mission& mission);

}  // namespace ergocast
