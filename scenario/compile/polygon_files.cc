// SPDX-License-Identifier: BSD-3-Clause
// Places the polygons in the plane, then checks each as one that is written in the scenario.
#include "scenario/compile/polygon_files.h"

#include <optional>
#include <utility>
#include <vector>

#include "scenario/compile/drawn_polygons.h"
#include "scenario/compile/map_walls.h"
#include "scenario/parse/convert.h"
#include "scenario/rules/polygon_flaw.h"
#include "scenario/rules/validate_target.h"
#include "target/geo/gdal_files.h"
#include "target/geo/geojson.h"
#include "target/geo/kml.h"

namespace ergocast {
namespace {

/// Whether the box around the outline has a point in common with the domain.
bool meets(const Polygon& polygon, const Box& domain) {
  Eigen::Vector2d low = polygon.outline.front(), high = low;
  for (const Eigen::Vector2d& corner : polygon.outline) {
    low = low.cwiseMin(corner);
    high = high.cwiseMax(corner);
  }
  const Eigen::Vector2d from = domain.origin_m.head<2>(), to = from + domain.size_m.head<2>();
  return (high.array() > from.array()).all() && (low.array() < to.array()).all();
}

template <class Vertices>
void write_ring(const Ring& ring, Vertices& vertices) {
  for (const Eigen::Vector2d& corner : ring) {
    proto::Vertex& vertex = *vertices.Add();
    vertex.set_x_m(corner.x());
    vertex.set_y_m(corner.y());
  }
}

/// Replaces the file that `written` names by a polygon between the same heights.
void write_polygon(const Polygon& polygon, proto::Polygon& written) {
  written.clear_file();
  written.clear_unknown_free();
  written.clear_solid_white();
  written.clear_vertices();
  written.clear_holes();
  write_ring(polygon.outline, *written.mutable_vertices());
  for (const Ring& hole : polygon.holes) write_ring(hole, *written.add_holes()->mutable_vertices());
}

class PolygonFileReader {
 public:
  PolygonFileReader(proto::Scenario& scenario, Checks& checks, Findings& findings)
      : scenario_(scenario),
        target_(*scenario.mutable_target()),
        checks_(checks),
        findings_(findings) {
    const proto::Origin& origin = scenario.origin();
    const GeoPlace place{origin.latitude_deg(), origin.longitude_deg()};
    const bool is_place = place.latitude_deg >= -90 && place.latitude_deg <= 90 &&
                          place.longitude_deg >= -180 && place.longitude_deg <= 180;
    if (scenario.has_origin() && is_place) plane_.emplace(place);
  }

  /// Returns the occupancy maps and their pictures.
  PolygonFiles run() {
    for (int i = 0, listed = target_.regions_size(); i < listed; ++i) region(i);
    polygons(*target_.mutable_keep_outs(), "target.keep_outs");
    if (scenario_.world().walls_size() > 0)
      polygons(*scenario_.mutable_world()->mutable_walls(), "world.walls");
    return std::move(found_);
  }

 private:
  void region(int index) {
    const std::string path = indexed("target.regions", index);
    proto::Region& written = *target_.mutable_regions(index);
    double area = 0;
    const auto found = read(written.polygon(), path + ".polygon", area);
    const double weight = written.weight();
    for (std::size_t i = 0; i < found.size(); ++i) {
      if (i > 0) name(found[i], "target.regions", target_.regions_size());
      proto::Region& one = i == 0 ? *target_.mutable_regions(index) : *target_.add_regions();
      if (i > 0) one = target_.regions(index);
      one.set_weight(weight * area_m2(found[i].polygon) / area);
      write_polygon(found[i].polygon, *one.mutable_polygon());
    }
  }

  /// Reads the files of keep-outs or walls.
  void polygons(google::protobuf::RepeatedPtrField<proto::Polygon>& list, const std::string& path) {
    for (int index = 0, listed = list.size(); index < listed; ++index) {
      double area = 0;
      const auto found = read(list[index], indexed(path, index), area);
      for (std::size_t i = 0; i < found.size(); ++i) {
        if (i > 0) name(found[i], path, list.size());
        proto::Polygon& one = i == 0 ? list[index] : *list.Add();
        if (i > 0) one = list[index];
        write_polygon(found[i].polygon, one);
      }
    }
  }

  /// Problems of the block that is added next are those of the file's member.
  void name(const PlacedPolygon& polygon, const std::string& list, int index) {
    findings_.blame(indexed(list, index), file_ + ": " + polygon.member);
  }

