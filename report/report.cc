// SPDX-License-Identifier: BSD-3-Clause
// Reads record, summary and target, draws the figures, and writes them and the page.
#include "report/report.h"

#include "logger/run_data.h"
#include "logger/run_record.h"
#include "logger/summary.h"
#include "report/figures.h"
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

std::variant<std::vector<ReportFile>, std::string> draw_report(const fs::path& run_dir,
                                                               const Mission& mission,
                                                               const nlohmann::ordered_json& team) {
  auto read = read_record(run_dir);
  if (auto* problem = std::get_if<std::string>(&read)) return std::move(*problem);
  const auto& [run, summary, target] = std::get<Record>(read);
  std::vector<ReportFile> files;
  for (const Figure& figure : draw_figures(run, mission, target)) {
    files.push_back({fs::path("figures") / (figure.name + ".svg"), figure.svg});
  }
  files.push_back({kReportFile, report_page(run, mission, summary, target, team)});
  return files;
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
  std::error_code error;
  fs::create_directories(run_dir / "figures", error);
  if (error) return (run_dir / "figures").string() + ": " + error.message();
  for (const ReportFile& file : std::get<std::vector<ReportFile>>(drawn)) {
    if (auto problem = write_file(run_dir / file.path, file.text)) return problem;
  }
  return {};
}

}  // namespace ergocast
