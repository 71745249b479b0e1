// SPDX-License-Identifier: BSD-3-Clause
// Shipped missions for tests of the method itself.
#pragma once

#include <algorithm>
#include <filesystem>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core/ideal_team.h"
#include "scenario/scenario.h"

namespace ergocast::test {

/// A shipped scenario's mission; fails loudly if the file has problems.
inline Mission shipped_mission(const std::string& name, const Overrides& overrides = {}) {
  const auto file = std::filesystem::path(ERGOCAST_SCENARIO_DIR) / (name + ".textproto");
  return std::get<Scenario>(Scenario::load(file, overrides)).mission();
}

/// The probability that a test fails with other seeds although its statement is true.
inline constexpr double kError = 1e-9;

using PaperTeam = lab::IdealTeam;

inline double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace ergocast::test
