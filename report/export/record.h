// SPDX-License-Identifier: BSD-3-Clause
// A record for all exports: rows, densities, log lines, and times since 1970.
#pragma once

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "core/mission/mission.h"
#include "logger/run_data.h"
#include "target/geo/local_plane.h"

namespace ergocast {

/// A line of a process's log.
struct ExportedLine {
  std::uint64_t time_ns = 0;
  std::string level, process, text;
};

/// A line "TIME LEVEL PROCESS: TEXT". Its time is local, as if it were UTC. Nothing for other
/// lines.
std::optional<ExportedLine> parse_log_line(std::string_view line);

/// One value per cell, in multiples of the uniform density. Row i is along x, column j along y,
/// both ascending from the domain's origin.
using DensityCells = Eigen::MatrixXd;

struct ExportRecord {
  Mission mission;           ///< in cosines, the basis of the maps
  std::string metric_basis;  ///< the basis of φ² in the rows: name_of_basis()
  RunData run;
  nlohmann::ordered_json summary;  ///< null: there is none
  DensityCells target;
  std::vector<ExportedLine> log;  ///< ascending in time
  std::optional<GeoPlace> origin;
  std::uint64_t start_ns = 0;  ///< of tick 0: the start of the recording, or 1970 if unknown

  std::uint64_t time_ns(double t_s) const {
    return start_ns + static_cast<std::uint64_t>(std::llround(t_s * 1e9));
  }
};

/// Reads a run directory with the plan `mission`. An error names file, line and remedy.
Result<ExportRecord> read_export_record(const std::filesystem::path& run_dir,
                                        const Mission& mission,
                                        const std::optional<GeoPlace>& origin);

/// The top-level values of the summary, and the origin.
std::map<std::string, std::string> single_values(const ExportRecord& record);

/// Σ a_k f_k / mean(f_k²), at the centres of the cells; for a box, averaged along z.
DensityCells density_of(const Coefficients& coefficients, const Mission& mission,
                        Eigen::Index columns, Eigen::Index rows);

/// The centre of a cell [m].
Eigen::Vector2d center_of(Eigen::Index column, Eigen::Index row, const DensityCells& cells,
                          const Mission& mission);

/// 64 cells along the domain's longer side, and square cells.
std::pair<Eigen::Index, Eigen::Index> coverage_cells(const Mission& mission);

}  // namespace ergocast
