// SPDX-License-Identifier: BSD-3-Clause
// The compiled plan: a Mission as bytes, from whoever starts it to everybody who takes part.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "core/mission.h"

namespace ergocast {

/// The plan of `mission`, which names this program's version. Equal missions give equal bytes.
/// @pre within_limits(mission), core/mission_limits.h: else nobody takes the plan.
std::vector<std::byte> encode_plan(const Mission& mission);

/// The mission of a plan, bit for bit, within its limits. A sentence for bytes that are no plan,
/// are another version's, break a limit, or are not what encode_plan() writes of their mission:
/// plans come from the network.
std::variant<Mission, std::string> decode_plan(std::span<const std::byte> plan) noexcept;

/// 32 hex digits that name a plan: XXH3-128 of its bytes.
std::string plan_hash(std::span<const std::byte> plan);

}  // namespace ergocast
