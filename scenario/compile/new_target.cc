// SPDX-License-Identifier: BSD-3-Clause
// Compares what a scenario says of the place with the running mission, then takes its target alone.
#include "scenario/compile/new_target.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "core/base/rings.h"
#include "scenario/compile/polygon_files.h"
#include "scenario/parse/convert.h"
#include "target/maps/map_file.h"

namespace ergocast {
namespace {

std::string extension_of(const std::string& file) {
  std::string end = std::filesystem::path(file).extension().string();
  std::ranges::transform(end, end.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c;
  });
  return end;
}

std::string text_of(const Box& domain) {
  const auto sides = [&domain](const Eigen::Vector3d& m) {
    return shortest(m.x()) + ", " + shortest(m.y()) +
           (domain.planar() ? "" : ", " + shortest(m.z()));
  };
  return sides(domain.size_m) + " m from (" + sides(domain.origin_m) + ")";
}

/// Whether each ring of the polygon is one of the walls, corner by corner.
bool is_among(const proto::Polygon& polygon, const Rings& walls) {
  return std::ranges::all_of(rings_of(polygon_of(polygon)), [&walls](const Ring& ring) {
    return std::ranges::find(walls, ring) != walls.end();
  });
}

void add_map(const std::string& name, MapKind kind, const proto::Domain& domain,
             proto::Target& target) {
  proto::Map& map = *target.add_maps();
  map.set_file(name);
  map.set_weight(1);
  if (states_extent(kind)) return;
  map.set_origin_x_m(domain.origin_x_m());
  map.set_origin_y_m(domain.origin_y_m());
  map.set_size_x_m(domain.size_x_m());
  map.set_size_y_m(domain.size_y_m());
}

}  // namespace

bool read_target_file(const std::string& file, const proto::Domain& domain,
                      proto::Scenario& scenario, Findings& findings) {
  const std::string end = extension_of(file);
  const std::string name = std::filesystem::path(file).filename().string();
  proto::Target& target = *scenario.mutable_target();
  if (const auto kind = map_kind(file)) {
    add_map(name, *kind, domain, target);
  } else if (is_polygon_file(file)) {
    proto::Region& region = *target.add_regions();
    region.set_weight(1);
    region.mutable_polygon()->set_file(name);
  } else if (end == ".nc") {
    findings.add_to_file("a NetCDF file may have several variables",
                         "name one in a scenario's text: target { voxels { file: \"" + name +
                             "\" variable: \"…\" weight: 1 } }");
  } else {
    scenario.clear_target();
    return false;
  }
  return true;
}

void refuse_other_fields(const Overrides& overrides, Findings& findings) {
  for (const FieldValue& field : overrides.fields) {
    if (field.path.starts_with("target.")) continue;
    findings.add_to_flag(field.flag, "only the target of a running mission can change",
                         "name a field of the target, such as target.uniform_weight");
  }
}

void place_in(const proto::Scenario& running, proto::Scenario& scenario, Checks& checks) {
  const Box ours = domain_of(running.domain());
  if (scenario.has_domain()) {
    const Box written = domain_of(scenario.domain());
    if (written.origin_m != ours.origin_m || written.size_m != ours.size_m)
      checks.problem(
          "domain",
          "has " + text_of(written) + "; that of the running mission has " + text_of(ours),
          "write the target in the running mission's place, and leave out the domain");
  }
  *scenario.mutable_domain() = running.domain();
  if (!running.has_origin()) return;
  if (!scenario.has_origin()) {
    *scenario.mutable_origin() = running.origin();
  } else if (scenario.origin().latitude_deg() != running.origin().latitude_deg() ||
             scenario.origin().longitude_deg() != running.origin().longitude_deg()) {
    checks.problem("origin", "is not that of the running mission", "leave it out");
  }
}

void complete_from(const proto::Scenario& running, proto::Scenario& scenario, Checks& checks) {
  const Rings walls = mission_of(running).walls;
  const std::string remedy = "leave it out, or write it as the running mission's scenario has it";
  for (int i = 0; i < scenario.world().walls_size(); ++i) {
    if (!is_among(scenario.world().walls(i), walls))
      checks.problem(indexed("world.walls", i), "is no wall of the running mission", remedy);
  }
  for (int i = 0; i < scenario.target().keep_outs_size(); ++i) {
    proto::Polygon& keep_out = *scenario.mutable_target()->mutable_keep_outs(i);
    if (keep_out.solid() && !is_among(keep_out, walls))
      checks.problem(indexed("target.keep_outs", i) + ".solid",
                     "makes a wall, and it is none of the running mission", remedy);
    keep_out.clear_solid();
  }
  proto::Scenario completed = running;
  if (scenario.has_target()) completed.mutable_target()->Swap(scenario.mutable_target());
  if (scenario.has_origin()) *completed.mutable_origin() = scenario.origin();
  scenario.Swap(&completed);
}

}  // namespace ergocast
