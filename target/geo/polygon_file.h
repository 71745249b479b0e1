// SPDX-License-Identifier: BSD-3-Clause
// What the readers of polygons share: the text of a file, and its problems.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "core/base/result.h"

namespace ergocast {

/// Limit (Files of a scenario): length of a GeoJSON or KML file, or a drawing [bytes]. Beyond it:
/// the scenario is refused.
inline constexpr std::size_t kMaxPolygonFileBytes = std::size_t{16} << 20;

struct PolygonFileProblem {
  std::string member;  ///< the place in the file, or empty for the whole file
  std::string what, remedy;
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
