// SPDX-License-Identifier: BSD-3-Clause
// A running team as the topics of `ergocast export --to mcap`. No clock, no I/O.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "cli/foxglove/live_channels.h"
#include "cli/team/team_view.h"
#include "core/mission/kinds.h"
#include "logger/run_data.h"
#include "report/export/record.h"
#include "target/geo/local_plane.h"
#include "team/messages.h"
#include "team/mission_follower.h"

namespace ergocast::cli {

/// Messages have the time at which they are shown, in nanoseconds since 1970. An export has the
/// mission's time instead.
class LiveTopics {
 public:
  /// The shortest time between two pictures of the coverage.
  static constexpr std::uint64_t kCoveragePeriod_ns = 1'000'000'000;
  /// Limit (Page): places of an agent that Foxglove clients get in a second. Beyond it: only
  /// the newest one is sent.
  static constexpr std::uint64_t kPlacesPerSecond = 20;
  static constexpr std::uint64_t kPlacesPeriod_ns = 1'000'000'000 / kPlacesPerSecond;

  /// @param channels  gets the topics; outlives this object
  /// @param origin    nothing: there are no locations
  /// @param target    the plan's target; empty: the one that its coefficients describe
  LiveTopics(LiveChannels& channels, const std::optional<GeoPlace>& origin, DensityCells target);

  /// Takes in a part of the world's state. Old places and repeated ones change nothing.
  void take(const WorldState& world, const MissionFollower& team);
  /// Shows the places that are new, at most kPlacesPerSecond times a second; call it more often.
  void show_places(std::uint64_t time_ns);
  void show_line(std::uint64_t time_ns, const std::string& line);
  /// Shows all else that has changed. @pre team.mission() is known
  void show(std::uint64_t time_ns, const TeamPicture& picture, const MissionFollower& team);

 private:
  struct Shown {
    LiveChannels::Id pose = 0, location = 0;
    TrackPoint newest{.tick = -1};
    bool is_new = false;
  };
  /// The coverage so far, in cosines as in an export.
  struct Sums {
    explicit Sums(const Mission& planned);
    void add(AgentId id, const Eigen::Vector3d& x_m);

    Mission mission;
    Sensors sensors;
    Coefficients sums;
    double samples = 0;  // each weighted by its quality
    bool is_new = false;
  };

  Shown& shown(AgentId id);
  void note_recalls(const WorldState& world, const MissionFollower& team);
  void show_metrics(std::uint64_t time_ns, const TeamPicture& picture, const MissionFollower& team);
  void show_target(std::uint64_t time_ns, Tick tick, const Amendments& amendments);
  void show_amendments(std::uint64_t time_ns, Tick tick, const MissionFollower& team);
  void show_coverage(std::uint64_t time_ns);

  LiveChannels& channels_;
  std::optional<LocalPlane> plane_;
  DensityCells planned_target_;
  LiveChannels::Id target_, coverage_, metrics_, log_, amendments_;
  std::map<AgentId, Shown> agents_;
  std::optional<Sums> sums_;                        // once the mission is known
  std::map<AgentId, Tick> recalled_from_;           // an agent rests from this tick on
  std::pair<std::int64_t, std::int64_t> roster_{};  // revisions: known, and used by the world
  double metrics_s_ = -1;                           // mission time of the newest row
  std::optional<std::int32_t> target_number_;       // of the amendment; −1: the plan's
  std::int32_t next_amendment_ = 0;
  std::uint64_t next_coverage_ns_ = 0, next_places_ns_ = 0;
};

}  // namespace ergocast::cli
