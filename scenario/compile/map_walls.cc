// SPDX-License-Identifier: BSD-3-Clause
// Reads the cells near the domain, cleans them, draws polygons around what is solid, and closes
// what bodies cannot reach.
#include "scenario/compile/map_walls.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "core/base/portable_math.h"
#include "core/motion/free_region.h"
#include "core/motion/walls.h"
#include "scenario/parse/findings.h"
#include "target/contour/contour.h"
#include "target/contour/specks.h"

namespace ergocast {
namespace {

namespace fs = std::filesystem;

/// How far outside the domain walls count, as a share of its longer side.
constexpr double kMargin = 0.1;
constexpr std::size_t kLeastSpeck = 5;
constexpr std::size_t kFreePerPocket = 1000;
/// By how much a domain may stick out of a map that covers it [cells]: by rounding alone.
constexpr double kSameEdge = 0.01;
/// How often parts are closed: closing one straightens walls anew, which may cut off a part.
constexpr int kMostRounds = 3;
/// Clearances with room for rounding: as a factor, and at least this share of the longer side.
constexpr double kRoundedUp = 1.001, kLeastKept = 1e-6;
constexpr int kUnreached = -1;
/// Bodies come so near to each place of a room [times their clearance and a cell], by steps along
/// the axes; niches lie deeper.
constexpr double kNiche = 2;

/// A rectangle of cells, or of places in units of cells from the map's lower left corner.
template <class Number>
struct Extent {
  Number low_x, low_y, high_x, high_y;
};

class MapWallReader {
 public:
  MapWallReader(const fs::path& yaml, const Box& domain, bool unknown_free, const MapBodies& bodies,
                OccupancyMap map)
      : file_(yaml.string()),
        domain_(domain),
        unknown_free_(unknown_free),
        bodies_(bodies),
        map_(std::move(map)) {
    const double turn = map_.about().yaw_rad;
    along_m_ =
        map_.about().resolution_m * Eigen::Vector2d(portable::cos(turn), portable::sin(turn));
  }

  Result<MapWalls, MapProblem> run() {
    find_window();
    if (window_.low_x >= window_.high_x || window_.low_y >= window_.high_y)
      return refuse("lies apart from the domain: " + place_text(),
                    "correct its origin, or move the domain there");
    CellGrid cells(window_.high_x - window_.low_x, window_.high_y - window_.low_y, kUnknownCell);
    if (auto problem = read(cells)) return failure(*problem);
    if (unknown_free_) {
      for (std::size_t i = 0; i < cells.size(); ++i)
        if (cells[i] == kUnknownCell) cells[i] = kFreeCell;
    }
    const std::size_t free = count_free(cells);
    if (free == 0)
      return refuse("has no free cell in the domain",
                    "move the domain, or correct negate and the thresholds" +
                        std::string(unknown_free_ ? "" : ", or write unknown_free: true"));
    if (!unknown_free_) free_unknown_specks(cells, kLeastSpeck);
    if (count_free(cells) == cells.size())
      return refuse("has no wall in or near the domain", "remove it, or move the domain");
    MapRooms rooms{file_, free_m2(cells), bodies_.clearance_m, {}, 0, {}};
    close_pockets(cells, (free + kFreePerPocket - 1) / kFreePerPocket);
    auto walls = walls_of(cells);
    for (int round = 0; walls && round < kMostRounds; ++round) {
      if (!close_unreached(*walls, round > 0, cells, rooms)) break;
      walls = walls_of(cells);
    }
    if (!walls) return walls;
    rooms.closed = closed_in(cells);
    walls->rooms = std::move(rooms);
    note_starts(cells, *walls);
    return walls;
  }

 private:
  tl::unexpected<MapProblem> refuse(const std::string& what, std::string remedy) const {
    return failure(MapProblem{file_ + ' ' + what, std::move(remedy)});
  }

  std::string place_text() const {
    const auto& origin_m = map_.about().origin_m;
    return "its " + std::to_string(map_.columns()) + " by " + std::to_string(map_.rows()) +
           " cells of " + shortest(map_.about().resolution_m) + " m begin at x " +
           shortest(origin_m.x()) + ", y " + shortest(origin_m.y()) + " m";
  }

  /// In units of cells.
  Eigen::Vector2d in_map(const Eigen::Vector2d& x_m) const {
    const Eigen::Vector2d from_m = x_m - map_.about().origin_m;
    const double square = along_m_.squaredNorm();
    return {from_m.dot(along_m_) / square,
            (along_m_.x() * from_m.y() - along_m_.y() * from_m.x()) / square};
  }
  Eigen::Vector2d in_domain_m(const Eigen::Vector2d& cells) const {
    return map_.about().origin_m + cells.x() * along_m_ +
           cells.y() * Eigen::Vector2d(-along_m_.y(), along_m_.x());
  }

