// SPDX-License-Identifier: BSD-3-Clause
// Crops the map to what robots can reach, chooses their starts, and derives all numbers from their
// size and speed.
#include "scenario/new_scenario.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>
#include <optional>
#include <utility>

#include "core/motion/free_region.h"
#include "core/motion/starts.h"
#include "scenario/compile/map_walls.h"
#include "scenario/rules/checks.h"
#include "scenario/scenario.h"
#include "target/maps/occupancy_map.h"
#include "text/shortest.h"

namespace ergocast {
namespace {

namespace fs = std::filesystem;

/// The smaller the domain, the narrower are the passages that count: a map with much around its
/// rooms is cropped again.
constexpr int kMostCrops = 3;
constexpr double kSameDomain = 0.9;

/// What the law may use of the speed limit, and a noise whose rare peaks stay below the rest.
constexpr double kShareOfLimit = 0.9, kQuietNoise = 0.015;
/// Room beside bodies, as a share of their radius.
constexpr double kSpare = 0.1;
/// How often the team may pass over a strip as wide as the finest of 16 modes shows.
constexpr double kPasses = 3, kModesAlongSide = 16;
constexpr double kShortest_s = 120, kLongest_s = 3600;
constexpr std::array kSteps_s = {0.1, 0.05, 0.02, 0.01, 0.005, 0.002, 0.001};
constexpr double kLongestStep = 0.05;

/// A decimal number with few digits.
struct Decimal {
  double unit;  ///< a power of ten

  double up(double value) const { return exact(std::ceil(value / unit - 1e-6)); }
  double down(double value) const { return exact(std::floor(value / unit + 1e-6)); }

 private:
  /// Rounded once, so that few digits suffice to write it.
  double exact(double units) const {
    return unit < 1 ? units / std::round(1 / unit) : units * unit;
  }
};

/// A tenth of the leading digit of `value`.
Decimal tenth_of(double value) { return {std::pow(10, std::floor(std::log10(value)) - 1)}; }

/// A text in quotes, as Protobuf's text format has it.
std::string quoted(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      quoted += {'\\', c};
    } else if (byte < 0x20 || byte == 0x7f) {
      quoted += {'\\', static_cast<char>('0' + byte / 64), static_cast<char>('0' + byte / 8 % 8),
                 static_cast<char>('0' + byte % 8)};
    } else {
      quoted += c;
    }
  }
  return quoted + '"';
}

class Writer {
 public:
  Writer(const fs::path& map, const fs::path& file, const NewTeam& team)
      : map_(map), file_(file), team_(team) {}

  Result<NewScenario, std::vector<Problem>> run() {
    if (auto problem = read()) return failure(std::vector{*std::move(problem)});
    if (auto problem = choose_starts()) return failure(std::vector{*std::move(problem)});
    choose_times();
    auto plain = loaded(false);
    if (!plain || plain->warnings.empty()) return plain;
    auto around_walls = loaded(true);
    return around_walls && around_walls->warnings.size() < plain->warnings.size() ? around_walls
                                                                                  : plain;
  }

 private:
  Problem refuse(const std::string& what, std::string remedy) const {
    return {map_.string(), what, std::move(remedy)};
  }

  /// Problems of maps begin with the file's name.
  Problem named(const MapProblem& problem) const {
    std::string what = problem.what;
    if (what.starts_with(map_.string())) what.erase(0, map_.string().size());
    what.erase(0, what.find_first_not_of(":, "));
    return {map_.string(), std::move(what), problem.remedy};
  }

  /// Reads the map, and crops the domain to the part that robots can reach.
  std::optional<Problem> read() {
    if (!is_occupancy_map(map_))
      return refuse("is no description of a map, which ends in .yaml",
                    "name the one beside the picture, or write it: image, resolution, origin, "
                    "negate, occupied_thresh, free_thresh");
    const auto opened = OccupancyMap::open(map_);
    if (!opened) return named(opened.error());
    cell_m_ = opened->about().resolution_m;
    const double clearance_m = (1 + kSpare) * team_.radius_m + cell_m_ / 2;
    clearance_m_ = tenth_of(clearance_m).up(clearance_m);
    domain_ = whole(*opened);
    for (int crop = 0; crop < kMostCrops; ++crop) {
      const Box before = domain_;
      if (auto problem = look()) return problem;
      crop_to_room();
      if (domain_.content() > kSameDomain * before.content()) break;
    }
    return look();
  }

