// SPDX-License-Identifier: BSD-3-Clause
// Reads a whole file, if it is one.
#include "target/geo/polygon_file.h"

#include <algorithm>
#include <utility>

#include "text/input_file.h"

namespace ergocast {

void PolygonFileProblems::add(PolygonFileProblem problem) {
  auto others = std::exchange(problem.more, {});
  if (list_.size() < kMostFileProblems) {
    list_.push_back(std::move(problem));
  } else if (list_.size() == kMostFileProblems) {
    list_.push_back({"", "has more problems than these " + std::to_string(kMostFileProblems),
                     "repair these first"});
  }
  for (PolygonFileProblem& other : others) add(std::move(other));
}

PolygonFileProblem PolygonFileProblems::all() const {
  PolygonFileProblem first = list_.front();
  first.more.assign(list_.begin() + 1, list_.end());
  return first;
}

std::string line_of(std::string_view text, std::size_t offset) {
  return "line " + std::to_string(1 + std::ranges::count(text.substr(0, offset), '\n'));
}

Result<std::string, PolygonFileProblem> text_of_polygon_file(const std::filesystem::path& file,
                                                             const std::string& extension,
                                                             const std::string& simplify) {
  auto read = read_whole(file, kMaxPolygonFileBytes);
  if (read) return *std::move(read);
  FileProblem& problem = read.error();
  if (problem.kind == FileProblem::Kind::kTooLarge)
    return failure(PolygonFileProblem{"", "has more than 16 MiB", simplify});
  if (problem.kind == FileProblem::Kind::kNoFile)
    problem.remedy = "name a file ending in " + extension;
  return failure(PolygonFileProblem{"", std::move(problem.what), std::move(problem.remedy)});
}

}  // namespace ergocast
