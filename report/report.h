// SPDX-License-Identifier: BSD-3-Clause
// Makes the report of a run.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "core/base/result.h"
#include "core/mission/mission.h"

namespace ergocast {

inline constexpr const char* kReportFile = "report.html";

/// The content of report.html.
struct ReportPage {
  std::string html;
};

/// Makes the page from the run's trajectory.csv, metrics.csv and, if they exist, summary.json and
/// target_density.csv. An empty run and an incomplete last line are allowed. On failure, an error
/// with its place and remedy.
/// @param team  how the agents were over time, for the page (cli/team/recorded_team.h); may be
/// null
/// @pre `mission` is that of the run's plan.
Result<ReportPage> draw_report(const std::filesystem::path& run_dir, const Mission& mission,
                               const nlohmann::ordered_json& team);

/// The page's data of a record, or the error; see page.h.
Result<nlohmann::ordered_json> read_page_record(const std::filesystem::path& run_dir,
                                                const Mission& mission,
                                                const nlohmann::ordered_json& team);

/// Writes report.html into `run_dir`, as a whole or not at all. Nothing on success, otherwise the
/// error.
std::optional<std::string> write_report(const std::filesystem::path& run_dir,
                                        const Mission& mission, const nlohmann::ordered_json& team);

}  // namespace ergocast
