// The report of a run: what a person looks at.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "core/mission.h"

namespace ergocast {

/// Writes report.html and figures/*.svg into `run_dir` from its trajectory.csv, metrics.csv and, if
/// they are there, summary.json and target_density.csv; replaces what is there, each file at once or
/// not at all. An empty run and a torn last line are fine. Nothing on success, otherwise what is
/// wrong, where, and what to do about it.
/// @pre `mission` is that of the run's plan.
std::optional<std::string> write_report(const std::filesystem::path& run_dir,
                                        const Mission& mission);

}  // namespace ergocast
