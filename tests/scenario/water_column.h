// SPDX-License-Identifier: BSD-3-Clause
// A water column in a NetCDF file, as an oceanographer's model writes it, and a scenario that
// covers it.
#pragma once

#include <cmath>
#include <functional>

#include "tests/support/netcdf_writer.h"

namespace ergocast::test {

/// The edges of its layers [m], downwards: thin at the surface.
inline const std::vector<double> kDepthEdges_m = {0, 5, 12, 25, 60};
inline constexpr std::uint32_t kColumnX = 8, kColumnY = 6;

/// Chlorophyll [mg/m³] in cell (i east, j north) of layer k below the surface; land is at i = 0.
inline double chlorophyll(std::uint32_t i, std::uint32_t j, std::uint32_t k) {
  return i == 0 ? 0 : 0.25 * ((3 + 7 * i + 5 * j + i * j) % 11) * (4 - k);
}

/// The content of the file. Tests change it, one mistake at a time.
struct WaterColumn {
  NetcdfDimensions dimensions = {
      {"time", 2}, {"depth", 4}, {"y", kColumnY}, {"x", kColumnX}, {"ends", 2}};
  std::vector<NetcdfVariable> variables;

  NetcdfVariable& at(const std::string& name) {
    for (NetcdfVariable& variable : variables) {
      if (variable.name == name) return variable;
    }
    return variables.emplace_back(NetcdfVariable{name, {}, {}, {}});
  }

  /// Packed into 16 bits, the northernmost row first, one time without anything and one with.
  WaterColumn() {
    NetcdfVariable x{
        "x", {"x"}, {}, {{"standard_name", "projection_x_coordinate"}, {"units", "km"}}};
    for (std::uint32_t i = 0; i < kColumnX; ++i) x.values.push_back(0.05 + 0.1 * i);
    NetcdfVariable y{"y", {"y"}, {}, {{"axis", "Y"}, {"units", "m"}}};
    for (std::uint32_t j = kColumnY; j-- > 0;) y.values.push_back(50 + 100.0 * j);
    NetcdfVariable depth{
        "depth", {"depth"}, {}, {{"units", "m"}, {"positive", "down"}, {"bounds", "depth_bounds"}}};
    NetcdfVariable bounds{"depth_bounds", {"depth", "ends"}, {}, {}};
    for (std::size_t k = 0; k + 1 < kDepthEdges_m.size(); ++k) {
      depth.values.push_back(0.5 * (kDepthEdges_m[k] + kDepthEdges_m[k + 1]));
      bounds.values.insert(bounds.values.end(), {kDepthEdges_m[k], kDepthEdges_m[k + 1]});
    }
    NetcdfVariable values{"chl",
                          {"time", "depth", "y", "x"},
                          {},
                          {{"scale_factor", 0.01}, {"add_offset", 0.0}, {"_FillValue", -999.0}},
                          NetcdfType::kShort};
    for (std::uint32_t t = 0; t < 2; ++t) {
      for (std::uint32_t k = 0; k < 4; ++k) {
        for (std::uint32_t j = kColumnY; j-- > 0;) {
          for (std::uint32_t i = 0; i < kColumnX; ++i)
            values.values.push_back(i == 0 ? -999 : t * std::round(100 * chlorophyll(i, j, k)));
        }
      }
    }
    variables = {x, y, depth, bounds, {"time", {"time"}, {0, 6}, {{"units", "hours"}}}, values};
  }

  void rename(const std::string& dimension, const std::string& other) {
    for (auto& [name, length] : dimensions) name = name == dimension ? other : name;
    for (NetcdfVariable& variable : variables) {
      for (std::string& name : variable.dimensions) name = name == dimension ? other : name;
    }
    at(dimension).attributes.clear();
    at(dimension).name = other;
  }

  /// To `side` cells along each axis in space, whose numbers are not in the file.
  void grow(std::uint32_t side) {
    dimensions = {{"depth", side}, {"y", side}, {"x", side}};
    variables.clear();
    for (const char* axis : {"depth", "y", "x"}) {
      NetcdfVariable one{axis, {axis}, {}, {{"units", "m"}}};
      for (std::uint32_t i = 0; i < side; ++i) one.values.push_back(i);
      variables.push_back(one);
    }
    variables.push_back({"chl", {"depth", "y", "x"}, {}, {}, NetcdfType::kShort});
  }

  void write(const std::filesystem::path& file) const { NetcdfWriter(file, dimensions, variables); }
};

/// Needs `file` beside it; `choice` chooses the time.
inline std::string water_column_scenario(const std::string& choice = "time_index: 1") {
  return "description: \"Gliders sample a water column where a model has chlorophyll\"\n"
         "domain { size_x_m: 800 size_y_m: 600 origin_z_m: -60 size_z_m: 60 }\n"
         "target { voxels { file: \"column.nc\" variable: \"chl\" " +
         choice +
         " } }\n"
         "basis { modes_x: 8 modes_y: 8 modes_z: 6 }\n"
         "law { u_max_mps: 2 }\ntime { duration_s: 60 }\nagents { random_count: 3 }\n";
}

}  // namespace ergocast::test
