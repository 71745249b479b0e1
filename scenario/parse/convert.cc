// SPDX-License-Identifier: BSD-3-Clause
// Copies each Protobuf block into the plain type of the same meaning. Blocks of a mission are
// copied by the list of its fields.
#include "scenario/parse/convert.h"

#include <algorithm>
#include <cmath>

#include "core/base/require.h"
#include "plan/mission_fields.h"
#include "scenario/parse/fields.h"

namespace ergocast {
namespace {

using google::protobuf::Message;

/// In a plane nothing reads its part along z.
Eigen::Matrix3d covariance_of(const proto::Gaussian& gaussian) {
  if (gaussian.has_sigma_m()) {
    const double sigma_z_m = gaussian.has_sigma_z_m() ? gaussian.sigma_z_m() : 1;
    const Eigen::Vector3d sigma_m(gaussian.sigma_m(), gaussian.sigma_m(), sigma_z_m);
    return sigma_m.cwiseProduct(sigma_m).asDiagonal();
  }
  const proto::Covariance& c = gaussian.covariance();
  const double zz_m2 = c.has_zz_m2() ? c.zz_m2() : 1;
  Eigen::Matrix3d matrix;
  matrix << c.xx_m2(), c.xy_m2(), c.xz_m2(), c.xy_m2(), c.yy_m2(), c.yz_m2(), c.xz_m2(), c.yz_m2(),
      zz_m2;
  return matrix;
}

Heights heights_of(const proto::Polygon& polygon) {
  return {polygon.low_z_m(), polygon.high_z_m()};
}

template <class Vertices>
Ring ring_of(const Vertices& vertices) {
  Ring ring;
  for (const proto::Vertex& vertex : vertices) ring.emplace_back(vertex.x_m(), vertex.y_m());
  return ring;
}

void add_rings(const proto::Polygon& polygon, Rings& rings) {
  rings.push_back(ring_of(polygon.vertices()));
  for (const proto::Ring& hole : polygon.holes()) rings.push_back(ring_of(hole.vertices()));
}

/// Fills a part of a mission from the fields of the same names in `block`.
class BlockReader : public FieldVisitor {
 public:
  explicit BlockReader(const Message& block) : block_(block) {}

  template <class Number>
  void number(const Field& field, Number& value) {
    const auto [block, found] = find_field(block_, field.name);
    const bool is_set = block.GetReflection()->HasField(block, &found);
    value = static_cast<Number>(is_set ? number_in(block, found) : field.when.otherwise);
  }
  void flag(const Field& field, bool& value) {
    const auto [block, found] = find_field(block_, field.name);
    value = block.GetReflection()->GetBool(block, &found);
  }
  template <class Enum>
  void choice(const Field& field, Enum& value, Words words) {
    const auto [block, found] = find_field(block_, field.name);
    const auto* word =
        std::ranges::find(words, block.GetReflection()->GetEnum(block, &found)->name());
    ERGOCAST_REQUIRE(word != words.end());
    value = static_cast<Enum>(word - words.begin());
  }
  void text(const Field& field, std::string& value) {
    const auto [block, found] = find_field(block_, field.name);
    value = block.GetReflection()->GetString(block, &found);
  }
  void places(const Field& xy, const Field&, std::vector<Eigen::Vector3d>& places_m) {
    for_each(xy, [&places_m](const Message& message) {
      const auto& place = static_cast<const proto::Start&>(message);
      places_m.emplace_back(place.x_m(), place.y_m(), place.z_m());
    });
  }
  using FieldVisitor::places;
  void part(const Field& field, auto& part) {
    const auto [block, found] = find_field(block_, field.name);
    BlockReader inner(block.GetReflection()->GetMessage(block, &found));
    list_fields(inner, part);
  }
  void part(const Field& field, std::optional<VehicleLimits>& vehicle) {
    const auto [block, found] = find_field(block_, field.name);
    if (block.GetReflection()->HasField(block, &found)) part(field, vehicle.emplace());
  }
  void part(const Field& field, std::vector<AgentKind>& kinds) {
    for_each(field, [&kinds](const Message& message) {
      BlockReader inner(message);
      list_fields(inner, kinds.emplace_back());
    });
  }

