// SPDX-License-Identifier: BSD-3-Clause
// Checks walls and solid keep-outs against each other, the starts and the vehicles.
#include "scenario/rules/validate_walls.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

#include "core/base/indexed_rings.h"
#include "core/motion/walls.h"
#include "scenario/parse/convert.h"
#include "scenario/rules/polygon_flaw.h"
#include "scenario/rules/validate_target.h"

namespace ergocast {
namespace {

class WallRules {
 public:
  WallRules(const proto::Scenario& scenario, Checks& checks)
      : scenario_(scenario), checks_(checks), domain_(domain_of(scenario.domain())) {
    for (int i = 0; i < scenario.world().walls_size(); ++i)
      walls_.push_back({indexed("world.walls", i), &scenario.world().walls(i)});
    for (int i = 0; i < scenario.target().keep_outs_size(); ++i) {
      if (scenario.target().keep_outs(i).solid())
        walls_.push_back({indexed("target.keep_outs", i), &scenario.target().keep_outs(i)});
    }
  }

  void run() {
    needless();
    if (walls_.empty()) return;
    if (!domain_.planar()) return in_a_box();
    for (const Wall& wall : walls_) shape(wall);
    if (!all_sound() || too_many()) return;
    if (apart() && all_sound()) bodies();
  }

 private:
  struct Wall {
    std::string path;
    const proto::Polygon* polygon;
  };

  bool all_sound() const {
    return std::ranges::all_of(walls_, [&](const Wall& wall) { return checks_.sound(wall.path); });
  }

  /// Reports settings that are redundant, impossible or without effect.
  void needless() {
    for (int i = 0; i < scenario_.world().walls_size(); ++i) {
      if (scenario_.world().walls(i).has_solid())
        checks_.problem(indexed("world.walls", i) + ".solid", "is for keep-outs: walls are solid",
                        "remove it");
    }
    for (int i = 0; i < scenario_.target().regions_size(); ++i) {
      if (scenario_.target().regions(i).polygon().solid())
        checks_.problem(indexed("target.regions", i) + ".polygon.solid",
                        "is for keep-outs: no agent could cover the region", "remove it");
    }
    if (scenario_.world().has_wall_clearance_m() && walls_.empty() &&
        checks_.sound("world.walls") && checks_.sound("target.keep_outs"))
      checks_.problem("world.wall_clearance_m", "has no effect without walls",
                      "remove it, or add walls");
  }

  void in_a_box() {
    if (!checks_.sound("domain")) return;
    checks_.problem(walls_.front().path, "walls belong to a plane, and the domain is a box",
                    "remove domain.size_z_m, or write target.keep_outs, which agents may cross");
  }

  void shape(const Wall& wall) {
    if (wall.polygon->has_file() || !checks_.sound(wall.path) || !checks_.sound("domain")) return;
    const Polygon polygon = polygon_of(*wall.polygon);
    if (const auto flaw = flaw_of(polygon, least_area_m2(domain_.size_m.maxCoeff()))) {
      const std::string place =
          flaw->hole < 0 ? wall.path : indexed(wall.path + ".holes", flaw->hole);
      return checks_.problem(place, flaw->what, flaw->remedy);
    }
    if (std::ranges::all_of(polygon.outline, [&](const Eigen::Vector2d& corner_m) {
          return near_enough(corner_m, domain_);
        }))
      return;
    checks_.problem(wall.path,
                    "has a vertex that is farther from the domain than 10 times its longer side",
                    "cut it off nearer to the domain");
  }

  bool too_many() {
    std::size_t count = 0;
    for (const Wall& wall : walls_) count += vertex_count(rings_of(wall));
    if (count <= static_cast<std::size_t>(kMaxWallVertices)) return false;
    checks_.problem("world",
                    std::to_string(count) + " vertices of walls are above the limit " +
                        std::to_string(kMaxWallVertices),
                    "draw them with fewer");
    return true;
  }

  static Rings rings_of(const Wall& wall) { return ergocast::rings_of(polygon_of(*wall.polygon)); }

