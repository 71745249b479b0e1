// SPDX-License-Identifier: BSD-3-Clause
// `ergocast export`: writes a record for Foxglove, spreadsheets and maps.
#include <cstdio>
#include <memory>
#include <string>

#include "cli/commands.h"
#include "cli/record/origin_option.h"
#include "cli/record/run_directory.h"
#include "cli/report_error.h"
#include "report/export/exports.h"

namespace ergocast::cli {
namespace {

namespace fs = std::filesystem;

struct ExportOptions {
  fs::path run_dir, out;
  std::string to, schema;
  std::optional<GeoPlace> origin;
};

/// Writes to a temporary name first, so that a reader never sees an incomplete file.
std::optional<std::string> write_whole(const ExportRecord& record, const fs::path& file,
                                       std::optional<std::string> (*write)(const ExportRecord&,
                                                                           const fs::path&)) {
  fs::path part = file;
  part += ".part";
  std::error_code error;
  if (auto problem = write(record, part)) {
    fs::remove(part, error);
    return problem;
  }
  fs::rename(part, file, error);
  if (error) return file.string() + ": " + error.message();
  return std::nullopt;
}

bool for_ros2(const ExportOptions& options) { return options.schema == "ros2"; }

std::optional<std::string> write(const ExportRecord& record, const ExportOptions& options,
                                 const fs::path& out) {
  if (options.to == "csv") return write_tables(record, out);
  if (options.to == "geojson") return write_whole(record, out, write_geojson);
  return write_whole(record, out, for_ros2(options) ? write_ros2_mcap : write_mcap);
}

fs::path default_out(const ExportOptions& options) {
  if (options.to == "csv") return options.run_dir / "export";
  return options.run_dir / ((for_ros2(options) ? "export_ros2." : "export.") + options.to);
}

int export_run(const ExportOptions& options) {
  if (!options.schema.empty() && options.to != "mcap")
    return report_error(kExitBadInput, "--schema is for --to mcap, and this is --to " + options.to +
                                           ": leave it out");
  const auto mission = recorded_mission_or_complain(options.run_dir);
  if (!mission) return kExitBadInput;
  std::optional<GeoPlace> origin = options.origin;
  if (!origin) {
    auto read = recorded_origin(options.run_dir);
    if (!read) return report_error(kExitBadInput, read.error());
    origin = *read;
  }
  if (!origin && options.to == "geojson") {
    print_message(
        "note: the scenario has no origin, so the place of (0, 0) is taken to be latitude 0, "
        "longitude 0; --origin LATITUDE,LONGITUDE says where it is");
    origin = GeoPlace{0, 0};
  }
  auto record = read_export_record(options.run_dir, *mission, origin);
  if (!record) return report_error(kExitBadInput, record.error());
  const fs::path out = options.out.empty() ? default_out(options) : options.out;
  if (const auto problem = write(*record, options, out)) return report_error(kExitFailed, *problem);
  std::printf("%s\n", printable(fs::absolute(out).string()).c_str());
  return kExitDone;
}

}  // namespace

void add_export(CLI::App& app, Action& action) {
  auto* command =
      app.add_subcommand("export", "Write a recorded run for Foxglove, spreadsheets or maps");
  auto options = std::make_shared<ExportOptions>();
  command->add_option("RUN_DIR", options->run_dir, "Run directory")->required()->type_name("DIR");
  command
      ->add_option("--to", options->to,
                   "mcap: one file for Foxglove; csv: a folder of tables; geojson: tracks, "
                   "walls and stations")
      ->required()
      ->check(CLI::IsMember({"mcap", "csv", "geojson"}).description(""))
      ->type_name("mcap|csv|geojson");
  command
      ->add_option("--schema", options->schema,
                   "Messages of an MCAP file. foxglove: JSON, the default; ros2: CDR, as "
                   "ergocast-ros2 publishes them")
      ->check(CLI::IsMember({"foxglove", "ros2"}).description(""))
      ->type_name("foxglove|ros2");
  command
      ->add_option("--out", options->out,
                   "File, or folder of the tables (default: export.mcap, export_ros2.mcap, "
                   "export/ or export.geojson in RUN_DIR)")
      ->type_name("PATH");
  add_origin_option(*command, options->origin);
  command->footer("Exit codes: 0 done; 2 no record, or it is damaged; 4 it cannot be written.");
  command->callback([&action, options] { action = [options] { return export_run(*options); }; });
}

}  // namespace ergocast::cli