 private:
  /// Calls `read` with each message of a repeated field.
  void for_each(const Field& field, const auto& read) const {
    const auto [block, found] = find_field(block_, field.name);
    const auto* fields = block.GetReflection();
    for (int i = 0; i < fields->FieldSize(block, &found); ++i)
      read(fields->GetRepeatedMessage(block, &found, i));
  }

  const Message& block_;
};

template <class Part>
Part part_of(const Message& block) {
  Part part;
  BlockReader reader(block);
  list_fields(reader, part);
  return part;
}

}  // namespace

Box domain_of(const proto::Domain& domain) { return part_of<Box>(domain); }
Basis basis_of(const proto::Basis& basis) { return part_of<Basis>(basis); }

Eigen::Vector3d contraction_center_of(const proto::Law& law, const Box& domain) {
  switch (law.contraction_center()) {
    case proto::Law::COORDINATE_ORIGIN:
      return {0, 0, 0};
    case proto::Law::POINT:
      return {law.contraction_x_m(), law.contraction_y_m(), law.contraction_z_m()};
    default:
      return domain.center_m();
  }
}

Polygon polygon_of(const proto::Polygon& polygon) {
  Polygon plain{ring_of(polygon.vertices()), {}};
  for (const proto::Ring& hole : polygon.holes()) plain.holes.push_back(ring_of(hole.vertices()));
  return plain;
}

Rectangle extent_of(const proto::Map& map) {
  return {{map.origin_x_m(), map.origin_y_m()}, {map.size_x_m(), map.size_y_m()}};
}

TargetDensity target_of(const proto::Scenario& scenario) {
  const proto::Target& target = scenario.target();
  TargetDensity density;
  density.uniform_weight = target.uniform_weight();
  for (const proto::Gaussian& gaussian : target.gaussians()) {
    density.gaussians.push_back({gaussian.weight(),
                                 {gaussian.mean_x_m(), gaussian.mean_y_m(), gaussian.mean_z_m()},
                                 covariance_of(gaussian)});
  }
  for (const proto::Region& region : target.regions()) {
    density.regions.push_back(
        {region.weight(), polygon_of(region.polygon()), heights_of(region.polygon())});
  }
  for (const proto::Polygon& keep_out : target.keep_outs()) {
    density.keep_outs.push_back({polygon_of(keep_out), heights_of(keep_out)});
  }
  for (const proto::Polygon& wall : scenario.world().walls())
    density.keep_outs.push_back({polygon_of(wall), heights_of(wall)});
  return density;
}

int most_agents(const proto::Scenario& scenario) {
  return scenario.team().sites() > 0 ? kMostAgentsOfSites : kMaxAgents;
}

bool has_walls(const proto::Scenario& scenario) {
  return scenario.world().walls_size() > 0 ||
         std::ranges::any_of(scenario.target().keep_outs(), &proto::Polygon::solid);
}

void make_walls(proto::Scenario& scenario) {
  auto& keep_outs = *scenario.mutable_target()->mutable_keep_outs();
  for (const proto::Polygon& keep_out : keep_outs) {
    if (!keep_out.solid()) continue;
    proto::Polygon& wall = *scenario.mutable_world()->add_walls();
    wall = keep_out;
    wall.clear_solid();
  }
  keep_outs.erase(std::remove_if(keep_outs.begin(), keep_outs.end(),
                                 [](const auto& keep_out) { return keep_out.solid(); }),
                  keep_outs.end());
}

Mission mission_of(const proto::Scenario& scenario) {
  auto mission = part_of<Mission>(scenario);
  mission.seed = scenario.seed();
  mission.law.contraction_center_m = contraction_center_of(scenario.law(), mission.domain);
  mission.timing.tick_count = std::llround(scenario.time().duration_s() / mission.timing.dt_s);
  Rings walls;
  for (const proto::Polygon& wall : scenario.world().walls()) add_rings(wall, walls);
  for (const proto::Polygon& keep_out : scenario.target().keep_outs()) {
    if (keep_out.solid()) add_rings(keep_out, walls);
  }
  mission.walls = std::move(walls);
  return mission;
}

}  // namespace ergocast
