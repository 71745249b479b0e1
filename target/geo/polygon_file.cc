// SPDX-License-Identifier: BSD-3-Clause
// Reads a whole file, if it is one.
#include "target/geo/polygon_file.h"

#include <utility>

#include "text/input_file.h"

namespace ergocast {

std::variant<std::string, PolygonFileProblem> text_of_polygon_file(
    const std::filesystem::path& file, const std::string& extension, const std::string& simplify) {
  auto read = read_whole(file, kMaxPolygonFileBytes);
  if (auto* text = std::get_if<std::string>(&read)) return std::move(*text);
  auto& problem = std::get<FileProblem>(read);
  if (problem.kind == FileProblem::Kind::kTooLarge)
    return PolygonFileProblem{"", "has more than 16 MiB", simplify};
  if (problem.kind == FileProblem::Kind::kNoFile)
    problem.remedy = "name a file ending in " + extension;
  return PolygonFileProblem{"", std::move(problem.what), std::move(problem.remedy)};
}

}  // namespace ergocast
