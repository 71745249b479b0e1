// The compiled plan's bytes.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "core/basis.h"
#include "scenario/scenario.pb.h"

namespace ergocast {

/// A plan taken apart, its numbers not yet checked.
struct Plan {
  proto::Scenario scenario;
  Coefficients target_coefficients;
};

/// Equal arguments give equal bytes.
std::vector<std::byte> encode_plan(const proto::Scenario& scenario, const Coefficients& target);

/// Nothing for bytes that are no plan or another version's, or whose μ has not one entry for each
/// mode. A μ that comes back is one: finite, |μ| ≤ 1, μ_00 = 1.
std::optional<Plan> parse_plan(std::span<const std::byte> bytes);

}  // namespace ergocast
