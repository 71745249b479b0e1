// SPDX-License-Identifier: BSD-3-Clause
// Recognises axes by their attributes, and turns centres or bounds into cells.
#include "target/maps/netcdf_axis.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace ergocast {
namespace {

using Variable = NetcdfFile::Variable;

const std::map<std::string, AxisKind, std::less<>> kByWord = {
    {"X", AxisKind::kX},
    {"Y", AxisKind::kY},
    {"Z", AxisKind::kZ},
    {"T", AxisKind::kTime},
    {"projection_x_coordinate", AxisKind::kX},
    {"projection_y_coordinate", AxisKind::kY},
    {"depth", AxisKind::kZ},
    {"height", AxisKind::kZ},
    {"altitude", AxisKind::kZ},
    {"time", AxisKind::kTime},
    {"longitude", AxisKind::kX},
    {"latitude", AxisKind::kY},
    {"lon", AxisKind::kX},
    {"lat", AxisKind::kY},
    {"x", AxisKind::kX},
    {"y", AxisKind::kY},
    {"z", AxisKind::kZ},
};

std::string lower_case(std::string text) {
  for (char& c : text) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c;
  return text;
}

/// Metres in a unit; nothing if it is no length.
std::optional<double> metres_of(const std::string& units) {
  static const std::set<std::string, std::less<>> kMetre = {"m", "meter", "metre", "meters",
                                                            "metres"};
  static const std::set<std::string, std::less<>> kKilometre = {"km", "kilometer", "kilometre",
                                                                "kilometers", "kilometres"};
  if (kMetre.contains(units)) return 1;
  if (kKilometre.contains(units)) return 1000;
  return std::nullopt;
}

class AxisReader {
 public:
  AxisReader(const NetcdfFile& file, const NetcdfFile::Dimension& dimension)
      : file_(file), dimension_(dimension), place_(file.name().string() + ": " + dimension.name) {}

  Result<NetcdfAxis, MapProblem> read() {
    const auto variable = file_.variable(dimension_.name);
    if (!variable) {
      return failure(MapProblem{place_ + " has no coordinate variable",
                                "write one with its name, its values and its units"});
    }
    const std::string units = file_.text(*variable, "units");
    const auto metres = metres_of(units);
    if (!metres) {
      return failure(
          MapProblem{place_ + (units.empty() ? " has no units" : " is in " + units),
                     "write it in m or km, with units; project longitude and latitude first"});
    }
    scale_ = *metres * (points_down(*variable) ? -1 : 1);
    const std::string bounds = file_.text(*variable, "bounds");
    auto problem = bounds.empty() ? by_centres(*variable) : by_bounds(bounds);
    if (!problem) problem = sort();
    if (problem) return failure(*problem);
    return std::move(axis_);
  }

 private:
  /// A depth points down, unless `positive` has something else.
  bool points_down(Variable variable) const {
    const std::string positive = lower_case(file_.text(variable, "positive"));
    if (!positive.empty()) return positive == "down";
    constexpr char kName[] = "standard_name";
    return file_.text(variable, kName) == "depth" || lower_case(dimension_.name) == "depth";
  }

  std::optional<MapProblem> by_centres(Variable variable) {
    std::vector<double> center(dimension_.length);
    const auto shape = file_.dimensions(variable);
    if (shape.size() != 1 || shape[0].name != dimension_.name) return unusable(dimension_.name);
    if (auto problem = numbers(variable, center)) return problem;
    if (center.size() < 2) {
      return MapProblem{place_ + " has one value, and no bounds",
                        "write a variable with its two ends, and its name in bounds"};
    }
    const auto between = [&](std::size_t i) { return 0.5 * (center[i] + center[i + 1]); };
    const std::size_t last = center.size() - 1;
    for (std::size_t i = 0; i <= last; ++i) {
      const double before = i > 0 ? between(i - 1) : 2 * center[0] - between(0);
      const double after = i < last ? between(i) : 2 * center[last] - between(last - 1);
      axis_.cells.push_back({before, after});
    }
    return std::nullopt;
  }

  std::optional<MapProblem> by_bounds(const std::string& name) {
    const auto variable = file_.variable(name);
    const auto shape =
        variable ? file_.dimensions(*variable) : std::vector<NetcdfFile::Dimension>();
    if (shape.size() != 2 || shape[0].name != dimension_.name || shape[1].length != 2)
      return unusable(name);
    std::vector<double> ends(2 * dimension_.length);
    if (auto problem = numbers(*variable, ends)) return problem;
    for (std::size_t i = 0; i < dimension_.length; ++i)
      axis_.cells.push_back({ends[2 * i], ends[2 * i + 1]});
    return std::nullopt;
  }

  MapProblem unusable(const std::string& name) const {
    return {place_ + ": " + name + " does not have the shape of its values or bounds",
            "write one value, or two bounds, for each cell"};
  }

  /// Reads a whole variable, in metres and upwards.
  std::optional<MapProblem> numbers(Variable variable, std::vector<double>& values) const {
    std::vector<std::size_t> start, count;
    std::size_t room = values.size();
    for (const auto& dimension : file_.dimensions(variable)) {
      start.push_back(0);
      count.push_back(dimension.length);
      room /= std::max<std::size_t>(1, dimension.length);
    }
    // Two dimensions of a file may have one name, in groups.
    if (room == 0) return unusable(dimension_.name);
    if (auto problem = file_.objection(variable)) return problem;
    if (auto problem = file_.read(variable, start, count, values)) return problem;
    for (double& value : values) {
      value *= scale_;
      if (!(std::abs(value) <= 1e13)) {
        return MapProblem{place_ + " has a value that is no place", "write finite numbers of m"};
      }
    }
    return std::nullopt;
  }

  /// Each cell from low to high, all of them ascending.
  std::optional<MapProblem> sort() {
    auto& cells = axis_.cells;
    for (Heights& cell : cells) {
      if (cell.low_m > cell.high_m) std::swap(cell.low_m, cell.high_m);
    }
    axis_.reversed = cells.size() > 1 && cells.front().low_m > cells.back().low_m;
    if (axis_.reversed) std::reverse(cells.begin(), cells.end());
    double above_m = -HUGE_VAL;
    for (const Heights& cell : cells) {
      // Neighbours share an end, up to the rounding of floats.
      const double slack_m = 1e-5 * cell.length_m();
      if (!(cell.length_m() > 0) || cell.low_m < above_m - slack_m) {
        return MapProblem{place_ + " does not ascend or descend throughout",
                          "sort its values, and let its cells not overlap"};
      }
      above_m = cell.high_m;
    }
    return std::nullopt;
  }

  const NetcdfFile& file_;
  const NetcdfFile::Dimension& dimension_;
  std::string place_;
  double scale_ = 1;  // to metres upwards
  NetcdfAxis axis_;
};

}  // namespace

AxisKind kind_of(const NetcdfFile& file, const std::string& dimension) {
  const auto known = [](const std::string& word) {
    const auto found = kByWord.find(word);
    return found == kByWord.end() ? AxisKind::kOther : found->second;
  };
  if (const auto variable = file.variable(dimension)) {
    for (const char* attribute : {"axis", "standard_name"}) {
      const AxisKind kind = known(file.text(*variable, attribute));
      if (kind != AxisKind::kOther) return kind;
    }
    if (!file.text(*variable, "positive").empty()) return AxisKind::kZ;
  }
  return known(dimension);
}

Result<NetcdfAxis, MapProblem> read_axis(const NetcdfFile& file,
                                         const NetcdfFile::Dimension& dimension) {
  return AxisReader(file, dimension).read();
}

}  // namespace ergocast
