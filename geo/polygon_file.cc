// SPDX-License-Identifier: BSD-3-Clause
// Reads a whole file, if it is one.
#include "geo/polygon_file.h"

#include <fstream>

#include "text/regular_file.h"

namespace ergocast {

std::variant<std::string, PolygonFileProblem> text_of_polygon_file(
    const std::filesystem::path& file, const std::string& extension, const std::string& simplify) {
  if (const auto why = why_not_regular(file))
    return PolygonFileProblem{"", *why, "name a file ending in " + extension};
  std::ifstream stream(file, std::ios::binary);
  if (!stream.is_open())
    return PolygonFileProblem{"", "cannot be read", "check the name and its permissions"};
  std::string text(kMaxPolygonFileBytes + 1, '\0');
  stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(stream.gcount()));
  if (text.size() > kMaxPolygonFileBytes)
    return PolygonFileProblem{"", "has more than 16 MiB", simplify};
  return text;
}

}  // namespace ergocast