  /// The polygons of the file that meet the domain; none if there is no file or a problem.
  /// @param area  [m²] of all in the file
  std::vector<PlacedPolygon> read(const proto::Polygon& written, const std::string& path,
                                  double& area) {
    const bool map = written.has_file() && is_occupancy_map(written.file());
    if (written.has_unknown_free() && !map)
      checks_.problem(path + ".unknown_free", "is for occupancy maps: files that end in .yaml",
                      "remove it");
    if (written.has_solid_white() && !written.file().ends_with(".svg"))
      checks_.problem(path + ".solid_white", "is for drawings: files that end in .svg",
                      "remove it");
    if (!written.has_file()) return {};
    const std::string field = path + ".file";
    if (written.vertices_size() > 0 || written.holes_size() > 0) {
      checks_.problem(field, "stands beside vertices or holes", "keep one of them");
      return {};
    }
    file_ = written.file();
    if (map) return in_map(written, path, field);
    const bool drawing = file_.ends_with(".svg");
    if (!drawing && !scenario_.has_origin()) {
      checks_.problem(field, "needs to know where on the earth the scenario lies",
                      "add origin { latitude_deg: … longitude_deg: … }, the place of (0, 0)");
    }
    const proto::Domain& domain = scenario_.domain();
    const bool has_place = drawing || plane_.has_value();
    if (!has_place || !checks_.sound("domain") || !(domain.size_x_m() > 0) ||
        !(domain.size_y_m() > 0))
      return {};
    auto found = drawing
                     ? drawn(field, {written.solid_white(), !path.starts_with("target.regions")})
                     : on_earth(field);
    if (!found) return {};
    return inside(std::move(*found), field, area);
  }

  /// The walls that an occupancy map has in and near the domain.
  std::vector<PlacedPolygon> in_map(const proto::Polygon& written, const std::string& path,
                                    const std::string& field) {
    if (!path.starts_with("world.walls")) {
      checks_.problem(field, "names an occupancy map, which has walls",
                      "write world { walls { file: … } }; the target leaves walls out");
      return {};
    }
    const Box domain = domain_of(scenario_.domain());
    const bool has_area = domain.size_m.x() > 0 && domain.size_m.y() > 0;
    if (!checks_.sound("domain") || !has_area) return {};
    auto walls = read_map_walls(file_, domain, written.unknown_free(), bodies());
    if (!walls) {
      checks_.problem(field, walls.error().what, walls.error().remedy);
      return {};
    }
    found_.files.push_back(std::move(walls->image));
    if (!all_sound(walls->polygons, field, domain)) return {};
    refuse_starts(walls->starts, path);
    found_.maps.push_back(std::move(walls->rooms));
    return std::move(walls->polygons);
  }

  /// Names what the map shows at starts that are solid. Those in occupied cells are in a wall like
  /// any other.
  void refuse_starts(const std::vector<SolidPlace>& starts, const std::string& path) {
    for (std::size_t i = 0; i < starts.size(); ++i) {
      const std::string start = indexed("agents.starts", static_cast<int>(i));
      if (starts[i] == SolidPlace::kUnknown)
        checks_.problem(start, "is in unknown space of " + file_ + ", which is solid",
                        "move it, or write unknown_free: true in " + path);
      if (starts[i] == SolidPlace::kClosed)
        checks_.problem(start,
                        "is in free space of " + file_ +
                            " that bodies cannot reach from the first start, or that is too small",
                        "move it, or write a smaller world.wall_clearance_m");
    }
  }

  MapBodies bodies() const {
    MapBodies bodies{std::max(0.0, scenario_.world().wall_clearance_m()), {}};
    for (const proto::Start& start : scenario_.agents().starts())
      bodies.starts_m.emplace_back(start.x_m(), start.y_m());
    return bodies;
  }

  /// The polygons that meet the domain, if all are valid.
  std::vector<PlacedPolygon> inside(std::vector<PlacedPolygon> found, const std::string& field,
                                    double& area) {
    const Box domain = domain_of(scenario_.domain());
    for (const PlacedPolygon& one : found) area += area_m2(one.polygon);
    if (!all_sound(found, field, domain)) return {};
    std::erase_if(found, [&](const PlacedPolygon& one) { return !meets(one.polygon, domain); });
    if (found.empty()) {
      refuse(field, "", "none of its polygons meets the domain",
             "move the origin or the domain there");
    }
    return found;
  }

  void refuse(const std::string& field, const std::string& member, const std::string& what,
              std::string remedy) {
    checks_.problem(field, file_ + ": " + (member.empty() ? "" : member + ": ") + what,
                    std::move(remedy));
  }

  void refuse(const std::string& field, const PolygonFileProblem& problem) {
    refuse(field, problem.member, problem.what, problem.remedy);
    for (const PolygonFileProblem& other : problem.more) refuse(field, other);
  }

  /// @param vertices  of all polygons of the file
  bool few_enough(std::size_t vertices, const std::string& field, std::string remedy) {
    if (vertices <= kMaxVertices) return true;
    refuse(field, "",
           "has " + std::to_string(vertices) + " vertices, above the limit " +
               std::to_string(kMaxVertices),
           std::move(remedy));
    return false;
  }

  bool all_sound(const std::vector<PlacedPolygon>& polygons, const std::string& field,
                 const Box& domain) {
    PolygonFileProblems problems;
    for (const PlacedPolygon& one : polygons)
      if (const auto flaw = flaw_of(one.polygon, least_area_m2(domain.size_m.maxCoeff())))
        problems.add({one.member, "ring " + std::to_string(flaw->hole + 1) + ": " + flaw->what,
                      flaw->remedy});
    if (!problems.empty()) refuse(field, problems.all());
    return problems.empty();
  }

