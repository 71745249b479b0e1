// SPDX-License-Identifier: BSD-3-Clause
// The report of a run: what a person looks at.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/mission.h"

namespace ergocast {

inline constexpr const char* kReportFile = "report.html";

/// A file of the report: its path within the run directory, and what stands in it.
struct ReportFile {
  std::filesystem::path path;
  std::string text;
};

/// report.html and figures/*.svg as the run's trajectory.csv, metrics.csv and, if they are there,
/// summary.json and target_density.csv make them. An empty run and a torn last line are fine.
/// Otherwise what is wrong, where, and what to do about it.
/// @pre `mission` is that of the run's plan.
std::variant<std::vector<ReportFile>, std::string> draw_report(const std::filesystem::path& run_dir,
                                                               const Mission& mission);

/// Writes them into `run_dir`; replaces what is there, each file at once or not at all. Nothing on
/// success, otherwise what is wrong.
std::optional<std::string> write_report(const std::filesystem::path& run_dir,
                                        const Mission& mission);

}  // namespace ergocast
