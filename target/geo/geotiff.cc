// SPDX-License-Identifier: BSD-3-Clause
// The child answers with a line of JSON and the cells from the north, or with a problem.
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <utility>

#include "target/geo/bounded_child.h"
#include "target/geo/gdal_files.h"
#include "target/geo/gdal_library.h"
#include "text/shortest.h"

namespace ergocast {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using Handle = GdalLibrary::Handle;
using Eigen::Vector2d;

struct BadTiff {
  std::string what;
  std::string remedy;
};
[[noreturn]] void reject_tiff(std::string what, std::string remedy) {
  throw BadTiff{std::move(what), std::move(remedy)};
}

/// Cells of the plane along an axis: from `first` times `size` beyond `anchor`.
struct Cells {
  double anchor, size;
  double first;
  int count;

  double low() const { return anchor + first * size; }
  double centre(int index) const { return anchor + (first + index + 0.5) * size; }
};

class TiffReader {
 public:
  TiffReader(fs::path file, const GeoPlace& origin, const Box& domain)
      : file_(std::move(file)),
        origin_(origin),
        low_(domain.origin_m.head<2>()),
        high_(low_ + domain.size_m.head<2>()) {}

  std::string answer() {
    open();
    place();
    choose_cells();
    find_pixels();
    std::string cells = values();
    if (!GdalLibrary::reported().empty())
      reject_tiff(" is broken" + GdalLibrary::reported(), "save it anew");
    const Json head = {x_.count, y_.count,           x_.low(),
                       y_.low(), x_.count * x_.size, y_.count * y_.size};
    return head.dump() + '\n' + std::move(cells);
  }

 private:
  void open() {
    const char* const drivers[] = {"GDALRegister_GTiff", nullptr};
    if (!gdal_.load(drivers, false)) reject_tiff(' ' + gdal_is_missing(), gdal_remedy());
    constexpr unsigned kRaster = 2, kReportsErrors = 64;
    data_ = gdal_.GDALOpenEx(file_.c_str(), kRaster | kReportsErrors, nullptr, nullptr, nullptr);
    if (data_ == nullptr) reject_tiff(" is no GeoTIFF" + GdalLibrary::reported(), "save it anew");
    constexpr int kAlpha = 6;
    const int bands = gdal_.GDALGetRasterCount(data_);
    const bool masked = bands == 2 && gdal_.GDALGetRasterColorInterpretation(
                                          gdal_.GDALGetRasterBand(data_, 2)) == kAlpha;
    if (bands != 1 && !masked)
      reject_tiff(" has " + std::to_string(bands) + " bands, and a target has one",
                  "choose one: gdal_translate -b 1 in.tif out.tif");
    band_ = gdal_.GDALGetRasterBand(data_, 1);
    if (gdal_.GDALGetRasterColorTable(band_) != nullptr)
      reject_tiff(" has a table of colours, not values", "name a file with the values themselves");
    if (gdal_.GDALDataTypeIsComplex(gdal_.GDALGetRasterDataType(band_)) != 0)
      reject_tiff(" has complex numbers", "name a file with densities");
  }

  void place() {
    constexpr const char* kSay =
        "say where it lies: gdal_translate -a_srs EPSG:25832 -a_ullr WEST NORTH EAST SOUTH in.tif "
        "out.tif";
    const Handle reference = gdal_.GDALGetSpatialRef(data_);
    std::array<double, 6> six{};
    if (reference == nullptr || gdal_.GDALGetGeoTransform(data_, six.data()) != 0)
      reject_tiff(" does not say where on the earth it lies", kSay);
    if (gdal_.OSRIsLocal(reference) != 0)
      reject_tiff(" is in a local system, which has no place on the earth",
                  "write it as a grid in metres: gdal_translate -of AAIGrid in.tif out.asc");
    to_system_.matrix() << six[1], six[2], six[0], six[4], six[5], six[3], 0, 0, 1;
    if (std::abs(to_system_.linear().determinant()) < 1e-300)
      reject_tiff(" has cells without a size", kSay);
    to_pixels_ = to_system_.inverse();
    const Handle plane = gdal_.reference("+proj=aeqd +lat_0=" + shortest(origin_.latitude_deg) +
                                         " +lon_0=" + shortest(origin_.longitude_deg) +
                                         " +datum=WGS84 +units=m +no_defs");
    to_plane_ = gdal_.transformation(reference, plane);
    from_plane_ = gdal_.transformation(plane, reference);
    if (to_plane_ == nullptr || from_plane_ == nullptr)
      reject_tiff(" cannot be brought to the scenario's plane" + GdalLibrary::reported(),
                  "convert it: gdalwarp -t_srs EPSG:4326 in.tif out.tif");
  }

