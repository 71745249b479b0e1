// SPDX-License-Identifier: BSD-3-Clause
// Projects the positions, then checks each polygon as one that is written in the scenario.
#include "scenario/geojson_target.h"

#include <optional>
#include <utility>
#include <vector>

#include "geo/geojson.h"
#include "scenario/convert.h"
#include "scenario/polygon_flaw.h"
#include "scenario/validate_target.h"

namespace ergocast {
namespace {

struct ReadPolygon {
  std::string member;
  Polygon polygon;
};

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

void write_polygon(const Polygon& polygon, proto::Polygon& written) {
  written.Clear();
  write_ring(polygon.outline, *written.mutable_vertices());
  for (const Ring& hole : polygon.holes) write_ring(hole, *written.add_holes()->mutable_vertices());
}

class GeoJsonReader {
 public:
  GeoJsonReader(proto::Scenario& scenario, Checks& checks, Findings& findings)
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

  void run() {
    for (int i = 0, listed = target_.regions_size(); i < listed; ++i) region(i);
    for (int i = 0, listed = target_.keep_outs_size(); i < listed; ++i) keep_out(i);
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
      one.set_weight(weight * area_m2(found[i].polygon) / area);
      write_polygon(found[i].polygon, *one.mutable_polygon());
    }
  }

  void keep_out(int index) {
    double area = 0;
    const auto found = read(target_.keep_outs(index), indexed("target.keep_outs", index), area);
    for (std::size_t i = 0; i < found.size(); ++i) {
      if (i > 0) name(found[i], "target.keep_outs", target_.keep_outs_size());
      write_polygon(found[i].polygon,
                    i == 0 ? *target_.mutable_keep_outs(index) : *target_.add_keep_outs());
    }
  }

  /// Problems of the block that is added next are those of the file's member.
  void name(const ReadPolygon& polygon, const std::string& list, int index) {
    findings_.blame(indexed(list, index), file_ + ": " + polygon.member);
  }

  /// The polygons of the file that meet the domain; none if there is no file or a problem.
  /// @param area  [m²] of all in the file
  std::vector<ReadPolygon> read(const proto::Polygon& written, const std::string& path,
                                double& area) {
    if (!written.has_file()) return {};
    const std::string field = path + ".file";
    if (written.vertices_size() > 0 || written.holes_size() > 0) {
      checks_.problem(field, "stands beside vertices or holes", "keep one of them");
      return {};
    }
    if (!scenario_.has_origin()) {
      checks_.problem(field, "needs to know where on the earth the scenario lies",
                      "add origin { latitude_deg: … longitude_deg: … }, the place of (0, 0)");
      return {};
    }
    file_ = written.file();
    const proto::Domain& domain = scenario_.domain();
    if (!plane_ || !checks_.sound("domain") || !(domain.size_x_m() > 0) || !(domain.size_y_m() > 0))
      return {};
    auto read = read_geojson(file_);
    if (const auto* problem = std::get_if<GeoJsonProblem>(&read)) {
      refuse(field, problem->member, problem->what, problem->remedy);
      return {};
    }
    return in_metres(std::get<0>(read), field, area);
  }

  void refuse(const std::string& field, const std::string& member, const std::string& what,
              std::string remedy) {
    checks_.problem(field, file_ + ": " + (member.empty() ? "" : member + ": ") + what,
                    std::move(remedy));
  }

  std::vector<ReadPolygon> in_metres(const std::vector<GeoPolygon>& polygons,
                                     const std::string& field, double& area) {
    int vertices = 0;
    for (const GeoPolygon& polygon : polygons)
      for (const auto& ring : polygon.rings) vertices += static_cast<int>(ring.size());
    if (vertices > kMaxVertices) {
      refuse(field, "",
             "has " + std::to_string(vertices) + " vertices, above the limit " +
                 std::to_string(kMaxVertices),
             "simplify it: ogr2ogr -simplify 0.0001 out.geojson in.geojson");
      return {};
    }
    const Box domain = domain_of(scenario_.domain());
    std::vector<ReadPolygon> inside;
    for (const GeoPolygon& polygon : polygons) {
      auto local = local_polygon(polygon, field, domain.size_m.maxCoeff());
      if (!local) return {};
      area += area_m2(local->polygon);
      if (meets(local->polygon, domain)) inside.push_back(std::move(*local));
    }
    if (inside.empty()) {
      refuse(field, "", "none of its polygons meets the domain",
             "move the origin or the domain there");
    }
    return inside;
  }

  std::optional<ReadPolygon> local_polygon(const GeoPolygon& polygon, const std::string& field,
                                           double longer_side_m) {
    ReadPolygon local{polygon.member, {}};
    for (std::size_t i = 0; i < polygon.rings.size(); ++i) {
      Ring ring;
      for (const GeoPlace& place : polygon.rings[i]) {
        ring.push_back(plane_->to_local_m(place));
        if (ring.back().norm() <= kFarthest_m) continue;
        refuse(field, polygon.member,
               "[" + shortest(place.longitude_deg) + ", " + shortest(place.latitude_deg) +
                   "] is more than 1000 km from the origin",
               "write longitude before latitude; or move the origin");
        return std::nullopt;
      }
      if (i == 0) {
        local.polygon.outline = std::move(ring);
      } else {
        local.polygon.holes.push_back(std::move(ring));
      }
    }
    if (const auto flaw = flaw_of(local.polygon, least_area_m2(longer_side_m))) {
      const std::string ring = "ring " + std::to_string(flaw->hole + 1) + ": ";
      refuse(field, polygon.member, ring + flaw->what, flaw->remedy);
      return std::nullopt;
    }
    return local;
  }

  proto::Scenario& scenario_;
  proto::Target& target_;
  Checks& checks_;
  Findings& findings_;
  std::optional<LocalPlane> plane_;  // nothing while the origin is invalid
  std::string file_;                 // that is being read
};

}  // namespace

std::vector<std::filesystem::path> read_geojson_files(proto::Scenario& scenario, Checks& checks,
                                                      Findings& findings) {
  std::vector<std::filesystem::path> files;
  const auto add = [&files](const proto::Polygon& polygon) {
    if (polygon.has_file()) files.emplace_back(polygon.file());
  };
  for (const proto::Region& region : scenario.target().regions()) add(region.polygon());
  for (const proto::Polygon& keep_out : scenario.target().keep_outs()) add(keep_out);
  GeoJsonReader(scenario, checks, findings).run();
  return files;
}

}  // namespace ergocast