  /// All of the map, which may lie turned.
  static Box whole(const OccupancyMap& map) {
    const MapYaml& about = map.about();
    const Eigen::Vector2d along(std::cos(about.yaw_rad), std::sin(about.yaw_rad));
    const Eigen::Vector2d size_m = about.resolution_m * Eigen::Vector2d(map.columns(), map.rows());
    Eigen::Vector2d low_m = about.origin_m, high_m = low_m;
    for (const double x : {0.0, 1.0}) {
      for (const double y : {0.0, 1.0}) {
        const Eigen::Vector2d corner_m = about.origin_m + x * size_m.x() * along +
                                         y * size_m.y() * Eigen::Vector2d(-along.y(), along.x());
        low_m = low_m.cwiseMin(corner_m);
        high_m = high_m.cwiseMax(corner_m);
      }
    }
    return box(low_m, high_m);
  }

  static Box box(const Eigen::Vector2d& low_m, const Eigen::Vector2d& high_m) {
    Box box;
    box.origin_m.head<2>() = low_m;
    box.size_m.head<2>() = high_m - low_m;
    return box;
  }

  /// Finds what is free in the domain.
  std::optional<Problem> look() {
    const auto walls = read_map_walls(map_, domain_, false, {clearance_m_, {}});
    if (!walls) return named(walls.error());
    room_.emplace(rings_of(*walls), domain_, 1.001 * clearance_m_);
    if (room_->parts() > 0) return {};
    return refuse("has no room for robots with a radius of " + shortest(team_.radius_m) + " m",
                  "write a smaller --radius, or correct the map's resolution");
  }

  bool in_room(int cell) const { return room_->part_at(room_->center_m(cell)) == 0; }

  void crop_to_room() {
    Eigen::Vector2d low_m(0, 0), high_m(0, 0);
    bool any = false;
    for (int cell = 0; cell < room_->cells(); ++cell) {
      if (!in_room(cell)) continue;
      const Eigen::Vector2d at_m = room_->center_m(cell);
      low_m = any ? low_m.cwiseMin(at_m).eval() : at_m;
      high_m = any ? high_m.cwiseMax(at_m).eval() : at_m;
      any = true;
    }
    const Decimal round = tenth_of(10 * cell_m_);
    const double around_m = clearance_m_ + room_->cell_size_m();
    const Eigen::Vector2d end_m = (domain_.origin_m + domain_.size_m).head<2>();
    for (int axis = 0; axis < 2; ++axis) {
      low_m[axis] = round.down(std::max(domain_.origin_m[axis], low_m[axis] - around_m));
      high_m[axis] = round.up(std::min(end_m[axis], high_m[axis] + around_m));
    }
    // Sizes that are written with few digits, too.
    const Eigen::Vector2d size_m(round.up(high_m.x() - low_m.x()),
                                 round.up(high_m.y() - low_m.y()));
    domain_ = box(low_m, low_m + size_m);
    domain_.size_m.head<2>() = size_m;
  }

  /// Places around the widest one, the nearest first, twice the distance apart if there is room.
  std::optional<Problem> choose_starts() {
    const double distance_m = (2 + kSpare) * team_.radius_m;
    distance_m_ = tenth_of(distance_m).up(distance_m);
    free_m2_ = room_->free_share() * room_->share_of(0) * domain_.content();
    const double disc_m2 = std::numbers::pi / 4 * distance_m_ * distance_m_;
    const auto most = static_cast<int>(kTightPacking * free_m2_ / disc_m2);
    for (const double spacing : {2.0, 1.05}) {
      place_starts(spacing * distance_m_);
      if (std::ssize(starts_m_) == team_.robots && team_.robots <= most) return {};
    }
    const int fit = std::min<int>(most, static_cast<int>(starts_m_.size()));
    return refuse("has room for " + std::to_string(fit) + " robots with a radius of " +
                      shortest(team_.radius_m) + " m, which can pass each other, and not for " +
                      std::to_string(team_.robots),
                  fit > 0
                      ? "write --robots " + std::to_string(fit) + " or fewer, or a smaller --radius"
                      : "write a smaller --radius");
  }

  void place_starts(double spacing_m) {
    const std::vector<double> way_m = room_->ways_m(room_->cell_at(room_->middle_m(0)));
    std::vector<int> cells;
    for (int cell = 0; cell < room_->cells(); ++cell)
      if (in_room(cell)) cells.push_back(cell);
    std::ranges::stable_sort(cells, {},
                             [&](int cell) { return way_m[static_cast<std::size_t>(cell)]; });
    const Decimal round{tenth_of(cell_m_).unit / 100};  // far less than what is spare
    starts_m_.clear();
    for (const int cell : cells) {
      if (std::ssize(starts_m_) == team_.robots) return;
      const Eigen::Vector2d middle_m = room_->center_m(cell);
      const Eigen::Vector2d at_m(round.down(middle_m.x()), round.down(middle_m.y()));
      const bool apart = std::ranges::all_of(starts_m_, [&](const Eigen::Vector2d& other_m) {
        return (other_m - at_m).norm() >= spacing_m;
      });
      if (apart) starts_m_.push_back(at_m);
    }
  }