  Vector2d moved(Handle transformation, Vector2d at) const {
    int done = 0;
    gdal_.OCTTransformEx(transformation, 1, &at.x(), &at.y(), nullptr, &done);
    if (done == 0)
      reject_tiff(" does not reach to the domain" + GdalLibrary::reported(),
                  "move the origin or the domain there");
    return at;
  }
  Vector2d in_plane(const Vector2d& pixel) const { return moved(to_plane_, to_system_ * pixel); }

  void choose_cells() {
    const Vector2d centre = to_pixels_ * moved(from_plane_, (low_ + high_) / 2);
    const Vector2d pixel = centre.array().floor();
    const Vector2d anchor = in_plane(pixel);
    const Vector2d along = in_plane(pixel + Vector2d(1, 0)) - anchor;
    const Vector2d across = in_plane(pixel + Vector2d(0, 1)) - anchor;
    // A picture that is turned by about 90 degrees has its columns along y.
    const bool turned = std::abs(along.y()) > std::abs(along.x());
    x_ = cells((turned ? across : along).norm(), anchor, 0);
    y_ = cells((turned ? along : across).norm(), anchor, 1);
  }

  Cells cells(double size, const Vector2d& anchor, int axis) const {
    Cells cells{anchor[axis], size, std::floor((low_[axis] - anchor[axis]) / size + 1e-6), 0};
    const double count = std::ceil((high_[axis] - anchor[axis]) / size - 1e-6) - cells.first;
    if (!(count <= kMaxGeoTiffSide))
      reject_tiff(" has " + shortest(count) +
                      " cells along a side of the domain, above the limit " +
                      std::to_string(kMaxGeoTiffSide),
                  "coarsen it: gdalwarp -r average -ts 2000 0 in.tif out.tif");
    cells.count = std::max(1, static_cast<int>(count));
    return cells;
  }

  /// For each cell its pixel of the file; (−1, −1) if it is outside.
  void find_pixels() {
    const int width = gdal_.GDALGetRasterXSize(data_), height = gdal_.GDALGetRasterYSize(data_);
    const auto columns = static_cast<std::size_t>(x_.count);
    std::vector<double> x(columns), y(columns);
    std::vector<int> done(columns);
    for (int row = y_.count; row-- > 0;) {
      for (int i = 0; i < x_.count; ++i) {
        x[static_cast<std::size_t>(i)] = x_.centre(i);
        y[static_cast<std::size_t>(i)] = y_.centre(row);
      }
      gdal_.OCTTransformEx(from_plane_, x_.count, x.data(), y.data(), nullptr, done.data());
      for (std::size_t i = 0; i < columns; ++i) {
        const Vector2d at = (to_pixels_ * Vector2d(x[i], y[i])).array().floor();
        const bool inside =
            done[i] != 0 && at.x() >= 0 && at.y() >= 0 && at.x() < width && at.y() < height;
        pixels_.push_back(inside ? at.cast<int>().eval() : Eigen::Vector2i(-1, -1));
      }
    }
  }

  /// The bytes of the values, row by row from the north.
  std::string values() const {
    Eigen::Vector2i from(1 << 30, 1 << 30), to(-1, -1);
    for (const auto& pixel : pixels_) {
      if (pixel.x() < 0) continue;
      from = from.cwiseMin(pixel);
      to = to.cwiseMax(pixel);
    }
    if (to.x() < 0)
      reject_tiff(" has no cell in the domain", "move the origin or the domain there");
    const Eigen::Vector2i size = to - from + Eigen::Vector2i(1, 1);
    const std::size_t count =
        static_cast<std::size_t>(size.x()) * static_cast<std::size_t>(size.y());
    std::vector<double> window(count);
    std::vector<std::uint8_t> mask(count);
    constexpr int kByte = 1, kDouble = 7;
    const auto read = [&](Handle band, void* to_buffer, int type) {
      return gdal_.GDALRasterIO(band, 0, from.x(), from.y(), size.x(), size.y(), to_buffer,
                                size.x(), size.y(), type, 0, 0) == 0;
    };
    if (!read(band_, window.data(), kDouble) ||
        !read(gdal_.GDALGetMaskBand(band_), mask.data(), kByte))
      reject_tiff(" is broken" + GdalLibrary::reported(), "save it anew");
    const double scale = factor(gdal_.GDALGetRasterScale, 1);
    const double offset = factor(gdal_.GDALGetRasterOffset, 0);
    std::string bytes;
    bytes.reserve(pixels_.size() * sizeof(double));
    for (const auto& pixel : pixels_) {
      double value = 0;
      if (pixel.x() >= 0) {
        const auto at =
            static_cast<std::size_t>(pixel.y() - from.y()) * static_cast<std::size_t>(size.x()) +
            static_cast<std::size_t>(pixel.x() - from.x());
        if (mask[at] != 0) value = checked(window[at] * scale + offset, pixel);
      }
      bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
    }
    return bytes;
  }

