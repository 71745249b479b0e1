// SPDX-License-Identifier: BSD-3-Clause
// Stores the density as a CSV table with the functions that read target maps.
#include "report/target_density.h"

#include <vector>

#include "logger/run_record.h"
#include "target/maps/csv_map.h"

namespace ergocast {
namespace {

std::string text_of(const MapProblem& problem) {
  return problem.what + " (" + problem.remedy + ", or remove the file)";
}

}  // namespace

std::string target_density_text(const Field& density) { return csv_text(density); }

std::optional<std::string> write_target_density(const std::filesystem::path& file,
                                                const Field& density) {
  return write_file(file, target_density_text(density));
}

Result<Field> read_target_density(const std::filesystem::path& file) {
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) return Field();
  OpenedMap opened = open_map(file);
  if (!opened) return failure(text_of(opened.error()));
  MapFile& map = **opened;
  Field field(map.columns(), map.rows());
  std::vector<double> row(static_cast<std::size_t>(map.columns()));
  for (Eigen::Index j = field.cols(); j-- > 0;) {
    if (const auto problem = map.next_row(row)) return failure(text_of(*problem));
    field.col(j) = Eigen::Map<const Eigen::VectorXd>(row.data(), field.rows());
  }
  return field;
}

}  // namespace ergocast
