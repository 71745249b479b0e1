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

Result<Record> read_record(const fs::path& run_dir, const Mission& mission) {
  auto run = read_run(run_dir, mission);
  if (!run) return failure(run.error());
  auto summary = read_summary(run_dir);
  if (!summary) return failure(summary.error());
  auto target = read_target_density(run_dir / kTargetDensityFile);
  if (!target) return failure(target.error());
  return Record{*std::move(run), *std::move(summary), *std::move(target)};
}

}  // namespace

Result<ReportPage> draw_report(const fs::path& run_dir, const Mission& mission,
                               const nlohmann::ordered_json& team) {
  auto read = read_record(run_dir, mission);
  if (!read) return failure(read.error());
  const auto& [run, summary, target] = *read;
  return ReportPage{report_page(run, mission, summary, target, team)};
}

Result<nlohmann::ordered_json> read_page_record(const fs::path& run_dir, const Mission& mission,
                                                const nlohmann::ordered_json& team) {
  auto read = read_record(run_dir, mission);
  if (!read) return failure(read.error());
  const auto& [run, summary, target] = *read;
  return page_record(run, mission, summary, target, team);
}

std::optional<std::string> write_report(const fs::path& run_dir, const Mission& mission,
                                        const nlohmann::ordered_json& team) {
  const auto drawn = draw_report(run_dir, mission, team);
  if (!drawn) return drawn.error();
  return write_file(run_dir / kReportFile, drawn->html);
}

}  // namespace ergocast
