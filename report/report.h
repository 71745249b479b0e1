// SPDX-License-Identifier: BSD-3-Clause
// Makes the report of a run.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/mission.h"

namespace ergocast {

inline constexpr const char* kReportFile = "report.html";

/// A file of the report: its path within the run directory, and its content.
struct ReportFile {
  std::filesystem::path path;
  std::string text;
};

/// Draws report.html and figures/*.svg from the run's trajectory.csv, metrics.csv and, if they
/// exist, summary.json and target_density.csv. An empty run and an incomplete last line are
/// allowed. On failure, an error with its place and remedy.
/// @param team  the agents' states over time, for the page (cli/recorded_team.h); may be null
/// @pre `mission` is that of the run's plan.
std::variant<std::vector<ReportFile>, std::string> draw_report(const std::filesystem::path& run_dir,
                                                               const Mission& mission,
                                                               const nlohmann::ordered_json& team);

/// The page's data of a record, or the error; see page.h.
std::variant<nlohmann::ordered_json, std::string> read_page_record(
    const std::filesystem::path& run_dir, const Mission& mission,
    const nlohmann::ordered_json& team);

/// Writes the report's files into `run_dir` and replaces existing files, each completely or not at
/// all. Returns nullopt on success, otherwise the error.
std::optional<std::string> write_report(const std::filesystem::path& run_dir,
                                        const Mission& mission, const nlohmann::ordered_json& team);

}  // namespace ergocast