  /// Checks that no two walls touch, and that a wall lies in another one only in a room. False if
  /// that takes too long.
  bool apart() {
    Rings all;
    std::vector<std::size_t> owner, first;  // the wall of each ring, and each wall's first ring
    for (std::size_t i = 0; i < walls_.size(); ++i) {
      first.push_back(all.size());
      for (Ring& ring : rings_of(walls_[i])) {
        all.push_back(std::move(ring));
        owner.push_back(i);
      }
    }
    const IndexedRings rings(std::move(all));
    if (rings.is_crowded()) {
      checks_.problem("world", "thousands of long edges of walls lie side by side",
                      "draw the walls with fewer or shorter edges");
      return false;
    }
    std::vector<std::size_t> met(walls_.size());  // the first wall that each meets, or itself
    std::iota(met.begin(), met.end(), std::size_t{0});
    const auto meet = [&](std::size_t one, std::size_t other) {
      met[std::max(one, other)] = std::min(met[std::max(one, other)], std::min(one, other));
    };
    for (const Edge& edge : rings.edges()) {
      rings.find_near(edge.segment, 0, [&](const Edge& other) {
        const std::size_t wall = owner[edge.ring], its = owner[other.ring];
        if (its < wall && touch(edge.segment, other.segment)) meet(wall, its);
        return false;
      });
    }
    for (std::size_t i = 0; i < walls_.size(); ++i) {
      for (const std::size_t around : solid_around(rings, owner, first[i])) meet(i, around);
    }
    for (std::size_t i = 0; i < walls_.size(); ++i) {
      if (met[i] == i) continue;
      checks_.problem(walls_[i].path, "crosses, touches or overlaps " + walls_[met[i]].path,
                      "join the two to one polygon, or move one of them");
    }
    return true;
  }

  /// The other walls that are solid where a ring begins.
  static std::vector<std::size_t> solid_around(const IndexedRings& rings,
                                               const std::vector<std::size_t>& owner,
                                               std::size_t ring) {
    std::vector<std::size_t> crossed;
    rings.for_crossed(rings[ring].front(), [&](const Edge& edge) {
      if (owner[edge.ring] != owner[ring]) crossed.push_back(owner[edge.ring]);
    });
    return listed_oddly(std::move(crossed));
  }

  void bodies() {
    const std::array parts = {"domain", "basis", "law",     "time",
                              "agents", "world", "vehicle", "separation"};
    if (!std::ranges::all_of(parts, [&](const char* part) { return checks_.sound(part); })) return;
    const Mission mission = mission_of(scenario_);
    if (!limited(mission)) return;
    if (mission.disturbance_intensity > 0 && any_but_points(mission)) {
      checks_.problem("world.disturbance_intensity",
                      "pushes vehicles that are no POINT, and nothing keeps those from the walls",
                      "write 0, or vehicle.kind: POINT, or remove the walls");
    }
    clearance(mission);
    starts(mission);
  }

  bool limited(const Mission& mission) {
    bool all = true;
    for (int kind = 0; kind < std::max(1, scenario_.agents().kind_size()); ++kind)
      all = all && motion_of_kind(mission, kind).speed_limit_mps > 0;
    if (!all)
      checks_.missing("world.speed_limit_mps", "is missing, and walls rely on it",
                      "add the hard limit of the vehicles, or remove the walls");
    return all;
  }

  void clearance(const Mission& mission) {
    const double least_m = least_wall_clearance_m(mission);
    if (mission.wall_clearance_m >= least_m) return;
    checks_.problem(
        "world.wall_clearance_m",
        shortest(mission.wall_clearance_m) +
            " is too little for vehicles with position errors or late commands: they need " +
            shortest(rounded_up(least_m)) + " m",
        "write at least that, or smaller errors, or guard: true");
  }

  void starts(const Mission& mission) {
    for (int i = 0; i < scenario_.agents().starts_size(); ++i) {
      const Eigen::Vector3d& start_m = mission.starts_m[static_cast<std::size_t>(i)];
      const double spare_m = spare_at_start_m(mission, i, start_m);
      if (spare_m >= 0) continue;
      const double kept_m = kept_from_walls_m(mission, motion_of(mission, i));
      const bool solid = solid_at(mission.walls, start_m.head<2>());
      checks_.problem(indexed("agents.starts", i),
                      solid ? std::string("is in a wall")
                            : "is " + shortest(rounded_down(std::max(0.0, spare_m + kept_m))) +
                                  " m from a wall, nearer than the " +
                                  shortest(rounded_up(kept_m)) + " m that it keeps",
                      "move it away");
    }
  }

  const proto::Scenario& scenario_;
  Checks& checks_;
  Box domain_;
  std::vector<Wall> walls_;
};

}  // namespace

void validate_walls(const proto::Scenario& scenario, Checks& checks) {
  WallRules(scenario, checks).run();
}

}  // namespace ergocast
