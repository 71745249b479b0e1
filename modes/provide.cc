// SPDX-License-Identifier: BSD-3-Clause
// Keeps tables by what they were computed from, and computes those that were not handed over.
#include "modes/provide.h"

#include <xxhash.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <optional>
#include <vector>

#include "core/base/rings.h"
#include "core/motion/walls.h"
#include "modes/eigen_modes.h"
#include "modes/free_grid.h"

namespace ergocast {
namespace {

/// The tables of this process. Missions may be prepared in several threads.
struct Shelf {
  std::mutex access;
  std::vector<ModesTable> tables;    // handed over or computed
  std::vector<ModesTable> computed;  // by this process
};

Shelf& shelf() {
  static Shelf the_one;
  return the_one;
}

/// One of the shelf's `tables` that fits; null if none does.
template <class Fits>
ModesTable known_table(const Fits& fits, std::vector<ModesTable> Shelf::*tables = &Shelf::tables) {
  Shelf& all = shelf();
  const std::lock_guard lock(all.access);
  const auto at = std::ranges::find_if(all.*tables, fits);
  return at == (all.*tables).end() ? nullptr : *at;
}

/// What the smallest bodies keep from walls, rounded down, since it depends on the domain's origin
/// in its last digits. 0: nothing.
double kept_m(const Mission& mission) {
  double least_m = kept_from_walls_m(mission, motion_of_kind(mission, 0));
  for (int kind = 1; kind < std::ssize(mission.kinds); ++kind)
    least_m = std::min(least_m, kept_from_walls_m(mission, motion_of_kind(mission, kind)));
  const double unit_m = std::ldexp(1.0, -30) * mission.domain.size_m.maxCoeff();
  return unit_m * std::floor(least_m / unit_m);
}

/// The hash of what a table is computed from.
std::uint64_t key_of(const Mission& mission) {
  std::vector<double> numbers = {mission.domain.origin_m.x(), mission.domain.origin_m.y(),
                                 mission.domain.size_m.x(), mission.domain.size_m.y(),
                                 static_cast<double>(mission.basis.mode_count())};
  if (const double m = kept_m(mission); m > 0) numbers.push_back(m);
  for (const Ring& wall : mission.walls) {
    numbers.push_back(static_cast<double>(wall.size()));
    for (const Eigen::Vector2d& corner_m : wall)
      numbers.insert(numbers.end(), {corner_m.x(), corner_m.y()});
  }
  return XXH3_64bits(numbers.data(), numbers.size() * sizeof(double));
}

bool sees(const IndexedRings& walls, const Eigen::Vector2d& from_m, const Eigen::Vector2d& to_m) {
  if (from_m == to_m) return !solid_at(walls, from_m);
  const Segment way{from_m, to_m};
  return !walls.find_near(way, 0, [&](const Edge& edge) { return touch(way, edge.segment); });
}

/// The walls from the domain's corner, rounded to 2⁻⁴⁰ of its sides. Then the domain's origin does
/// not decide whether a wall's edge is on a cell's middle or beside it.
Rings walls_from_corner(const Mission& mission) {
  const Eigen::Array2d unit_m = std::ldexp(1.0, -40) * mission.domain.size_m.head<2>().array();
  Rings walls = mission.walls;
  for (Ring& wall : walls) {
    for (Eigen::Vector2d& corner_m : wall) {
      corner_m -= mission.domain.origin_m.head<2>();
      corner_m = unit_m * (corner_m.array() / unit_m).round();
    }
  }
  return walls;
}

Result<FreeGrid> grid_of(const Mission& mission) {
  const IndexedRings walls = walls_from_corner(mission);
  Box domain = mission.domain;
  domain.origin_m.setZero();
  std::optional<FreeRegion> bodies;
  if (const double m = kept_m(mission); m > 0) bodies.emplace(walls, domain, m);
  const Sees seen = [&](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    return sees(walls, a, b);
  };
  return free_grid(mission.domain, seen, bodies ? &*bodies : nullptr);
}

Result<ModesTable> computed(const Mission& mission) {
  auto grid = grid_of(mission);
  if (!grid) return failure(grid.error());
  const FreeGrid& cells = *grid;
  const int modes = mission.basis.mode_count();
  if (modes > cells.cell_count() / 4) {
    return failure("it has only " + std::to_string(cells.cell_count()) + " cells for " +
                   std::to_string(modes) + " modes");
  }
  const auto found = eigen_modes(cells, modes);
  if (!found) return failure("its modes do not converge");
  const auto bytes =
      std::make_shared<const std::vector<std::byte>>(encode_table(cells, *found, key_of(mission)));
  return decode_table(*bytes, bytes);
}

/// The table as this process computes it, once, independent of tables that were handed over.
Result<ModesTable> own_table(const Mission& mission) {
  const std::uint64_t key = key_of(mission);
  const auto fits = [=](const ModesTable& table) { return table->key == key; };
  if (ModesTable known = known_table(fits, &Shelf::computed)) return known;
  auto table = computed(mission);
  if (table) {
    keep_table(*table);
    Shelf& all = shelf();
    const std::lock_guard lock(all.access);
    all.computed.push_back(*table);
  }
  return table;
}

}  // namespace

void keep_table(ModesTable table) {
  Shelf& all = shelf();
  const std::lock_guard lock(all.access);
  const auto same = [&](const ModesTable& other) { return other->hash == table->hash; };
  if (std::ranges::none_of(all.tables, same)) all.tables.push_back(std::move(table));
}

Result<ModesTable> table_of(const Mission& mission) {
  const std::uint64_t key = key_of(mission);
  const auto fits = [=](const ModesTable& table) { return table->key == key; };
  if (ModesTable known = known_table(fits)) return known;
  return own_table(mission);
}

std::optional<std::string> provide_table(Mission& mission) {
  Basis& basis = mission.basis;
  if (!basis.free_domain || basis.table) return std::nullopt;
  const std::uint64_t hash = basis.table_hash;
  const auto fits = [=](const ModesTable& table) { return table->hash == hash; };
  ModesTable table = known_table(fits);
  if (table == nullptr) {
    // A table that was handed over is not used: its file may come from another computer, or may
    // have changed.
    auto made = own_table(mission);
    if (!made) return "the modes of the free domain cannot be computed: " + made.error();
    table = *std::move(made);
  }
  if (table->hash != hash || table->mode_count != basis.mode_count() ||
      table->size_m != mission.domain.size_m.head<2>() ||
      table->origin_m != mission.domain.origin_m.head<2>()) {
    return "the mission steers by the modes of table " + to_hex(hash) +
           ", and this computer's program computes others: start it with --modes and that table's "
           "file, modes-" +
           to_hex(hash) + ".bin";
  }
  basis.table = std::move(table);
  return std::nullopt;
}

}  // namespace ergocast
