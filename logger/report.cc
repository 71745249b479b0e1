#include "logger/report.h"

#include <variant>

#include "logger/figures.h"
#include "logger/page.h"
#include "logger/run_data.h"
#include "logger/run_record.h"
#include "logger/summary.h"
#include "logger/target_density.h"

namespace ergocast {
namespace {

namespace fs = std::filesystem;

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

std::optional<std::string> write_report(const fs::path& run_dir, const Mission& mission) {
  const auto run = read_run(run_dir);
  if (const auto* problem = std::get_if<std::string>(&run)) return *problem;
  const auto summary = read_summary(run_dir);
  if (const auto* problem = std::get_if<std::string>(&summary)) return *problem;
  const auto target = read_target_density(run_dir / kTargetDensityFile);
  if (const auto* problem = std::get_if<std::string>(&target)) return *problem;

  const auto& data = std::get<RunData>(run);
  const std::vector<Figure> figures = draw_figures(data, mission, std::get<Field>(target));
  if (auto problem = write_figures(run_dir / "figures", figures)) return problem;
  return write_file(run_dir / "report.html",
                    report_page(data, mission, std::get<nlohmann::ordered_json>(summary), figures));
}

}  // namespace ergocast
