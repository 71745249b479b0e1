// SPDX-License-Identifier: BSD-3-Clause
// New targets and zones that a simulated coordinator knows from the beginning: `ergocast simulate
// --amend`.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <vector>

#include "core/mission/amendments.h"
#include "scenario/scenario.h"

namespace ergocast::cli {

struct PlannedTarget {
  double t_s = 0;  ///< mission time from which it holds
  std::filesystem::path file;
  std::string flag;                              ///< as written, for problems
  std::optional<double> lasts_s = std::nullopt;  ///< of a zone; nothing: until the end, or a target
};

/// --amend T:FILE, and T+TIME:FILE for a zone.
CLI::Option* add_amend_option(CLI::App& command, std::vector<PlannedTarget>& planned);

/// The amendments with these targets and zones. If one of them or its time has a problem, prints it
/// and returns nothing.
/// @param file  of the scenario, which has its origin
std::optional<Amendments> amendments_with(const std::vector<PlannedTarget>& planned,
                                          const Scenario& scenario,
                                          const std::filesystem::path& file);

}  // namespace ergocast::cli
