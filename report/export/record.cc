// SPDX-License-Identifier: BSD-3-Clause
// Reads the tables, the target's table and the logs. Log lines have local time, the summary has
// UTC. The zone is the difference between the first line and the start, in quarters of an hour.
#include "report/export/record.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "core/motion/starts.h"
#include "logger/run_record.h"
#include "logger/summary.h"
#include "report/target_density.h"
#include "text/input_file.h"
#include "text/read_number.h"

namespace ergocast {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kSecond_ns = 1'000'000'000, kQuarter_ns = 900 * kSecond_ns;
constexpr std::int64_t kFarthestZone_ns = 15 * 3600 * kSecond_ns;
constexpr double kCoverageCells = 64;
/// The longest line of a log in one message. A longer line becomes several.
constexpr std::size_t kLongestLine = 1 << 16;

/// "2026-01-31T12:00:00", with milliseconds if they follow, as if it were UTC.
std::optional<std::int64_t> time_in(std::string_view text) {
  const auto part = [text](std::size_t at, std::size_t size) {
    return text.size() < at + size ? std::nullopt : read_number<int>(text.substr(at, size));
  };
  const auto year = part(0, 4), month = part(5, 2), day = part(8, 2), hour = part(11, 2),
             minute = part(14, 2), second = part(17, 2);
  if (!year || !month || !day || !hour || !minute || !second) return std::nullopt;
  const std::chrono::sys_days date = std::chrono::year(*year) /
                                     std::chrono::month(static_cast<unsigned>(*month)) /
                                     std::chrono::day(static_cast<unsigned>(*day));
  const std::int64_t seconds =
      date.time_since_epoch().count() * 86400LL + *hour * 3600 + *minute * 60 + *second;
  const int milliseconds = text.size() > 20 && text[19] == '.' ? part(20, 3).value_or(0) : 0;
  return seconds * kSecond_ns + milliseconds * (kSecond_ns / 1000);
}

/// Other lines than those of a log continue the previous one.
void add_line(std::string_view line, std::vector<ExportedLine>& log) {
  if (auto parsed = parse_log_line(line)) {
    log.push_back(*std::move(parsed));
  } else if (!log.empty()) {
    log.back().text += '\n' + std::string(line);
  }
}

std::vector<ExportedLine> read_log(const fs::path& folder, std::uint64_t start_ns) {
  std::vector<fs::path> files;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (entry.is_regular_file(error)) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  std::vector<ExportedLine> log;
  for (const fs::path& path : files) {
    std::vector<ExportedLine> lines;
    InputFile file(path);
    for (std::string line; next_line(file, line, kLongestLine) != LineEnd::kNone;)
      add_line(line, lines);
    log.insert(log.end(), lines.begin(), lines.end());
  }
  std::stable_sort(log.begin(), log.end(),
                   [](const auto& a, const auto& b) { return a.time_ns < b.time_ns; });
  if (log.empty() || start_ns == 0) return log;
  const auto ahead = static_cast<std::int64_t>(log.front().time_ns - start_ns);
  const std::int64_t zone = (ahead + (ahead < 0 ? -1 : 1) * kQuarter_ns / 2) / kQuarter_ns;
  if (std::abs(zone * kQuarter_ns) > kFarthestZone_ns) return log;
  for (ExportedLine& line : log) line.time_ns -= static_cast<std::uint64_t>(zone * kQuarter_ns);
  return log;
}

std::uint64_t start_of(const nlohmann::ordered_json& summary) {
  if (!summary.is_object()) return 0;
  const auto started = summary.value("started", nlohmann::ordered_json());
  if (!started.is_string()) return 0;
  return static_cast<std::uint64_t>(
      std::max<std::int64_t>(0, time_in(started.get<std::string>()).value_or(0)));
}

}  // namespace

