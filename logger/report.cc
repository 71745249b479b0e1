#include "logger/report.h"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <variant>

#include "logger/figures.h"
#include "logger/page.h"
#include "logger/run_data.h"

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

std::string cannot_write(const fs::path& file, const std::string& why) {
  return file.string() + ": cannot be written: " + why +
         ": make room or grant write access, then run \"ergocast report\" again";
}

/// A reader of `file` sees the old content or the new, never a part.
std::optional<std::string> replace_file(const fs::path& file, const std::string& content) {
  fs::path temporary = file;
  temporary += ".tmp";
  std::ofstream out(temporary, std::ios::binary | std::ios::trunc);
  out << content;
  out.close();
  std::error_code error;
  if (!out) {
    const std::string why = std::strerror(errno);
    fs::remove(temporary, error);
    return cannot_write(file, why);
  }
  fs::rename(temporary, file, error);
  if (!error) return {};
  const std::string why = error.message();
  fs::remove(temporary, error);
  return cannot_write(file, why);
}

std::optional<std::string> write_figures(const fs::path& directory,
                                         const std::vector<Figure>& figures) {
  std::error_code error;
  fs::create_directories(directory, error);
  if (error) return cannot_write(directory, error.message());
  for (const Figure& figure : figures) {
    const auto problem = replace_file(directory / (figure.name + ".svg"), figure.svg);
    if (problem) return problem;
  }
  return {};
}

}  // namespace

std::optional<std::string> write_report(const fs::path& run_dir, const Mission& mission,
                                        const TargetDensity& target) {
  const auto run = read_run(run_dir);
  if (const auto* problem = std::get_if<std::string>(&run)) return *problem;
  const auto summary = read_summary(run_dir / "summary.json");
  if (const auto* problem = std::get_if<std::string>(&summary)) return *problem;

  const auto& data = std::get<RunData>(run);
  const std::vector<Figure> figures = draw_figures(data, mission, target);
  if (auto problem = write_figures(run_dir / "figures", figures)) return problem;
  return replace_file(run_dir / "report.html",
                      report_page(data, mission, std::get<nlohmann::json>(summary), figures));
}

}  // namespace ergocast
