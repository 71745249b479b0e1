// SPDX-License-Identifier: BSD-3-Clause
// Finds the axes of the variable, and reads it by rows along x.
#include "target/maps/netcdf_grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "target/maps/map_text.h"
#include "target/maps/netcdf_axis.h"

namespace ergocast {
namespace {

/// The types of netcdf.h. libnetcdf stores `fill` where a program wrote nothing; bytes have none.
struct StoredType {
  int type, bits;
  bool is_float;
  double fill;
};
constexpr StoredType kTypes[] = {
    {1, 8, false, HUGE_VAL},               // NC_BYTE
    {3, 16, false, -32767},                // NC_SHORT
    {4, 32, false, -2147483647},           // NC_INT
    {5, 32, true, 9.9692099683868690e36},  // NC_FLOAT
    {6, 64, true, 9.9692099683868690e36},  // NC_DOUBLE
    {7, 8, false, HUGE_VAL},               // NC_UBYTE
    {8, 16, false, 65535},                 // NC_USHORT
    {9, 32, false, 4294967295},            // NC_UINT
    {10, 64, false, -9223372036854775806.0},
    {11, 64, false, 18446744073709551614.0},
};

const StoredType& stored_type(int type) {
  for (const StoredType& one : kTypes)
    if (one.type == type) return one;
  return kTypes[0];
}

std::string listed(const std::vector<std::string>& names) {
  constexpr std::size_t kMost = 12;
  std::string list;
  for (std::size_t i = 0; i < std::min(names.size(), kMost); ++i)
    list += (i == 0 ? "" : ", ") + names[i];
  return list + (names.size() > kMost ? ", …" : "");
}

class Grid : public NetcdfGrid {
 public:
  explicit Grid(std::shared_ptr<NetcdfFile> file) : file_(std::move(file)) {}

  std::optional<MapProblem> prepare(const NetcdfChoice& choice) {
    const std::string& name = choice.variable;
    place_ = file_->name().string() + ": " + name;
    const auto found = file_->variable(name);
    if (!found) {
      return MapProblem{place_ + " is none of its variables",
                        "write one of " + listed(file_->variables())};
    }
    variable_ = *found;
    if (!file_->holds_numbers(variable_))
      return MapProblem{place_ + " holds no numbers", "write one of its other variables"};
    if (auto problem = check_attributes()) return problem;
    if (auto problem = check_names(choice.dimensions)) return problem;
    if (auto problem = find_axes(choice)) return problem;
    if (auto problem = check_size()) return problem;
    for (int axis = 0; axis < 2; ++axis) {
      if (auto problem = lay_out(axis)) return problem;
    }
    scale_ = file_->numeric_attribute(variable_, "scale_factor").value_or(1);
    offset_ = file_->numeric_attribute(variable_, "add_offset").value_or(0);
    find_missing();
    return std::nullopt;
  }

  const RasterGrid& raster() const override { return raster_; }
  const std::vector<Heights>& layers() const override { return axes_[2].cells; }

  std::optional<MapProblem> row(int layer, int row, std::span<double> values) override {
    if (dimension_[2] < start_.size())
      start_[dimension_[2]] = axes_[2].index(static_cast<std::size_t>(layer));
    start_[dimension_[1]] = axes_[1].index(static_cast<std::size_t>(row));
    if (auto problem = file_->read(variable_, start_, count_, values)) return problem;
    if (axes_[0].reversed) std::reverse(values.begin(), values.end());
    for (std::size_t column = 0; column < values.size(); ++column) {
      double& value = values[column];
      value = as_meant(value);
      const double unpacked = value * scale_ + offset_;
      if (is_missing(value, unpacked)) {
        value = 0;
        continue;
      }
      value = unpacked;
      if (value >= 0 && value <= kMaxMapValue) continue;
      return check_density(value, place_ + ", layer " + std::to_string(layer) + ", row " +
                                      std::to_string(row) + ", column " + std::to_string(column));
    }
    return std::nullopt;
  }

 private:
  /// Texts and lists where a number is due would be left out by others, and change the values.
  std::optional<MapProblem> check_attributes() const {
    constexpr std::size_t kAnyNumber = 0;
    for (const auto& [attribute, due] :
         {std::pair("scale_factor", std::size_t{1}), std::pair("add_offset", std::size_t{1}),
          std::pair("valid_min", std::size_t{1}), std::pair("valid_max", std::size_t{1}),
          std::pair("valid_range", std::size_t{2}), std::pair("_FillValue", std::size_t{1}),
          std::pair("missing_value", kAnyNumber)}) {
      if (file_->type_of(variable_, attribute) == 0) continue;
      const std::size_t count = file_->numeric_attributes(variable_, attribute).size();
      if (count > 0 && (due == kAnyNumber || count == due)) continue;
      return MapProblem{
          place_ + ": its attribute " + attribute + " has not the numbers that are due",
          "write one number, in valid_range two: ncatted, or ncgen -o in.nc in.cdl"};
    }
    return std::nullopt;
  }

