// SPDX-License-Identifier: BSD-3-Clause
// The compiled plan's bytes.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <variant>
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

/// A sentence for bytes that are no plan or another version's, or whose μ has not one entry for each
/// mode. A μ that comes back is one: finite, |μ| ≤ 1, μ_00 = 1.
std::variant<Plan, std::string> parse_plan(std::span<const std::byte> bytes);

/// What is wrong with a plan that only claims to be of this version.
std::string broken_plan();

}  // namespace ergocast
