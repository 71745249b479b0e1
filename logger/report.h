// The report of a run: what a person looks at.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "core/mission.h"
#include "core/target.h"

namespace ergocast {

/// Writes report.html and figures/*.svg into `run_dir` from its trajectory.csv, metrics.csv and,
/// if there is one, summary.json; replaces what is there, each file at once or not at all. An
/// empty run and a torn last line are fine. Nothing on success, otherwise what is wrong, where,
/// and what to do about it.
/// @pre `mission` and `target` are those of the run's scenario.
std::optional<std::string> write_report(const std::filesystem::path& run_dir,
                                        const Mission& mission, const TargetDensity& target);

}  // namespace ergocast
