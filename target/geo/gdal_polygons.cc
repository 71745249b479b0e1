// SPDX-License-Identifier: BSD-3-Clause
// The child answers with JSON: the polygons, or a problem.
#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "target/geo/bounded_child.h"
#include "target/geo/gdal_files.h"
#include "target/geo/gdal_library.h"
#include "text/input_file.h"

namespace ergocast {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using Handle = GdalLibrary::Handle;

/// More than any scenario takes.
constexpr std::size_t kMostPlaces = 200'000;

struct BadLayer {
  PolygonFileProblem problem;
};
[[noreturn]] void reject_layer(const std::string& member, std::string what, std::string remedy) {
  throw BadLayer{{member, std::move(what), std::move(remedy)}};
}

class LayerReader {
 public:
  explicit LayerReader(const fs::path& file) : file_(file) {}

  Json polygons() {
    const bool package = file_.extension() == ".gpkg";
    const char* const drivers[] = {package ? "RegisterOGRGeoPackage" : "RegisterOGRShape", nullptr};
    if (!gdal_.load(drivers, true)) reject_layer("", gdal_is_missing(), gdal_remedy());
    earth_ = gdal_.reference("+proj=longlat +datum=WGS84 +no_defs");
    constexpr unsigned kVector = 4, kReportsErrors = 64;
    const Handle dataset =
        gdal_.GDALOpenEx(file_.c_str(), kVector | kReportsErrors, nullptr, nullptr, nullptr);
    if (dataset == nullptr)
      reject_layer("", "cannot be opened" + GdalLibrary::reported(), "save it anew");
    for (int i = 0; i < gdal_.GDALDatasetGetLayerCount(dataset); ++i)
      layer(gdal_.GDALDatasetGetLayer(dataset, i));
    if (!problems_.empty()) throw BadLayer{problems_.all()};
    if (!GdalLibrary::reported().empty())
      reject_layer("", "GDAL" + GdalLibrary::reported(), "save it anew");
    if (found_.empty()) reject_layer("", "has no polygon", "draw one, or name another file");
    return found_;
  }

 private:
  void layer(Handle layer) {
    constexpr int kTable = 100;  // without places
    if (gdal_.OGR_L_GetGeomType(layer) == kTable) return;
    const std::string name = std::string("layer ") + gdal_.OGR_L_GetName(layer);
    to_earth_ = nullptr;
    while (!problems_.full() && places_ <= kMostPlaces) {
      const Handle feature = gdal_.OGR_L_GetNextFeature(layer);
      if (feature == nullptr) return;
      if (to_earth_ == nullptr) enter(layer, name);
      const std::string member = name + ", feature " + std::to_string(gdal_.OGR_F_GetFID(feature));
      try {
        this->feature(feature, member);
      } catch (const BadLayer& refused) {
        problems_.add(refused.problem);
      }
      gdal_.OGR_F_Destroy(feature);
    }
  }

  void feature(Handle feature, const std::string& member) {
    const Handle geometry = gdal_.OGR_F_GetGeometryRef(feature);
    if (geometry == nullptr) reject_layer(member, "has no geometry", "delete it there, or draw it");
    this->geometry(geometry, member);
  }

  void enter(Handle layer, const std::string& name) {
    const Handle reference = gdal_.OGR_L_GetSpatialRef(layer);
    if (reference == nullptr)
      reject_layer(name, "does not say where on the earth it lies",
                   "name its reference system: ogr2ogr -a_srs EPSG:25832 out.gpkg in.shp");
    if (gdal_.OSRIsLocal(reference) != 0)
      reject_layer(
          name, "is in a local system, which has no place on the earth",
          "write vertices in metres, or bring it to a system of EPSG: in QGIS, Georeferencer");
    to_earth_ = gdal_.transformation(reference, earth_);
    if (to_earth_ == nullptr)
      reject_layer(name, "cannot be brought to WGS 84" + GdalLibrary::reported(),
                   "name its system: ogr2ogr -s_srs EPSG:25832 -t_srs EPSG:4326 out.gpkg in.gpkg");
  }

  void geometry(Handle geometry, const std::string& member) {
    constexpr int kPolygon = 3, kMultiPolygon = 6, kCollection = 7;
    const int type = gdal_.OGR_GT_Flatten(gdal_.OGR_G_GetGeometryType(geometry));
    const int parts = gdal_.OGR_G_GetGeometryCount(geometry);
    if (type != kPolygon && type != kMultiPolygon && type != kCollection)
      reject_layer(
          member, std::string("is a ") + gdal_.OGR_G_GetGeometryName(geometry) + ", not a polygon",
          "keep polygons only; of curves: ogr2ogr -nlt CONVERT_TO_LINEAR out.gpkg in.gpkg");
    if (parts == 0) reject_layer(member, "is empty", "delete it there, or draw it");
    Json rings = Json::array();
    for (int i = 0; i < parts; ++i) {
      const Handle part = gdal_.OGR_G_GetGeometryRef(geometry, i);
      if (type == kPolygon) {
        rings.push_back(ring(part, member));
      } else {
        this->geometry(part, member);
      }
    }
    if (type == kPolygon) found_.push_back({member, std::move(rings)});
  }

