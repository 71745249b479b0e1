// SPDX-License-Identifier: BSD-3-Clause
// `ergocast export`: writes a record for Foxglove, spreadsheets and maps.
#include <cstdio>
#include <memory>
#include <string>

#include "cli/commands.h"
#include "cli/record/run_directory.h"
#include "cli/report_error.h"
#include "logger/run_record.h"
#include "report/export/exports.h"
#include "scenario/origin.h"
#include "text/read_number.h"

namespace ergocast::cli {
namespace {

namespace fs = std::filesystem;

struct ExportOptions {
  fs::path run_dir, out;
  std::string to;
  std::optional<GeoPlace> origin;
};

/// "47.5,9.2": latitude, then longitude.
GeoPlace parse_origin(const std::string& text) {
  const std::size_t comma = text.find(',');
  const auto latitude = read_number<double>(text.substr(0, comma));
  const auto longitude =
      comma == text.npos ? std::nullopt : read_number<double>(text.substr(comma + 1));
  const bool is_place = latitude && longitude && *latitude >= -90 && *latitude <= 90 &&
                        *longitude >= -180 && *longitude <= 180;
  if (!is_place) {
    throw CLI::ValidationError("--origin", "\"" + text +
                                               "\" is no LATITUDE,LONGITUDE in degrees, −90 to 90 "
                                               "and −180 to 180, such as 47.5,9.2");
  }
  return {*latitude, *longitude};
}

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

std::optional<std::string> write(const ExportRecord& record, const std::string& to,
                                 const fs::path& out) {
  if (to == "csv") return write_tables(record, out);
  return write_whole(record, out, to == "mcap" ? write_mcap : write_geojson);
}

int export_run(const ExportOptions& options) {
  const auto mission = recorded_mission_or_complain(options.run_dir);
  if (!mission) return kExitBadInput;
  std::optional<GeoPlace> origin = options.origin;
  const fs::path scenario = options.run_dir / kScenarioFile;
  std::error_code none;
  if (!origin && fs::exists(scenario, none)) {
    auto read = read_origin(scenario);
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
  fs::path out = options.out;
  if (out.empty())
    out = options.run_dir / (options.to == "csv" ? "export" : "export." + options.to);
  if (const auto problem = write(*record, options.to, out))
    return report_error(kExitFailed, *problem);
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
      ->add_option("--out", options->out,
                   "File, or folder of the tables (default: export.mcap, export/ or "
                   "export.geojson in RUN_DIR)")
      ->type_name("PATH");
  command
      ->add_option_function<std::string>(
          "--origin", [options](const std::string& text) { options->origin = parse_origin(text); },
          "Place of (0, 0) in degrees of WGS 84 (default: the scenario's origin)")
      ->type_name("LATITUDE,LONGITUDE");
  command->footer("Exit codes: 0 done; 2 no record, or it is damaged; 4 it cannot be written.");
  command->callback([&action, options] { action = [options] { return export_run(*options); }; });
}

}  // namespace ergocast::cli