  void choose_times() {
    const double longest_m = std::min(team_.radius_m / 2, kLongestStep * domain_.shortest_side_m());
    const auto* const step = std::ranges::find_if(
        kSteps_s, [&](double dt_s) { return team_.speed_mps * dt_s <= longest_m; });
    dt_s_ = step == kSteps_s.end() ? kSteps_s.back() : *step;
    const double strip_m = domain_.size_m.maxCoeff() / kModesAlongSide;
    const double speed_mps = team_.robots * kShareOfLimit * team_.speed_mps;
    const double once_s = free_m2_ / (strip_m * speed_mps);
    duration_s_ = 60 * std::ceil(std::clamp(kPasses * once_s, kShortest_s, kLongest_s) / 60);
  }

  Result<NewScenario, std::vector<Problem>> loaded(bool free_domain) const {
    NewScenario made{text(free_domain), free_m2_, {}};
    auto scenario = Scenario::parse(made.text, file_.string());
    if (!scenario) return failure(scenario.error());
    made.warnings = scenario->warnings();
    return made;
  }

  std::string text(bool free_domain) const {
    const std::string name = map_name();
    const double u_mps = kShareOfLimit * team_.speed_mps;
    const double noise = kQuietNoise * team_.speed_mps * std::sqrt(dt_s_);
    std::string text = "# " + std::to_string(team_.robots) + " robots in the rooms of " +
                       quoted(map_.filename().string()) +
                       ". Edit first: the starts, the target, the duration.\n\n";
    text +=
        "# What robots with this radius can reach, in the map's coordinates.\n"
        "domain { origin_x_m: " +
        shortest(domain_.origin_m.x()) + "  origin_y_m: " + shortest(domain_.origin_m.y()) +
        "  size_x_m: " + shortest(domain_.size_m.x()) +
        "  size_y_m: " + shortest(domain_.size_m.y()) + " }\n\n";
    text +=
        "# The same time everywhere. For more time in one place add\n"
        "#   gaussians { weight: 1  mean_x_m: " +
        shortest(starts_m_[0].x()) + "  mean_y_m: " + shortest(starts_m_[0].y()) + "  sigma_m: " +
        shortest(tenth_of(domain_.shortest_side_m()).down(domain_.shortest_side_m() / 10)) +
        " }\n"
        "target { uniform_weight: 1 }\n\n";
    text +=
        "world {\n"
        "  # Occupied and unknown cells, and what the robots cannot reach.\n"
        "  walls { file: " +
        name +
        " }\n"
        "  wall_clearance_m: " +
        shortest(clearance_m_) +
        "  # the robots' radius, a tenth of it, and half a cell\n"
        "  speed_limit_mps: " +
        shortest(team_.speed_mps) + "\n}\n\n";
    text +=
        "# Between centres. Real robots follow late: measure response_s and add it.\n"
        "separation { distance_m: " +
        shortest(distance_m_) + " }\n\n";
    if (free_domain) text += "basis { free_domain: true }  # distances lead around walls\n";
    text += "law { u_max_mps: " + shortest(tenth_of(u_mps).down(u_mps)) +
            "  noise_intensity: " + shortest(tenth_of(noise).down(noise)) +
            "  noise_ceiling: " + shortest(tenth_of(noise).down(noise)) +
            " }  # its noise stays below the limit\n";
    text += "time { dt_s: " + shortest(dt_s_) + "  duration_s: " + shortest(duration_s_) + " }\n\n";
    text += "agents {\n";
    for (const Eigen::Vector2d& at_m : starts_m_)
      text += "  starts { x_m: " + shortest(at_m.x()) + "  y_m: " + shortest(at_m.y()) + " }\n";
    return text + "}\n";
  }

  /// From the scenario's folder.
  std::string map_name() const {
    std::error_code error;
    const fs::path folder = fs::absolute(file_, error).parent_path();
    const fs::path relative = fs::proximate(fs::absolute(map_, error), folder, error);
    return quoted(error || relative.empty() ? fs::absolute(map_).string() : relative.string());
  }

  const fs::path map_, file_;
  const NewTeam team_;
  double cell_m_ = 0, clearance_m_ = 0, distance_m_ = 0, free_m2_ = 0, dt_s_ = 0, duration_s_ = 0;
  Box domain_;
  std::optional<FreeRegion> room_;
  std::vector<Eigen::Vector2d> starts_m_;
};

}  // namespace

Result<NewScenario, std::vector<Problem>> new_scenario(const fs::path& map, const fs::path& file,
                                                       const NewTeam& team) {
  return Writer(map, file, team).run();
}

}  // namespace ergocast
