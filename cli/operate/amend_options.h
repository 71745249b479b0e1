// SPDX-License-Identifier: BSD-3-Clause
// The options of `ergocast amend`: what shall change, and when.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cli/record/new_end.h"
#include "cli/record/new_law.h"
#include "core/mission/search_note.h"
#include "runtime/process/program_options.h"
#include "scenario/parse/override_options.h"

namespace ergocast::cli {

struct AmendOptions : BusOptions {
  std::filesystem::path target;
  Overrides overrides;
  std::optional<double> delay_s;
  std::optional<EndWish> end;
  std::optional<std::int32_t> cancel;
  bool dry_run = false, list = false;
  std::filesystem::path zone;
  double zone_lasts_s = 0;
  bool force = false;
  std::vector<LawWish> law;
  std::optional<SearchNote> sighting, dismissal;
  std::string by;  // empty: user and host of this process
};

/// Adds all of them but those of BusOptions. Options that cannot stand together exclude each other.
void add_amend_options(CLI::App& command, AmendOptions& options);

/// Whether the command has nothing to do.
bool names_nothing(const AmendOptions& options);

}  // namespace ergocast::cli
