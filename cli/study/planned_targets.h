// SPDX-License-Identifier: BSD-3-Clause
// New targets, zones, ends, laws, sightings and dismissals that a simulated coordinator knows from
// the beginning: `ergocast simulate --amend`, `--end`, `--law`, `--sighting` and `--dismiss`.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <vector>

#include "cli/record/new_end.h"
#include "cli/record/new_law.h"
#include "core/mission/amendments.h"
#include "scenario/scenario.h"

namespace ergocast::cli {

struct PlannedAmendment {
  double t_s = 0;                    ///< mission time from which it holds
  std::filesystem::path file{};      ///< a target or a zone
  std::optional<EndWish> end{};      ///< in the place of a file
  std::optional<LawWish> law{};      ///< in the place of a file
  std::optional<SearchNote> note{};  ///< in the place of a file
  std::optional<double> lasts_s{};   ///< of a zone; nothing: until the end, or no zone
  std::string flag;                  ///< as written, for problems
};

/// --amend T:FILE, and T+TIME:FILE for a zone.
CLI::Option* add_amend_option(CLI::App& command, std::vector<PlannedAmendment>& planned);

/// --end T:TIME.
CLI::Option* add_end_option(CLI::App& command, std::vector<PlannedAmendment>& planned);

/// --law T:FIELD=VALUE.
CLI::Option* add_law_option(CLI::App& command, std::vector<PlannedAmendment>& planned);

/// --sighting T:X,Y[,SIGMA_M[,SHARE]] and --dismiss T:X,Y.
void add_search_options(CLI::App& command, std::vector<PlannedAmendment>& planned,
                        CLI::Option* excluded);

/// These amendments as a list. If one of them or its time has a problem, prints it and returns
/// nothing. Whether agents reach their stations before an earlier end is not checked.
/// @param file  of the scenario, which has its origin
std::optional<Amendments> amendments_with(const std::vector<PlannedAmendment>& planned,
                                          const Scenario& scenario,
                                          const std::filesystem::path& file);

}  // namespace ergocast::cli