  std::optional<std::vector<PlacedPolygon>> drawn(const std::string& field, const DrawnAs& as) {
    const auto read = read_svg(file_, as.solid_white);
    if (!read) {
      refuse(field, read.error());
      return std::nullopt;
    }
    auto placed = place_drawing(*read, domain_of(scenario_.domain()), as);
    if (!placed) {
      refuse(field, placed.error());
      return std::nullopt;
    }
    std::size_t vertices = 0;
    for (const PlacedPolygon& one : *placed) {
      vertices += one.polygon.outline.size();
      for (const Ring& hole : one.polygon.holes) vertices += hole.size();
    }
    if (!few_enough(vertices, field, "simplify it: in Inkscape, Path > Simplify"))
      return std::nullopt;
    return *std::move(placed);
  }

  std::optional<std::vector<PlacedPolygon>> on_earth(const std::string& field) {
    const auto read = is_gdal_polygons(file_)   ? read_gdal_polygons(file_)
                      : file_.ends_with(".kml") ? read_kml(file_)
                                                : read_geojson(file_);
    if (!read) {
      refuse(field, read.error());
      return std::nullopt;
    }
    const auto& polygons = *read;
    std::size_t vertices = 0;
    for (const GeoPolygon& polygon : polygons)
      for (const auto& ring : polygon.rings) vertices += ring.size();
    if (!few_enough(vertices, field,
                    "simplify it: ogr2ogr -simplify 0.0001 out.geojson in.geojson"))
      return std::nullopt;
    note_without_place(polygons, field);
    std::vector<PlacedPolygon> placed;
    PolygonFileProblems problems;
    for (const GeoPolygon& polygon : polygons) {
      if (polygon.rings.empty()) continue;
      auto local = local_polygon(polygon);
      if (!local) problems.add(std::move(local.error()));
      if (local) placed.push_back(std::move(*local));
    }
    if (problems.empty()) return placed;
    refuse(field, problems.all());
    return std::nullopt;
  }

  void note_without_place(const std::vector<GeoPolygon>& polygons, const std::string& field) {
    const auto has_none = [](const GeoPolygon& one) { return one.rings.empty(); };
    const auto first = std::ranges::find_if(polygons, has_none);
    if (first == polygons.end()) return;
    const auto others = std::count_if(first + 1, polygons.end(), has_none);
    findings_.note(field,
                   file_ + ": " + first->member + ": has no place, and is left out" +
                       (others > 0 ? ", with " + std::to_string(others) + " more" : ""),
                   "delete it there, or draw it");
  }

  Result<PlacedPolygon, PolygonFileProblem> local_polygon(const GeoPolygon& polygon) const {
    PlacedPolygon local{polygon.member, {}};
    for (std::size_t i = 0; i < polygon.rings.size(); ++i) {
      Ring ring;
      for (const GeoPlace& place : polygon.rings[i]) {
        ring.push_back(plane_->to_local_m(place));
        if (ring.back().norm() <= kFarthest_m) continue;
        return failure(PolygonFileProblem{polygon.member,
                                          "[" + shortest(place.longitude_deg) + ", " +
                                              shortest(place.latitude_deg) +
                                              "] is more than 1000 km from the origin",
                                          "write longitude before latitude; or move the origin"});
      }
      if (i == 0) {
        local.polygon.outline = std::move(ring);
      } else {
        local.polygon.holes.push_back(std::move(ring));
      }
    }
    return local;
  }

  proto::Scenario& scenario_;
  proto::Target& target_;
  Checks& checks_;
  Findings& findings_;
  std::optional<LocalPlane> plane_;  // nothing while the origin is invalid
  std::string file_;                 // that is being read
  PolygonFiles found_;
};

}  // namespace

bool is_geodata(const std::filesystem::path& file) {
  const std::filesystem::path end = file.extension();
  return end == ".geojson" || end == ".json" || end == ".kml" || is_gdal_polygons(file);
}

bool is_polygon_file(const std::filesystem::path& file) {
  return is_geodata(file) || file.extension() == ".svg";
}

PolygonFiles read_polygon_files(proto::Scenario& scenario, Checks& checks, Findings& findings) {
  std::vector<std::filesystem::path> files;
  const auto add = [&files](const proto::Polygon& polygon) {
    if (!polygon.has_file()) return;
    files.emplace_back(polygon.file());
    if (!polygon.file().ends_with(".shp")) return;
    for (const char* part : {".shx", ".dbf", ".prj", ".cpg"}) {
      const auto beside = std::filesystem::path(polygon.file()).replace_extension(part);
      if (std::filesystem::exists(beside)) files.push_back(beside);
    }
  };
  for (const proto::Region& region : scenario.target().regions()) add(region.polygon());
  for (const proto::Polygon& keep_out : scenario.target().keep_outs()) add(keep_out);
  for (const proto::Polygon& wall : scenario.world().walls()) add(wall);
  PolygonFiles found = PolygonFileReader(scenario, checks, findings).run();
  found.files.insert(found.files.begin(), files.begin(), files.end());
  return found;
}

}  // namespace ergocast
