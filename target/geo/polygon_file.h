// SPDX-License-Identifier: BSD-3-Clause
// What the readers of polygons share: the text of a file, and its problems.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"

namespace ergocast {

/// Limit (Files of a scenario): length of a GeoJSON or KML file, or a drawing [bytes]. Beyond it:
/// the scenario is refused.
inline constexpr std::size_t kMaxPolygonFileBytes = std::size_t{16} << 20;

/// Limit (Files of a scenario): problems of a file that are named at once. Beyond it: the first
/// are.
inline constexpr std::size_t kMostFileProblems = 20;

struct PolygonFileProblem {
  std::string member;  ///< the place in the file, or empty for the whole file
  std::string what, remedy;
  std::vector<PolygonFileProblem> more{};  ///< other problems of the same file
};

/// The problems of one file, in their order.
class PolygonFileProblems {
 public:
  bool empty() const { return list_.empty(); }
  /// Whether further problems change nothing, so that reading can end.
  bool full() const { return list_.size() > kMostFileProblems; }
  /// Takes in a problem and its others; beyond the limit, only that there are more.
  void add(PolygonFileProblem problem);
  /// The first one, with the others in it.
  /// @pre !empty()
  PolygonFileProblem all() const;

 private:
  std::vector<PolygonFileProblem> list_;
};

/// "line 12", of the byte at `offset`.
std::string line_of(std::string_view text, std::size_t offset);

/// The bytes of a file of polygons, at most kMaxPolygonFileBytes.
/// @param extension  ".svg"
/// @param simplify   what to do about a file that is larger
Result<std::string, PolygonFileProblem> text_of_polygon_file(const std::filesystem::path& file,
                                                             const std::string& extension,
                                                             const std::string& simplify);

}  // namespace ergocast
