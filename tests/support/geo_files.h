// SPDX-License-Identifier: BSD-3-Clause
// Small files of geodata for tests: GeoTIFF and shapefiles, in UTM zone 32 north.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <bit>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace ergocast::test {

/// Numbers as bytes, the lowest first.
class LittleEndian {
 public:
  template <class Number>
  LittleEndian& add(Number number) {
    static_assert(std::endian::native == std::endian::little);
    bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
    return *this;
  }
  LittleEndian& add_turned(std::int32_t number) {
    std::string turned(reinterpret_cast<const char*>(&number), sizeof number);
    std::ranges::reverse(turned);
    bytes += turned;
    return *this;
  }
  std::string bytes;
};

/// A local system, for TinyTiff.
inline constexpr std::uint16_t kLocal = 32767;

struct TinyTiff {
  int columns = 40, rows = 30;
  double cell_m = 1;
  Eigen::Vector2d upper_left_m{512330, 5403750};
  std::vector<float> values;  ///< from the north
  std::string no_data = "-9999";
  std::string metadata;          ///< of GDAL, in XML
  std::uint16_t system = 32632;  ///< EPSG; 0 for none
  std::uint16_t bands = 1;
  bool in_degrees = false;  ///< `system` has longitudes and latitudes, and lengths are in degrees

  std::string bytes() const {
    LittleEndian data, file, beside, tags;
    for (int band = 0; band < bands; ++band)
      for (const float value : values) data.add(value);
    const std::uint32_t count =
        (system > 0 ? 13 : 10) + (no_data.empty() ? 0 : 1) + (metadata.empty() ? 0 : 1);
    const std::uint32_t behind = 8 + 2 + 12 * count + 4;
    std::size_t offset_of_data = 0;
    const auto tag = [&](std::uint16_t number, std::uint16_t type, std::size_t values_in,
                         std::string raw) {
      tags.add(number).add(type).add(static_cast<std::uint32_t>(values_in));
      if (number == 273) offset_of_data = tags.bytes.size();
      if (raw.size() <= 4) {
        raw.resize(4);
        tags.bytes += raw;
      } else {
        raw.resize(raw.size() + raw.size() % 2);
        tags.add(static_cast<std::uint32_t>(behind + beside.bytes.size()));
        beside.bytes += raw;
      }
    };
    const auto shorts = [&](std::uint16_t number, const std::vector<std::uint16_t>& list) {
      LittleEndian raw;
      for (const auto value : list) raw.add(value);
      tag(number, 3, list.size(), raw.bytes);
    };
    const auto doubles = [&](std::uint16_t number, const std::vector<double>& list) {
      LittleEndian raw;
      for (const auto value : list) raw.add(value);
      tag(number, 12, list.size(), raw.bytes);
    };
    shorts(256, {static_cast<std::uint16_t>(columns)});
    shorts(257, {static_cast<std::uint16_t>(rows)});
    shorts(258, std::vector<std::uint16_t>(bands, 32));
    shorts(259, {1});
    shorts(262, {1});
    tag(273, 4, 1, "here");
    shorts(277, {bands});
    shorts(278, {static_cast<std::uint16_t>(rows)});
    tag(279, 4, 1, LittleEndian().add(static_cast<std::uint32_t>(data.bytes.size())).bytes);
    shorts(339, std::vector<std::uint16_t>(bands, 3));
    if (system > 0) {
      doubles(33550, {cell_m, cell_m, 0});
      doubles(33922, {0, 0, 0, upper_left_m.x(), upper_left_m.y(), 0});
      const std::uint16_t model = system == kLocal ? kLocal
                                  : in_degrees     ? 2
                                                   : 1,
                          key = in_degrees ? 2048 : 3072;
      shorts(34735, {1, 1, 0, 3, 1024, 0, 1, model, 1025, 0, 1, 1, key, 0, 1, system});
    }
    if (!metadata.empty()) tag(42112, 2, metadata.size() + 1, metadata + '\0');
    if (!no_data.empty()) tag(42113, 2, no_data.size() + 1, no_data + '\0');
    const std::string at =
        LittleEndian().add(static_cast<std::uint32_t>(behind + beside.bytes.size())).bytes;
    tags.bytes.replace(offset_of_data, 4, at);
    file.bytes = "II*";
    file.add('\0').add(std::uint32_t{8}).add(static_cast<std::uint16_t>(count));
    return file.bytes + tags.bytes + std::string(4, '\0') + beside.bytes + data.bytes;
  }
};

/// A shapefile of one part: a ring (type 5) or a line (type 3) through these places [m]. Without
/// places it has no geometry.
/// @param copies  the number of features, which are equal
inline void write_shapefile(std::filesystem::path file, const std::vector<Eigen::Vector2d>& places,
                            std::int32_t type = 5, bool with_system = true, int copies = 1) {
  Eigen::Vector2d low(0, 0), high(0, 0);
  if (!places.empty()) low = high = places.front();
  for (const auto& place : places) {
    low = low.cwiseMin(place);
    high = high.cwiseMax(place);
  }
  LittleEndian shape;
  const auto box = [&](LittleEndian& to) {
    to.add(low.x()).add(low.y()).add(high.x()).add(high.y());
  };
  shape.add(places.empty() ? std::int32_t{0} : type);
  if (!places.empty()) {
    box(shape);
    shape.add(std::int32_t{1}).add(static_cast<std::int32_t>(places.size())).add(std::int32_t{0});
  }
  for (const auto& place : places) shape.add(place.x()).add(place.y());
  const auto words = static_cast<std::int32_t>(shape.bytes.size() / 2);
  const auto head = [&](std::int32_t length) {
    LittleEndian head;
    head.add_turned(9994);
    for (int i = 0; i < 5; ++i) head.add_turned(0);
    head.add_turned(length).add(std::int32_t{1000}).add(type);
    box(head);
    for (int i = 0; i < 4; ++i) head.add(0.0);
    return head;
  };
  LittleEndian shapes, index;
  for (int copy = 0; copy < copies; ++copy) {
    index.add_turned(50 + copy * (4 + words)).add_turned(words);
    shapes.add_turned(copy + 1).add_turned(words).bytes += shape.bytes;
  }
  std::ofstream(file, std::ios::binary) << head(50 + copies * (4 + words)).bytes << shapes.bytes;
  std::ofstream(file.replace_extension(".shx"), std::ios::binary)
      << head(50 + copies * 4).bytes << index.bytes;
  std::filesystem::remove(file.replace_extension(".prj"));
  if (with_system)
    std::ofstream(file) << R"(PROJCS["WGS_1984_UTM_Zone_32N",GEOGCS["GCS_WGS_1984",)"
                           R"(DATUM["D_WGS_1984",SPHEROID["WGS_1984",6378137,298.257223563]],)"
                           R"(PRIMEM["Greenwich",0],UNIT["Degree",0.0174532925199433]],)"
                           R"(PROJECTION["Transverse_Mercator"],PARAMETER["False_Easting",500000],)"
                           R"(PARAMETER["False_Northing",0],PARAMETER["Central_Meridian",9],)"
                           R"(PARAMETER["Scale_Factor",0.9996],PARAMETER["Latitude_Of_Origin",0],)"
                           R"(UNIT["Meter",1]])";
}

}  // namespace ergocast::test
