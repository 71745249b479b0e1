// SPDX-License-Identifier: BSD-3-Clause
// Reads the place of (0, 0) from the command line, or from a run directory.
#include "cli/record/origin_option.h"

#include <string>

#include "logger/run_record.h"
#include "text/read_number.h"

namespace ergocast::cli {
namespace {

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

}  // namespace

CLI::Option* add_origin_option(CLI::App& app, std::optional<GeoPlace>& origin) {
  return app
      .add_option_function<std::string>(
          "--origin", [&origin](const std::string& text) { origin = parse_origin(text); },
          "Place of (0, 0) in degrees of WGS 84 (default: the scenario's origin)")
      ->type_name("LATITUDE,LONGITUDE");
}

Result<std::optional<GeoPlace>, std::vector<Problem>> recorded_origin(
    const std::filesystem::path& run_dir) {
  const std::filesystem::path scenario = run_dir / kScenarioFile;
  std::error_code none;
  if (!std::filesystem::exists(scenario, none)) return std::optional<GeoPlace>();
  return read_origin(scenario);
}

}  // namespace ergocast::cli