  /// Longitudes and latitudes by turns.
  Json ring(Handle ring, const std::string& member) {
    const int count = std::max(0, gdal_.OGR_G_GetPointCount(ring));
    places_ += static_cast<std::size_t>(count);
    if (places_ > kMostPlaces)
      reject_layer("", "has more than 200 000 vertices",
                   "simplify it: ogr2ogr -simplify 1 out.gpkg in.gpkg");
    std::vector<double> x, y;
    for (int i = 0; i < count; ++i) {
      x.push_back(gdal_.OGR_G_GetX(ring, i));
      y.push_back(gdal_.OGR_G_GetY(ring, i));
    }
    std::vector<int> done(x.size());
    gdal_.OCTTransformEx(to_earth_, count, x.data(), y.data(), nullptr, done.data());
    Json places = Json::array();
    for (std::size_t i = 0; i < x.size(); ++i) {
      if (done[i] == 0 || !(std::abs(x[i]) <= 180) || !(std::abs(y[i]) <= 90))
        reject_layer(member, "has a place that is nowhere on the earth" + GdalLibrary::reported(),
                     "name its reference system: ogr2ogr -a_srs EPSG:25832 out.gpkg in.gpkg");
      if (i == 0 || x[i] != x[i - 1] || y[i] != y[i - 1]) {
        places.push_back(x[i]);
        places.push_back(y[i]);
      }
    }
    while (places.size() > 2 && places[0] == places[places.size() - 2] &&
           places[1] == places.back()) {
      places.erase(places.size() - 1);
      places.erase(places.size() - 1);
    }
    if (places.size() < 6)
      reject_layer(member, "has a ring with fewer than three places", "draw more, or delete it");
    return places;
  }

  fs::path file_;
  GdalLibrary gdal_{};
  Handle earth_ = nullptr, to_earth_ = nullptr;
  std::size_t places_ = 0;
  Json found_ = Json::array();
  PolygonFileProblems problems_;
};

Json json_of(const PolygonFileProblem& problem) {
  return {problem.member, problem.what, problem.remedy};
}

std::string polygons_answer(const fs::path& file) {
  Json result;
  try {
    result["polygons"] = LayerReader(file).polygons();
  } catch (const BadLayer& refused) {
    result["problems"].push_back(json_of(refused.problem));
    for (const PolygonFileProblem& other : refused.problem.more)
      result["problems"].push_back(json_of(other));
  }
  return result.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace

std::optional<std::string> gdal_name(const fs::path& file) {
  std::string name = fs::weakly_canonical(fs::absolute(file)).string();
  if (name.starts_with("/vsi")) return std::nullopt;
  return name;
}

bool is_gdal_polygons(const fs::path& file) {
  return file.extension() == ".gpkg" || file.extension() == ".shp";
}

Result<std::vector<GeoPolygon>, PolygonFileProblem> read_gdal_polygons(const fs::path& file) {
  const InputFile in(file);
  if (const auto& problem = in.problem())
    return failure(PolygonFileProblem{"", problem->what, problem->remedy});
  const auto whole = gdal_name(file);
  if (!whole)
    return failure(PolygonFileProblem{"", "has the name of a virtual file", "move it elsewhere"});
  const auto told =
      in_bounded_child(std::size_t{64} << 20, [&] { return polygons_answer(*whole); });
  if (!told)
    return failure(
        PolygonFileProblem{"", "GDAL cannot read it within 20 s of processor time and 768 MiB",
                           "simplify it: ogr2ogr -simplify 1 out.gpkg in.gpkg"});
  const Json result = Json::parse(*told);  // the child has printed all of it
  PolygonFileProblems problems;
  for (const Json& one : result.value("problems", Json::array()))
    problems.add({one[0], one[1], one[2]});
  if (!problems.empty()) return failure(problems.all());
  std::vector<GeoPolygon> polygons;
  for (const Json& one : result["polygons"]) {
    GeoPolygon& polygon = polygons.emplace_back();
    polygon.member = one[0];
    for (const Json& ring : one[1]) {
      auto& places = polygon.rings.emplace_back();
      for (std::size_t i = 0; i + 1 < ring.size(); i += 2) places.push_back({ring[i + 1], ring[i]});
    }
  }
  return polygons;
}

}  // namespace ergocast