  /// Whether each named dimension exists, and is named once.
  std::optional<MapProblem> check_names(const std::array<std::string, 4>& names) const {
    std::vector<std::string> there;
    for (const auto& dimension : file_->dimensions(variable_)) there.push_back(dimension.name);
    for (const std::string& name : names) {
      if (name.empty()) continue;
      if (std::find(there.begin(), there.end(), name) == there.end())
        return MapProblem{place_ + " has no axis " + name, "write one of " + listed(there)};
      if (std::count(names.begin(), names.end(), name) > 1)
        return MapProblem{place_ + ": its axis " + name + " was named twice",
                          "name each axis for one of x, y, z and time"};
    }
    return std::nullopt;
  }

  /// The kind of a dimension: from the scenario if it names this dimension or another one of that
  /// kind, else from the file.
  AxisKind kind_by(const NetcdfChoice& choice, const std::string& dimension) const {
    constexpr std::array kKinds = {AxisKind::kX, AxisKind::kY, AxisKind::kZ, AxisKind::kTime};
    const auto& names = choice.dimensions;
    const auto named = std::find(names.begin(), names.end(), dimension);
    if (named != names.end()) return kKinds[static_cast<std::size_t>(named - names.begin())];
    const AxisKind kind = kind_of(*file_, dimension);
    const auto by_file = std::find(kKinds.begin(), kKinds.end(), kind);
    const bool taken = by_file != kKinds.end() &&
                       !names[static_cast<std::size_t>(by_file - kKinds.begin())].empty();
    return taken ? AxisKind::kOther : kind;
  }

  /// Finds the dimensions of x, y and z. A dimension of time stays at the index of the choice.
  std::optional<MapProblem> find_axes(const NetcdfChoice& choice) {
    const auto dimensions = file_->dimensions(variable_);
    start_.assign(dimensions.size(), 0);
    count_.assign(dimensions.size(), 1);
    std::array<bool, 3> known{};
    for (std::size_t i = 0; i < dimensions.size(); ++i) {
      const AxisKind kind = kind_by(choice, dimensions[i].name);
      if (kind == AxisKind::kTime) {
        if (auto problem = choose_time(i, dimensions[i], choice.time_index)) return problem;
        continue;
      }
      if (choice.plane && kind == AxisKind::kZ) {
        if (dimensions[i].length == 1) continue;
        return MapProblem{
            place_ + " has " + std::to_string(dimensions[i].length) +
                " layers, and the domain is a plane",
            "write origin_z_m and size_z_m of the domain, or keep one layer: ncks -d " +
                dimensions[i].name + ",0 in.nc out.nc"};
      }
      const auto axis = static_cast<std::size_t>(kind);
      if (kind == AxisKind::kOther || known[axis]) {
        if (dimensions[i].length == 1) continue;
        return MapProblem{
            place_ + " has the axis " + dimensions[i].name + ", which is none of x, y, z and time",
            "write its name as x_axis, y_axis, z_axis or time_axis, or give its coordinate "
            "variable an attribute axis: X, Y, Z or T"};
      }
      if (dimensions[i].length > static_cast<std::size_t>(kMaxMapSide)) {
        return too_many(dimensions[i].length, std::string(" cells along ") + "xyz"[axis],
                        static_cast<std::size_t>(kMaxMapSide));
      }
      auto read = read_axis(*file_, dimensions[i]);
      if (!read) return read.error();
      axes_[axis] = *std::move(read);
      dimension_[axis] = i;
      known[axis] = true;
    }
    if (choice.plane) {
      axes_[2].cells = {{0, 1}};
      dimension_[2] = dimensions.size();  // none
      known[2] = true;
    }
    if (known[0] && known[1] && !known[2]) {
      return MapProblem{place_ + " is a plane without an axis z, and the domain is a box",
                        "remove size_z_m of the domain; or write a map with layers: gdal_translate "
                        "-of AAIGrid NETCDF:" +
                            file_->name().string() + ":" + choice.variable + " map.asc"};
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (known[axis]) continue;
      return MapProblem{place_ + " has no axis " + "xyz"[axis],
                        std::string("write the name of its dimension as ") + "xyz"[axis] +
                            "_axis, or give its coordinate variable an attribute axis"};
    }
    count_[dimension_[0]] = axes_[0].cells.size();
    return std::nullopt;
  }

  std::optional<MapProblem> choose_time(std::size_t at, const NetcdfFile::Dimension& time,
                                        std::optional<int> index) {
    const std::string last = std::to_string(time.length - 1);
    if (!index && time.length > 1) {
      return MapProblem{place_ + " has " + std::to_string(time.length) + " times",
                        "choose one: time_index: 0 to " + last};
    }
    start_[at] = static_cast<std::size_t>(index.value_or(0));
    if (start_[at] < time.length) return std::nullopt;
    return MapProblem{place_ + " has no time of index " + std::to_string(start_[at]),
                      "write 0 to " + last};
  }

