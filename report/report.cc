// SPDX-License-Identifier: BSD-3-Clause
// Reads record, summary and target, and writes the page.
#include "report/report.h"

#include "logger/run_data.h"
#include "logger/run_record.h"
#include "logger/summary.h"
#include "report/page.h"
#include "report/target_density.h"

namespace ergocast {
namespace {

namespace fs = std::filesystem;

struct Record {
  RunData run;
  nlohmann::ordered_json summary;
  Field target;
};

std::variant<Record, std::string> read_record(const fs::path& run_dir) {
  auto run = read_run(run_dir);
  if (auto* problem = std::get_if<std::string>(&run)) return std::move(*problem);
  auto summary = read_summary(run_dir);
  if (auto* problem = std::get_if<std::string>(&summary)) return std::move(*problem);
  auto target = read_target_density(run_dir / kTargetDensityFile);
  if (auto* problem = std::get_if<std::string>(&target)) return std::move(*problem);
  return Record{std::get<RunData>(std::move(run)),
                std::get<nlohmann::ordered_json>(std::move(summary)),
                std::get<Field>(std::move(target))};
}

}  // namespace

std::variant<ReportPage, std::string> draw_report(const fs::path& run_dir, const Mission& mission,
                                                  const nlohmann::ordered_json& team) {
  auto read = read_record(run_dir);
  if (auto* problem = std::get_if<std::string>(&read)) return std::move(*problem);
  const auto& [run, summary, target] = std::get<Record>(read);
  return ReportPage{report_page(run, mission, summary, target, team)};
}

std::variant<nlohmann::ordered_json, std::string> read_page_record(
    const fs::path& run_dir, const Mission& mission, const nlohmann::ordered_json& team) {
  auto read = read_record(run_dir);
  if (auto* problem = std::get_if<std::string>(&read)) return std::move(*problem);
  const auto& [run, summary, target] = std::get<Record>(read);
  return page_record(run, mission, summary, target, team);
}

std::optional<std::string> write_report(const fs::path& run_dir, const Mission& mission,
                                        const nlohmann::ordered_json& team) {
  const auto drawn = draw_report(run_dir, mission, team);
  if (const auto* problem = std::get_if<std::string>(&drawn)) return *problem;
  return write_file(run_dir / kReportFile, std::get<ReportPage>(drawn).html);
}

}  // namespace ergocast