  /// The cells that matter: those in and near the domain, and one around the map if the domain
  /// sticks out of it.
  void find_window() {
    Eigen::Vector2d low = in_map(domain_.origin_m.head<2>()), high = low;
    for (const double x : {0.0, 1.0}) {
      for (const double y : {0.0, 1.0}) {
        const Eigen::Vector2d corner =
            in_map(domain_.origin_m.head<2>() +
                   Eigen::Vector2d(x, y).cwiseProduct(domain_.size_m.head<2>()));
        low = low.cwiseMin(corner);
        high = high.cwiseMax(corner);
      }
    }
    const Eigen::Array2d end(map_.columns(), map_.rows());
    const bool covered =
        (low.array() >= -kSameEdge).all() && (high.array() <= end + kSameEdge).all();
    const int around = covered || unknown_free_ ? 0 : 1;
    const double margin = kMargin * domain_.size_m.maxCoeff() / map_.about().resolution_m;
    near_ = {low.x() - margin, low.y() - margin, high.x() + margin, high.y() + margin};
    const bool apart = (high.array() <= 0).any() || (low.array() >= end).any();
    const auto clipped = [&](double at, int most) {
      return static_cast<int>(std::clamp<double>(at, -around, most + around));
    };
    window_ = {clipped(std::floor(near_.low_x), map_.columns()),
               clipped(std::floor(near_.low_y), map_.rows()),
               apart ? -around : clipped(std::ceil(near_.high_x), map_.columns()),
               clipped(std::ceil(near_.high_y), map_.rows())};
  }

  std::optional<MapProblem> read(CellGrid& cells) {
    std::vector<std::uint8_t> row(static_cast<std::size_t>(map_.columns()));
    for (int y = map_.rows() - 1; y >= 0; --y) {
      if (auto problem = map_.next_row(row)) return problem;
      if (y < window_.low_y || y >= window_.high_y) continue;
      const int from = std::max(0, window_.low_x), to = std::min(map_.columns(), window_.high_x);
      for (int x = from; x < to; ++x)
        cells.at(x - window_.low_x, y - window_.low_y) = row[static_cast<std::size_t>(x)];
    }
    return {};
  }

  Result<MapWalls, MapProblem> walls_of(const CellGrid& cells) const {
    auto walls = polygons_around(cells, Straightening::kOutwards);
    if (walls && corners_of(*walls) > static_cast<std::size_t>(kMaxWallVertices))
      walls = polygons_around(cells, Straightening::kBothWays);
    if (!walls)
      return refuse("has more than " + std::to_string(kMaxCellSides) +
                        " sides of cells between free and solid",
                    "smooth the picture: that is noise, and no building");
    if (const std::size_t count = corners_of(*walls);
        count > static_cast<std::size_t>(kMaxWallVertices))
      return refuse("has walls with " + std::to_string(count) + " corners, above the limit " +
                        std::to_string(kMaxWallVertices),
                    "choose a smaller domain, or paint over specks and furniture in the picture");
    MapWalls placed{{}, map_.about().image, {}, {}};
    for (Polygon& polygon : *walls) {
      place(polygon.outline);
      for (Ring& hole : polygon.holes) place(hole);
      const Eigen::Vector2d& at_m = polygon.outline.front();
      placed.polygons.push_back(
          {"the wall at x " + shortest(at_m.x()) + ", y " + shortest(at_m.y()) + " m",
           std::move(polygon)});
    }
    return placed;
  }

  /// The area of the free cells whose middle is in the domain.
  double free_m2(const CellGrid& cells) const {
    std::size_t count = 0;
    for (int row = 0; row < cells.rows(); ++row) {
      for (int column = 0; column < cells.columns(); ++column) {
        if (cells.at(column, row) != kFreeCell) continue;
        const Eigen::Vector2d middle(column + 0.5 + window_.low_x, row + 0.5 + window_.low_y);
        count += domain_.contains(on_ground(in_domain_m(middle))) ? 1 : 0;
      }
    }
    return static_cast<double>(count) * along_m_.squaredNorm();
  }

  /// Polygons around the closed cells, for people.
  std::vector<Polygon> closed_in(const CellGrid& cells) const {
    CellGrid closed(cells.columns(), cells.rows());
    for (std::size_t i = 0; i < cells.size(); ++i) closed[i] = cells[i] == kClosedCell ? 1 : 0;
    auto polygons = polygons_around(closed, Straightening::kBothWays);
    if (!polygons) return {};
    for (Polygon& polygon : *polygons) {
      place(polygon.outline);
      for (Ring& hole : polygon.holes) place(hole);
    }
    return *std::move(polygons);
  }

  void note_starts(const CellGrid& cells, MapWalls& walls) const {
    const IndexedRings rings(rings_of(walls));
    for (const Eigen::Vector2d& start_m : bodies_.starts_m) {
      const bool solid = domain_.contains(on_ground(start_m)) && rings.solid_at(start_m);
      walls.starts.push_back(solid ? solid_place(cells, start_m) : SolidPlace::kNone);
    }
  }

  SolidPlace solid_place(const CellGrid& cells, const Eigen::Vector2d& x_m) const {
    const Eigen::Array2d at = in_map(x_m).array() - Eigen::Array2d(window_.low_x, window_.low_y);
    if ((at < 0).any() || at.x() >= cells.columns() || at.y() >= cells.rows())
      return SolidPlace::kUnknown;
    switch (cells.at(static_cast<int>(at.x()), static_cast<int>(at.y()))) {
      case kUnknownCell:
        return SolidPlace::kUnknown;
      case kClosedCell:
        return SolidPlace::kClosed;
      default:
        return SolidPlace::kWall;
    }
  }