  MapProblem too_many(std::size_t count, const std::string& what, std::size_t limit) const {
    return {place_ + " has " + std::to_string(count) + what + ", above the limit " +
                std::to_string(limit),
            "cut the grid to the domain, or average its cells"};
  }

  std::optional<MapProblem> check_size() const {
    std::size_t cells = 1;
    for (const NetcdfAxis& axis : axes_) cells *= axis.cells.size();
    if (cells > kMostVoxels) {
      return too_many(cells, " cells", kMostVoxels);
    }
    return file_->objection(variable_);
  }

  /// x or y: equal cells.
  std::optional<MapProblem> lay_out(int axis) {
    const std::vector<Heights>& cells = axes_[static_cast<std::size_t>(axis)].cells;
    const auto count = static_cast<double>(cells.size());
    const double low_m = cells.front().low_m, size_m = cells.back().high_m - low_m;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const double expected_m = low_m + size_m * static_cast<double>(i) / count;
      if (std::abs(cells[i].low_m - expected_m) > 1e-3 * size_m / count) {
        return MapProblem{place_ + ": the cells along " + "xy"[axis] + " are not of one size",
                          "resample the grid, only z may be uneven"};
      }
    }
    raster_.extent.origin_m[axis] = low_m;
    raster_.extent.size_m[axis] = size_m;
    (axis == 0 ? raster_.columns : raster_.rows) = static_cast<int>(cells.size());
    return std::nullopt;
  }

  void find_missing() {
    const StoredType& type = stored_type(file_->type_of(variable_));
    constexpr char kUnsigned[] = "_Unsigned";
    const std::string is_unsigned = file_->text(variable_, kUnsigned);
    if ((is_unsigned == "true" || is_unsigned == "TRUE" || is_unsigned == "True") &&
        type.bits < 64 && !type.is_float)
      wrap_ = std::ldexp(1.0, type.bits);
    for (const char* attribute : {"_FillValue", "missing_value"}) {
      for (const double fill : file_->numeric_attributes(variable_, attribute))
        fills_.push_back(as_meant(fill));
    }
    const bool has_own = !file_->numeric_attributes(variable_, "_FillValue").empty();
    if (type.is_float || !has_own) fills_.push_back(as_meant(type.fill));
    const auto range = file_->numeric_attributes(variable_, "valid_range");
    if (range.size() == 2) keep_within("valid_range", range[0], range[1], type);
    if (const auto low = file_->numeric_attribute(variable_, "valid_min"))
      keep_within("valid_min", *low, HUGE_VAL, type);
    if (const auto high = file_->numeric_attribute(variable_, "valid_max"))
      keep_within("valid_max", -HUGE_VAL, *high, type);
  }

  /// Limits have the type of the stored numbers, else they are for the unpacked ones.
  void keep_within(const char* attribute, double low, double high, const StoredType& type) {
    const bool unpacked =
        !type.is_float && stored_type(file_->type_of(variable_, attribute)).is_float;
    ValidRange& range = unpacked ? valid_unpacked_ : valid_;
    range.low = std::max(range.low, unpacked ? low : as_meant(low));
    range.high = std::min(range.high, unpacked ? high : as_meant(high));
  }

  /// With _Unsigned, negative numbers are the upper half of the positive ones.
  double as_meant(double stored) const {
    return stored < 0 && stored > -wrap_ ? stored + wrap_ : stored;
  }

  /// A fill value may be nan.
  bool is_missing(double stored, double unpacked) const {
    return stored < valid_.low || stored > valid_.high || unpacked < valid_unpacked_.low ||
           unpacked > valid_unpacked_.high ||
           std::any_of(fills_.begin(), fills_.end(), [stored](double fill) {
             return stored == fill || (std::isnan(stored) && std::isnan(fill));
           });
  }

  struct ValidRange {
    double low = -HUGE_VAL, high = HUGE_VAL;
  };

  std::shared_ptr<NetcdfFile> file_;
  std::string place_;
  NetcdfFile::Variable variable_ = 0;
  std::array<NetcdfAxis, 3> axes_;          // x, y, z
  std::array<std::size_t, 3> dimension_{};  // of the variable
  std::vector<std::size_t> start_, count_;  // of a row, along each dimension
  RasterGrid raster_;
  double scale_ = 1, offset_ = 0;
  double wrap_ = 0;  // of unsigned numbers that are stored as signed ones
  std::vector<double> fills_;
  ValidRange valid_, valid_unpacked_;
};

}  // namespace

Result<std::unique_ptr<NetcdfGrid>, MapProblem> NetcdfGrid::open(const std::filesystem::path& file,
                                                                 const NetcdfChoice& choice) {
  auto opened = NetcdfFile::open(file);
  if (!opened) return failure(opened.error());
  auto grid = std::make_unique<Grid>(*std::move(opened));
  if (auto problem = grid->prepare(choice)) return failure(*problem);
  return grid;
}

}  // namespace ergocast