std::optional<ExportedLine> parse_log_line(std::string_view line) {
  const auto time = time_in(line);
  const std::size_t level = line.find(' ');
  const std::size_t name = level == line.npos ? line.npos : line.find(' ', level + 1);
  const std::size_t text = name == line.npos ? line.npos : line.find(": ", name);
  if (!time || *time < 0 || text == line.npos) return std::nullopt;
  return ExportedLine{
      static_cast<std::uint64_t>(*time), std::string(line.substr(level + 1, name - level - 1)),
      std::string(line.substr(name + 1, text - name - 1)), std::string(line.substr(text + 2))};
}

Result<ExportRecord> read_export_record(const fs::path& run_dir, const Mission& mission,
                                        const std::optional<GeoPlace>& origin) {
  ExportRecord record;
  record.mission = in_cosines(mission);  // for the maps; φ² over time stays as recorded
  record.metric_basis = name_of_basis(mission.basis);
  record.origin = origin;
  auto run = read_run(run_dir, mission);
  if (!run) return failure(run.error());
  record.run = *std::move(run);
  if (record.run.empty()) {
    return failure((run_dir / kTrajectoryFile).string() +
                   ": has no rows yet, so there is nothing to export; wait for the first tick");
  }
  auto summary = read_summary(run_dir);
  if (!summary) return failure(summary.error());
  record.summary = *std::move(summary);
  record.start_ns = start_of(record.summary);
  auto target = read_target_density(run_dir / kTargetDensityFile);
  if (!target) return failure(target.error());
  record.target = *std::move(target);
  if (record.target.size() == 0) {
    const Mission& cosines = record.mission;
    const auto [columns, rows] = coverage_cells(cosines);
    record.target = density_of(cosines.target_coefficients, cosines, columns, rows);
  }
  record.log = read_log(run_dir / "log", record.start_ns);
  return record;
}

std::map<std::string, std::string> single_values(const ExportRecord& record) {
  std::map<std::string, std::string> entries;
  if (record.summary.is_object()) {
    for (const auto& [key, value] : record.summary.items()) {
      if (value.is_primitive())
        entries[key] = value.is_string() ? value.get<std::string>() : value.dump();
    }
  }
  if (record.origin) {
    entries["origin.latitude_deg"] = std::to_string(record.origin->latitude_deg);
    entries["origin.longitude_deg"] = std::to_string(record.origin->longitude_deg);
  }
  return entries;
}

std::pair<Eigen::Index, Eigen::Index> coverage_cells(const Mission& mission) {
  const Eigen::Vector2d size_m = mission.domain.size_m.head<2>();
  const Eigen::Vector2d cells = (size_m / size_m.maxCoeff() * kCoverageCells).cwiseMax(1);
  return {std::lround(cells.x()), std::lround(cells.y())};
}

Eigen::Vector2d center_of(Eigen::Index column, Eigen::Index row, const DensityCells& cells,
                          const Mission& mission) {
  const Eigen::Vector2d share(
      (static_cast<double>(column) + 0.5) / static_cast<double>(cells.rows()),
      (static_cast<double>(row) + 0.5) / static_cast<double>(cells.cols()));
  return mission.domain.origin_m.head<2>() + share.cwiseProduct(mission.domain.size_m.head<2>());
}

DensityCells density_of(const Coefficients& coefficients, const Mission& mission,
                        Eigen::Index columns, Eigen::Index rows) {
  // The average of the density along z has only the modes l = 0.
  Basis seen = mission.basis;
  seen.modes_z = 1;
  Coefficients scaled = coefficients.head(seen.mode_count());
  auto weights = in_plane(scaled, seen);
  weights.bottomRows(weights.rows() - 1) *= 2;  // mean(cos²) = ½ along each axis that varies
  weights.rightCols(weights.cols() - 1) *= 2;
  DensityCells cells(columns, rows);
  for (Eigen::Index i = 0; i < columns; ++i) {
    for (Eigen::Index j = 0; j < rows; ++j) {
      const Eigen::Vector3d x_m = on_ground(center_of(i, j, cells, mission));
      cells(i, j) = basis_values(x_m, mission.domain, seen).cwiseProduct(scaled).sum();
    }
  }
  return cells;
}

}  // namespace ergocast
