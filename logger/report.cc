#include "logger/report.h"

#include <fstream>
#include <nlohmann/json.hpp>
#include <variant>

#include "logger/figures.h"
#include "logger/page.h"
#include "logger/run_data.h"
#include "logger/run_record.h"

namespace ergocast {
namespace {

namespace fs = std::filesystem;

/// Null if there is no such file.
std::variant<nlohmann::json, std::string> read_summary(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) return nlohmann::json();
  try {
    return nlohmann::json::parse(in);
  } catch (const nlohmann::json::exception& error) {
    return file.string() + ": is not JSON: " + error.what() +
           ": copy it again from where the run was recorded, or remove it";
  }
}

std::optional<std::string> write_figures(const fs::path& directory,
                                         const std::vector<Figure>& figures) {
  std::error_code error;
  fs::create_directories(directory, error);
  if (error) return directory.string() + ": " + error.message();
  for (const Figure& figure : figures) {
    const auto problem = write_file(directory / (figure.name + ".svg"), figure.svg);
    if (problem) return problem;
  }
  return {};
}

}  // namespace

std::optional<std::string> write_report(const fs::path& run_dir, const Mission& mission,
                                        const TargetDensity& target) {
  const auto run = read_run(run_dir);
  if (const auto* problem = std::get_if<std::string>(&run)) return *problem;
  const auto summary = read_summary(run_dir / kSummaryFile);
  if (const auto* problem = std::get_if<std::string>(&summary)) return *problem;

  const auto& data = std::get<RunData>(run);
  const std::vector<Figure> figures = draw_figures(data, mission, target);
  if (auto problem = write_figures(run_dir / "figures", figures)) return problem;
  return write_file(run_dir / "report.html",
                    report_page(data, mission, std::get<nlohmann::json>(summary), figures));
}

}  // namespace ergocast