  double factor(double (*read)(Handle, int*), double otherwise) const {
    int is_set = 0;
    const double value = read(band_, &is_set);
    return is_set != 0 ? value : otherwise;
  }

  static double checked(double value, const Eigen::Vector2i& pixel) {
    if (value >= 0 && value <= kMaxMapValue) return value;
    reject_tiff(", column " + std::to_string(pixel.x()) + ", row " + std::to_string(pixel.y()) +
                    ": " + shortest(value) + " is no density",
                "write numbers from 0 to 1e30; if it is for no data: gdal_edit.py -a_nodata " +
                    shortest(value) + " FILE");
  }

  fs::path file_;
  GeoPlace origin_;
  Vector2d low_, high_;  // of the domain
  GdalLibrary gdal_{};
  Handle data_ = nullptr, band_ = nullptr, to_plane_ = nullptr, from_plane_ = nullptr;
  Eigen::Affine2d to_system_, to_pixels_;  // from pixels, and to them
  Cells x_{}, y_{};
  std::vector<Eigen::Vector2i> pixels_;
};

std::string tiff_answer(const fs::path& file, const GeoPlace& origin, const Box& domain) {
  try {
    return TiffReader(file, origin, domain).answer();
  } catch (const BadTiff& refused) {
    return Json{{"what", refused.what}, {"remedy", refused.remedy}}.dump(
        -1, ' ', false, Json::error_handler_t::replace);
  }
}

/// A problem, or the size and place of as many cells as follow; null if the child has failed.
Json head_of(const std::string& answer) {
  const std::size_t line = std::min(answer.find('\n'), answer.size());
  Json head = Json::parse(answer.substr(0, line), nullptr, false);
  if (head.is_object()) return head;
  if (!head.is_array() || head.size() != 6) return {};
  const std::size_t cells = head[0].get<std::size_t>() * head[1].get<std::size_t>();
  return answer.size() == line + 1 + cells * sizeof(double) ? head : Json();
}

class GeoTiff : public MapFile {
 public:
  /// @param head    of the child's answer
  /// @param answer  which ends with the cells
  GeoTiff(const Json& head, std::string answer)
      : answer_(std::move(answer)), at_(answer_.find('\n') + 1) {
    columns_ = head[0];
    rows_ = head[1];
    extent_ = Rectangle{Vector2d(head[2].get<double>(), head[3].get<double>()),
                        Vector2d(head[4].get<double>(), head[5].get<double>())};
  }

  std::optional<MapProblem> next_row(std::span<double> values) override {
    std::memcpy(values.data(), answer_.data() + at_, values.size_bytes());
    at_ += values.size_bytes();
    return {};
  }

 private:
  std::string answer_;
  std::size_t at_;
};

}  // namespace

OpenedMap open_geotiff(const fs::path& file, const GeoPlace& origin, const Box& domain) {
  if (auto problem = why_unreadable(file)) return failure(*problem);
  const auto whole = gdal_name(file);
  if (!whole)
    return failure(
        MapProblem{file.string() + " has the name of a virtual file", "move it elsewhere"});
  auto told =
      in_bounded_child(std::size_t{192} << 20, [&] { return tiff_answer(*whole, origin, domain); });
  const Json head = told ? head_of(*told) : Json();
  if (head.is_null())
    return failure(MapProblem{
        file.string() + ": GDAL cannot read it within 20 s of processor time and 768 MiB",
        "coarsen it: gdalwarp -r average -ts 2000 0 in.tif out.tif"});
  if (head.is_object())
    return failure(MapProblem{file.string() + head["what"].get<std::string>(), head["remedy"]});
  return std::make_unique<GeoTiff>(head, *std::move(told));
}

}  // namespace ergocast