  /// Closes free cells that belong to another part of the domain than that of the first start, and
  /// niches that no body reaches into. Returns whether there were any.
  /// @param again  whether niches have been closed
  /// @param rooms  takes in the parts, the first time
  bool close_unreached(const MapWalls& walls, bool again, CellGrid& cells, MapRooms& rooms) const {
    const double kept_m = std::max(kRoundedUp * bodies_.clearance_m,
                                   kLeastKept * domain_.size_m.head<2>().maxCoeff());
    const FreeRegion region(rings_of(walls), domain_, kept_m);
    if (region.parts() == 0 || (again && region.parts() == 1)) return false;
    const int used =
        bodies_.starts_m.empty() ? 0 : region.part_at(bodies_.starts_m.front()).value_or(0);
    if (!again) note_rooms(region, used, rooms);
    const std::vector<int> part = parts_of(cells, region, kept_m);
    bool any = false;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if (cells[i] != kFreeCell || part[i] == used) continue;
      cells[i] = kClosedCell;
      any = true;
    }
    return any;
  }

  void note_rooms(const FreeRegion& region, int used, MapRooms& rooms) const {
    rooms.used = used;
    const double all_m2 = region.free_share() * domain_.content();
    for (int part = 0; part < region.parts(); ++part)
      rooms.rooms.push_back({region.middle_m(part), region.share_of(part) * all_m2});
  }

  /// The part of the region that is nearest to each free cell, by steps over free cells; none for
  /// cells that no body comes near.
  std::vector<int> parts_of(const CellGrid& cells, const FreeRegion& region, double kept_m) const {
    const double reach_m = kNiche * (kept_m + region.cell_size_m());
    const double most_steps = 1 + reach_m / map_.about().resolution_m;
    std::vector<int> part(cells.size(), kUnreached);
    std::vector<std::pair<int, int>> reached;
    const auto reach = [&](int column, int row, int which) {
      if (!cells.has(column, row) || cells.at(column, row) != kFreeCell) return;
      int& its = part[cells.index(column, row)];
      if (its != kUnreached) return;
      its = which;
      reached.emplace_back(column, row);
    };
    for (int cell = 0; cell < region.cells(); ++cell) {
      const Eigen::Vector2d middle_m = region.center_m(cell), at = in_map(middle_m);
      if (const auto which = region.part_at(middle_m))
        reach(static_cast<int>(std::floor(at.x())) - window_.low_x,
              static_cast<int>(std::floor(at.y())) - window_.low_y, *which);
    }
    std::size_t end_of_step = reached.size();
    int steps = 0;
    for (std::size_t i = 0; i < reached.size(); ++i) {
      if (i == end_of_step) {
        if (++steps > most_steps) break;
        end_of_step = reached.size();
      }
      const auto [column, row] = reached[i];
      const int which = part[cells.index(column, row)];
      for (const auto& [dx, dy] : {std::pair(1, 0), {-1, 0}, {0, 1}, {0, -1}})
        reach(column + dx, row + dy, which);
    }
    return part;
  }

  static std::size_t corners_of(const std::vector<Polygon>& polygons) {
    std::size_t count = 0;
    for (const Polygon& polygon : polygons) count += vertex_count(rings_of(polygon));
    return count;
  }

  /// From units of cells in the window to metres. The cells around the map become so wide that they
  /// reach to the edge of what is near.
  void place(Ring& ring) const {
    const auto stretched = [](double at, double low, double high, int count) {
      if (at < -0.5) return at - std::max(0.0, -1 - low);
      if (at > count + 0.5) return at + std::max(0.0, high - count - 1);
      return at;
    };
    for (Eigen::Vector2d& corner : ring) {
      const Eigen::Vector2d at = corner + Eigen::Vector2d(window_.low_x, window_.low_y);
      corner = in_domain_m({stretched(at.x(), near_.low_x, near_.high_x, map_.columns()),
                            stretched(at.y(), near_.low_y, near_.high_y, map_.rows())});
    }
  }

  const std::string file_;
  const Box domain_;
  const bool unknown_free_;
  const MapBodies bodies_;
  OccupancyMap map_;
  Eigen::Vector2d along_m_;  // a cell along the map's rows
  Extent<double> near_{};
  Extent<int> window_{};
};

}  // namespace

Result<MapWalls, MapProblem> read_map_walls(const fs::path& yaml, const Box& domain,
                                            bool unknown_free, const MapBodies& bodies) {
  auto map = OccupancyMap::open(yaml);
  if (!map) return failure(map.error());
  return MapWallReader(yaml, domain, unknown_free, bodies, *std::move(map)).run();
}

Rings rings_of(const MapWalls& walls) {
  Rings rings;
  for (const PlacedPolygon& wall : walls.polygons)
    for (Ring& ring : rings_of(wall.polygon)) rings.push_back(std::move(ring));
  return rings;
}

}  // namespace ergocast
