// SPDX-License-Identifier: BSD-3-Clause
// Chooses the reader by the extension of the file's name, and checks size and dimensions first.
#include "target/maps/map_file.h"

#include "target/maps/ascii_grid.h"
#include "target/maps/csv_map.h"
#include "target/maps/picture_map.h"
#include "target/maps/png_map.h"
#include "text/input_file.h"

namespace ergocast {
namespace fs = std::filesystem;

namespace {

/// In small letters.
std::string ending_of(const fs::path& file) {
  std::string end = file.extension().string();
  for (char& c : end) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c;
  return end;
}

std::string beginning_of(InputFile& in) {
  std::string begin(16, '\0');
  in.read(begin.data(), static_cast<std::streamsize>(begin.size()));
  begin.resize(static_cast<std::size_t>(in.gcount()));
  return begin;
}

/// A file that is something else than its name says, by its first bytes.
std::optional<MapProblem> of_another_kind(const fs::path& file, std::string_view begin) {
  const std::string end = ending_of(file), name = file.string();
  if (end.empty()) return {};
  const auto is = [&](std::string_view mark, std::string_view ends = "") {
    return begin.starts_with(mark) && ends.find(end) == ends.npos;
  };
  if (is("\x89PNG", ".png.pgm"))
    return MapProblem{name + " is a PNG picture", "let its name end in .png"};
  if (is("II*", ".tif.tiff") || is("MM", ".tif.tiff"))
    return MapProblem{name + " is a TIFF picture", "let its name end in .tif"};
  if (is("\xff\xd8\xff"))
    return MapProblem{name + " is a JPEG picture", "convert in.jpg -colorspace Gray out.png"};
  if (is("PK\3\4"))
    return MapProblem{name + " is a ZIP archive, such as a spreadsheet", "save the table as CSV"};
  if (is("CDF", ".nc") || is("\x89HDF", ".nc"))
    return MapProblem{name + " is a NetCDF or HDF5 file", "write voxels { file: … variable: … }"};
  if (is("%PDF") || is("SQLite") || is("<", ".tif.tiff") || is("{", ".yaml.yml"))
    return MapProblem{name + " is a document or a database, not a map",
                      "export the map itself from where it was made"};
  return {};
}

}  // namespace

std::optional<MapProblem> why_unreadable(const fs::path& file) {
  InputFile in(file);
  if (const auto& problem = in.problem()) {
    if (problem->kind == FileProblem::Kind::kMissing) {
      return MapProblem{file.string() + ": there is no such file",
                        "check the name; it counts from the scenario file's folder"};
    }
    const bool other = problem->kind == FileProblem::Kind::kNoFile;
    return MapProblem{file.string() + ' ' + problem->what,
                      other ? "name the map itself" : problem->remedy};
  }
  const std::string begin = beginning_of(in);
  if (begin.empty()) return MapProblem{file.string() + " is empty", "write the map again"};
  const bool is_table = map_kind(file) == MapKind::kCsv || map_kind(file) == MapKind::kAsciiGrid;
  if (begin.starts_with("\xff\xfe") || begin.starts_with("\xfe\xff") ||
      (is_table && begin.size() > 1 && begin[1] == '\0'))
    return MapProblem{file.string() + " is in UTF-16",
                      "convert it: iconv -f UTF-16 -t UTF-8 in > out"};
  if (begin.starts_with("\xef\xbb\xbf"))
    return MapProblem{file.string() + " begins with a byte order mark",
                      "remove it: sed -i '1s/^\\xEF\\xBB\\xBF//' FILE"};
  return of_another_kind(file, begin);
}

std::optional<MapKind> map_kind(const fs::path& file) {
  const std::string end = ending_of(file);
  if (end == ".png") return MapKind::kPng;
  if (end == ".pgm") return MapKind::kPgm;
  if (end == ".yaml" || end == ".yml") return MapKind::kOccupancy;
  if (end == ".csv") return MapKind::kCsv;
  if (end == ".asc") return MapKind::kAsciiGrid;
  if (end == ".tif" || end == ".tiff") return MapKind::kGeoTiff;
  return {};
}

OpenedMap open_map(const fs::path& file) {
  if (auto problem = why_unreadable(file)) return failure(*problem);
  switch (map_kind(file).value()) {
    case MapKind::kPng:
      return open_png_map(file);
    case MapKind::kPgm:
      return open_pgm_map(file);
    case MapKind::kOccupancy:
      return open_occupancy_target(file);
    case MapKind::kCsv:
      return open_csv_map(file);
    default:
      return open_ascii_grid(file);
  }
}

std::optional<MapProblem> check_dimensions(const fs::path& file, long long columns,
                                           long long rows) {
  if (columns >= 1 && rows >= 1 && columns <= kMaxMapSide && rows <= kMaxMapSide) return {};
  const std::string limit = std::to_string(kMaxMapSide);
  return MapProblem{file.string() + " has " + std::to_string(columns) + " columns and " +
                        std::to_string(rows) + " rows; the limits are 1 and " + limit,
                    columns < 1 || rows < 1 ? "write at least one number"
                                            : "scale it to at most " + limit + " x " + limit};
}

}  // namespace ergocast
