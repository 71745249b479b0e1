// SPDX-License-Identifier: BSD-3-Clause
// Turns a scenario (scenario.proto, text format) into a mission. This is the only interface to
// Protobuf's text, and this header does not show it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "core/mission/mission.h"
#include "scenario/compile/map_rooms.h"
#include "scenario/parse/problem.h"
#include "scenario/parse/source.h"
#include "target/density_picture.h"

namespace ergocast {

/// A scenario without problems, all defaults filled in, random starts drawn.
class Scenario {
 public:
  /// Reads a file of at most kMaxScenarioBytes, applies `overrides`, validates the result and
  /// integrates its target, which reads the maps. Returns all problems at once.
  static Result<Scenario, std::vector<Problem>> load(const std::filesystem::path& file,
                                                     const Overrides& overrides = {});
  /// The same for text; problems name it as `file`, and maps are in its folder.
  static Result<Scenario, std::vector<Problem>> parse(std::string_view text,
                                                      const std::string& file,
                                                      const Overrides& overrides = {});

  /// A new target for a running mission, as a scenario of that mission. `file` is a scenario, of
  /// which only the target counts, or a file that is a target by itself: a map, GeoJSON or a
  /// drawing. Its domain, origin and walls, where it has any, must be those of the mission.
  /// @param running    the text of the mission without its target, logger/mission_text.h; it may
  ///                   have an origin
  /// @param overrides  fields of the target
  static Result<Scenario, std::vector<Problem>> load_target(const std::filesystem::path& file,
                                                            const Overrides& overrides,
                                                            const std::string& running);

  /// The same for the text of a target, in which nothing names a file.
  static Result<Scenario, std::vector<Problem>> parse_target(std::string_view text,
                                                             const std::string& running);

  /// The same with another seed and new random starts: the result of load() with that seed.
  Scenario with_seed(std::uint64_t seed) const;

  Scenario(const Scenario&);
  Scenario(Scenario&&) noexcept;
  Scenario& operator=(Scenario) noexcept;
  ~Scenario();

  /// Text that load() reads back to an equal scenario: every field with its value, maps with
  /// absolute paths, the polygons of GeoJSON files in metres.
  std::string print() const;

  /// Settings that are allowed but probably not intended. Only after load() and parse().
  const std::vector<Problem>& warnings() const;

  const std::string& name() const;
  const std::string& description() const;

  /// Absolute paths of the other files that its target was made from: maps and GeoJSON. GeoJSON
  /// files are listed only after load() and parse(), because print() writes their polygons.
  std::vector<std::filesystem::path> map_files() const;
  /// The files among these, and files of walls, that the scenario names by their whole path.
  const std::vector<std::filesystem::path>& files_by_whole_path() const;

  /// What became of the occupancy maps among its walls. Only after load() and parse().
  const std::vector<MapRooms>& map_rooms() const;

  /// The target density in multiples of the uniform density, for people: at most 256 cells along
  /// the longer side of the domain.
  const DensityGrid& target_density() const;

  /// The mission in the form of the cores, within_limits() of plan/mission_limits.h. μ is computed
  /// only once, here.
  const Mission& mission() const;

 private:
  struct State;
  struct Written;
  static Result<Scenario, std::vector<Problem>> compile(Written& written);
  explicit Scenario(std::shared_ptr<const State> state);
  std::shared_ptr<const State> state_;
};

}  // namespace ergocast
