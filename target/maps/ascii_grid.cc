// SPDX-License-Identifier: BSD-3-Clause
// Reads the header as key and value words, then streams the cells row by row.
#include "target/maps/ascii_grid.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "target/maps/map_text.h"

namespace ergocast {
namespace {

namespace fs = std::filesystem;
using namespace std::string_view_literals;

std::string lower(std::string_view text) {
  std::string low(text);
  for (char& c : low) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c;
  return low;
}

class AsciiGrid : public MapFile {
 public:
  explicit AsciiGrid(const fs::path& file) : file_(file), words_(file) {}

  std::optional<MapProblem> open() {
    if (auto problem = read_header()) return problem;
    if (header_.contains("dx") && header_.contains("dy") && !header_.contains("cellsize")) {
      if (header_["dx"] != header_["dy"])
        return problem(": its cells are not square",
                       "resample it: gdalwarp -tr 10 10 in.asc out.tif");
      header_["cellsize"] = header_["dx"];
    }
    std::string lacking;
    for (const std::string key : {"ncols", "nrows", "cellsize"})
      if (!header_.contains(key)) lacking += (lacking.empty() ? "" : ", ") + key;
    for (const char* axis : {"x", "y"})
      if (header_.contains(lowest(axis, "corner")) == header_.contains(lowest(axis, "center")))
        lacking += (lacking.empty() ? "" : ", ") + lowest(axis, "corner") + " or " +
                   lowest(axis, "center");
    if (!lacking.empty()) return missing(lacking);
    if (header_.contains("nodata_value")) no_data_ = header_["nodata_value"];
    return take_dimensions();
  }

  std::optional<MapProblem> next_row(std::span<double> values) override {
    std::optional<MapProblem> bad;
    for (double& value : values) {
      auto problem = next_value(value);
      if (!problem) continue;
      if (!problem->ends_row) return problem;
      if (!bad) bad = std::move(problem);
    }
    if (++read_ < rows_ || bad || words_.next().empty()) return bad;
    return problem(" has more numbers than ncols · nrows", "correct its header");
  }

 private:
  MapProblem problem(const std::string& what, std::string remedy) const {
    return {file_.string() + what, std::move(remedy)};
  }
  MapProblem missing(const std::string& keys) const {
    return problem(": its header lacks " + keys + ", or has both",
                   "write one line of each: ncols, nrows, xllcorner, yllcorner, cellsize");
  }
  static std::string lowest(const std::string& axis, const std::string& what) {
    return axis + "ll" + what;
  }
  std::string here() const { return file_.string() + ", line " + std::to_string(words_.line()); }

  /// Ends at the first number in the place of a key: it is the first cell.
  std::optional<MapProblem> read_header() {
    static const std::string kKeys[] = {"ncols",     "nrows",     "cellsize",  "xllcorner",
                                        "xllcenter", "yllcorner", "yllcenter", "nodata_value",
                                        "dx",        "dy"};
    for (;;) {
      first_ = words_.next();
      const bool is_cell = first_.empty() || "+-.0123456789"sv.find(first_[0]) != std::string::npos;
      if (is_cell || number_in(first_)) return {};
      const std::string key = lower(first_);
      if (std::find(std::begin(kKeys), std::end(kKeys), key) == std::end(kKeys)) {
        return MapProblem{here() + ": no key of an ESRI ASCII grid stands here",
                          "write ncols, nrows, xllcorner, yllcorner, cellsize, NODATA_value"};
      }
      const std::optional<double> value = number_in(words_.next());
      if (!value || header_.contains(key)) {
        return MapProblem{here() + ": " + key + (value ? " is there twice" : " has no number"),
                          "write each key once, and its number after it"};
      }
      header_[key] = *value;
    }
  }

  std::optional<MapProblem> take_dimensions() {
    const double columns = header_["ncols"], rows = header_["nrows"], cell_m = header_["cellsize"];
    if (!(std::abs(columns) < 1e9 && std::abs(rows) < 1e9) || columns != std::floor(columns) ||
        rows != std::floor(rows)) {
      return problem(": ncols and nrows are not whole numbers", "correct its header");
    }
    if (auto wrong = check_dimensions(file_, std::llround(columns), std::llround(rows))) {
      return wrong;
    }
    columns_ = static_cast<int>(columns);
    rows_ = static_cast<int>(rows);
    const double x_m = low_of("x", cell_m), y_m = low_of("y", cell_m);
    if (!(cell_m > 0 && cell_m <= 1e9 && std::abs(x_m) <= 1e13 && std::abs(y_m) <= 1e13)) {
      return problem(": its header gives no extent",
                     "write cellsize above 0, at most 1e9 m, and a corner at most 1e13 m from 0");
    }
    extent_ = Rectangle{{x_m, y_m}, {columns * cell_m, rows * cell_m}};
    return {};
  }

  /// The lower end of the extent; a stated centre of the first cell is half a cell inside.
  double low_of(const std::string& axis, double cell_m) {
    if (header_.contains(lowest(axis, "corner"))) return header_[lowest(axis, "corner")];
    return header_[lowest(axis, "center")] - 0.5 * cell_m;
  }

  std::optional<MapProblem> next_value(double& value) {
    const std::string first = std::exchange(first_, "");
    const std::string_view word = first.empty() ? words_.next() : std::string_view(first);
    if (word.empty()) {
      return problem(" ends before its last cell: " + std::to_string(rows_) + " rows of " +
                         std::to_string(columns_) + " are announced",
                     "write it again, or correct its header");
    }
    const std::optional<double> number = number_in(word);
    // Some programs round one of the two to a float.
    const bool same = number && std::abs(*number - no_data_) <= 1e-7 * std::abs(no_data_);
    if (same || (number && std::isnan(*number) && std::isnan(no_data_))) {
      value = 0;
    } else {
      const auto density = density_in(word, here());
      if (!density) return density.error();
      value = *density;
    }
    return {};
  }

  fs::path file_;
  WordReader words_;
  std::map<std::string, double> header_;
  std::string first_;  // the word that ended the header, until it is read as a cell
  double no_data_ = -9999;
  int read_ = 0;
};

}  // namespace

OpenedMap open_ascii_grid(const fs::path& file) {
  auto grid = std::make_unique<AsciiGrid>(file);
  if (auto problem = grid->open()) return failure(*problem);
  return grid;
}

}  // namespace ergocast
