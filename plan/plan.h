// SPDX-License-Identifier: BSD-3-Clause
// The compiled plan: a Mission as bytes, which the coordinator distributes to all participants.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/mission/mission.h"

namespace ergocast {

/// The most bytes of a plan: what the parts of MISSION carry, team/messages.h.
inline constexpr std::size_t kMaxPlanBytes = std::size_t{512} * 1024;

/// The plan of `mission`, which names this program's version. Equal missions give equal bytes.
/// @pre within_limits(mission), plan/mission_limits.h: otherwise no receiver accepts the plan.
std::vector<std::byte> encode_plan(const Mission& mission);

/// The mission of a plan, bit for bit, within its limits. Returns an error for bytes that are no
/// plan, are of another version, break a limit, or differ from the encoding of their mission. Plans
/// come from the network.
Result<Mission> decode_plan(std::span<const std::byte> plan) noexcept;

/// Decodes a plan and adds the table of its modes, if it needs one, by provide_table() of
/// modes/provide.h. An error if this program has no table with that hash.
Result<Mission> decode_plan_with_table(std::span<const std::byte> plan) noexcept;

/// 32 hex digits that identify a plan: XXH3-128 of its bytes.
std::string plan_hash(std::span<const std::byte> plan);

}  // namespace ergocast
