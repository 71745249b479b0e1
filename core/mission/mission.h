// SPDX-License-Identifier: BSD-3-Clause
// The validated mission plan of every process: nothing here needs checking.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/base/contribution.h"
#include "core/base/geometry.h"
#include "core/base/ids.h"
#include "core/base/indexed_rings.h"
#include "core/basis/basis.h"

namespace ergocast {

enum class Regularization {
  kAbsolute,  ///< ε as in (8), in the unit of B
  kRelative,  ///< ε = epsilon · RMS of ‖Σ λ (c − μ) ∇f‖, see core/law/control.h
};

enum class Perturbation {
  kConstant,  ///< σ is noise_intensity, as in (9)
  kAdaptive,  ///< between noise_intensity and noise_ceiling, see core/law/perturbation.h
};

enum class TargetHistory {
  kByTime,  ///< each moment counts against the target of its own time
  kKeep,    ///< all moments count against the present target
};

enum class LawKind {
  kCover,   ///< the input (8), core/law/control.h
  kMow,     ///< lanes over equal shares of the target, core/law/mower.h
  kSearch,  ///< towards what is left to find, core/law/searcher.h
};

/// The input (8) and the dynamics (10): dx = u dt − k (x − centre) dt + σ dW.
struct ControlLaw {
  LawKind kind = LawKind::kCover;
  double u_max_mps = 1;
  Regularization regularization = Regularization::kAbsolute;
  double epsilon = 0;  ///< 0 is the classical law (5), u = 0 where B = 0
  Perturbation perturbation = Perturbation::kConstant;
  double noise_intensity = 0;         ///< σ [m/√s]; adaptive: its least value
  double noise_ceiling = 0;           ///< adaptive: its greatest value [m/√s]
  double contraction_gain_per_s = 0;  ///< k
  Eigen::Vector3d contraction_center_m{0, 0, 0};
  double anticipation =
      0;  ///< a of core/law/look_ahead.h; 0: agents answer to the known coverage c
  bool ends_with_plan = false;  ///< no agent looks beyond the mission's end
  bool paired_pushes = false;   ///< adaptive: agent 2j + 1 is pushed the opposite way of agent 2j
  double memory_half_life_s =
      0;  ///< of coverage, core/mission/half_life.h; 0: it is never forgotten
  TargetHistory history = TargetHistory::kByTime;  ///< core/law/target_shift.h

  /// What σ never exceeds [m/√s].
  double max_noise() const {
    return perturbation == Perturbation::kAdaptive ? noise_ceiling : noise_intensity;
  }
};

enum class Pace { kLockstep, kRealtime };
enum class OnTimeout { kEndMission, kEvict };

struct Timing {
  double dt_s = 0.1;
  Tick tick_count = 0;              ///< the mission has ticks 0 … tick_count − 1
  int broadcast_period_ticks = 1;   ///< ticks between an agent's broadcasts of its coverage
  int high_mode_period_factor = 1;  ///< periods between broadcasts of all but the lowest modes
  Pace pace = Pace::kLockstep;
  double realtime_factor = 1;       ///< mission seconds per wall second
  double lockstep_timeout_s = 10;   ///< wall time a tick may stay unanswered
  double command_hold_s = 0.5;      ///< mission time for which the world holds an old command
  double admission_timeout_s = 30;  ///< wall time the quorum may take
  int catch_up_limit_ticks = 5;     ///< late ticks the world makes up for; the rest are skipped
  OnTimeout on_timeout = OnTimeout::kEndMission;
  ContributionEncoding contribution_encoding = ContributionEncoding::kDouble;
};

/// How far bodies keep from each other, and what is known of their motion;
/// core/motion/separation.h.
struct Separation {
  double distance_m = 0;        ///< D, between the places of two bodies; 0: none is kept
  double position_error_m = 0;  ///< how far a body may be from its reported place
  double disturbance_m = 0;     ///< the world cuts its disturbance of a body's step to this
  double response_s = 0;        ///< how long a body takes to follow a command, T
  bool guard = false;           ///< real time: the world filters the commands again
  /// Real time: each body knows only its own place, and agents send each other theirs. An agent
  /// stops if for this long it has no proof that a teammate receives it. 0: the world knows all
  /// places.
  double lease_s = 0;
};

enum class VehicleKind {
  kPoint,         ///< takes every velocity at once
  kAcceleration,  ///< changes its velocity by at most max_acceleration_mps2 · dt in a tick
  kUnicycle,      ///< moves where it looks, and turns by at most ω dt in a tick, also on the spot
  kFixedWing,     ///< never slower than min_speed_mps, and turns by at most ω dt in a tick
};

/// What a vehicle can do within its speed limit; core/motion/vehicle.h.
struct VehicleLimits {
  VehicleKind kind = VehicleKind::kPoint;
  double max_acceleration_mps2 = 0;  ///< A of kAcceleration, else 0
  double max_turn_radps = 0;         ///< ω of kUnicycle and kFixedWing, else 0
  double min_speed_mps = 0;          ///< of kFixedWing, else 0

  bool operator==(const VehicleLimits&) const = default;
};

/// The battery of a vehicle: core/motion/charge.h.
struct Battery {
  double capacity_wh = 0;  ///< 0: the vehicle has none that counts
  double power_w = 0;      ///< what it uses away from its station
  double charge_w = 0;     ///< what it gets at its station
  double reserve = 0.2;    ///< share of the capacity that is left at home

  bool any() const { return capacity_wh > 0; }
};

/// Agents that move and see alike; core/mission/kinds.h.
struct AgentKind {
  std::string name;
  int count = 1;  ///< number of its agents; their ids follow those of the kinds before
  double u_max_mps = 1;
  double noise_intensity = 0, noise_ceiling = 0;  ///< as in ControlLaw [m/√s]
  double footprint_sigma_m = 0;                   ///< w; 0: its sensor sees only a point
  double quality = 1;                             ///< q
  double band_from = 0, band_to = 0;  ///< range of |k| by which it steers; band_to 0: no upper end
  std::optional<VehicleLimits> vehicle = std::nullopt;  ///< nothing: the mission's
  double speed_limit_mps = 0;                           ///< 0: the mission's
  /// Where its agents are at the end: one place for each, one for all, or none;
  /// core/mission/station.h.
  std::vector<Eigen::Vector3d> stations_m{};
  double reserve_s = 0;  ///< time before the end at which they are there
  Battery battery{};     ///< of each of them; needs stations
};

/// Limit (Scenario): objects to find. Beyond it: the scenario is refused.
inline constexpr int kMaxObjects = 32;

/// How objects drift: core/measure/drift.h.
struct ObjectMotion {
  double speed_mps = 0;       ///< 0: they stand still
  double persistence_s = 60;  ///< after this time the mean cosine of what they have turned is 1/e

  bool any() const { return speed_mps > 0; }
};

/// The objects that the simulated world hides in a plane: `count` of them, or those that begin at
/// `places_m`; core/measure/objects.h. They do not steer.
struct HiddenObjects {
  int count = 0;  ///< drawn from the target
  std::vector<Eigen::Vector3d> places_m{};
  int end_when_found = 0;  ///< the mission ends once so many are found; 0: it does not
  ObjectMotion motion{};

  int total() const { return places_m.empty() ? count : static_cast<int>(places_m.size()); }
};

/// The sensor with which agents find objects. core/measure/ measures by it; only the law kSearch
/// (core/search/) steers by it. With false alarms its reports steer, too, and an object counts as
/// found once they confirm it: core/search/contacts.h.
struct SearchSensor {
  double radius_m = 0;            ///< 0: core/measure/detection.h has a default
  double detections_per_s = 0.5;  ///< of an object within the radius
  double false_alarms_per_s = 0;  ///< anywhere within the radius; 0: a detection is certain
  double position_error_m = 0;    ///< standard deviation of a reported place, along x and along y
  double confirm_at = 0.99;       ///< how likely a contact must be an object

  bool has_false_alarms() const { return false_alarms_per_s > 0; }
};

/// The most sites of a team: memory grows with the square of their number.
inline constexpr int kMostSites = 1024;

/// Sites that sum up their members' rows (core/law/site_row.h); core/mission/sites.h.
struct TeamSites {
  int count = 0;             ///< 0: each agent receives the rows of all others
  int row_period_ticks = 2;  ///< between two rows of a site

  bool any() const { return count > 0; }
};

struct Mission {
  std::string name;
  std::uint64_t seed = 0;
  Box domain;
  Basis basis;
  Coefficients target_coefficients;  ///< μ
  Coefficients cosine_target;        ///< with basis.free_domain: μ in the basis (2), else empty
  ControlLaw law;
  Timing timing;
  std::vector<Eigen::Vector3d> starts_m;  ///< where agent i begins; one per planned agent
  std::vector<AgentKind>
      kinds;       ///< empty: all agents are alike; else the counts add up to all planned agents
  int quorum = 1;  ///< agents that must be admitted before the start
  double forget_silent_after_s = 0;  ///< wall time; 0: a silent agent's coverage counts for ever
  double goal_ergodic_metric = 0;    ///< the goal for φ²; 0: none
  double disturbance_intensity = 0;  ///< actuation noise in the world [m/√s]
  double radio_range_m = 0;          ///< range within which agents receive each other; 0: unlimited
  double speed_limit_mps = 0;        ///< of vehicles whose kind has none of its own; 0: none
  IndexedRings walls;                ///< a point is solid if an odd number of rings enclose it
  double wall_clearance_m = 0;       ///< how far bodies keep from them
  HiddenObjects objects;
  VehicleLimits vehicle;  ///< of those whose kind has none of its own
  Separation separation;
  SearchSensor sensor;  ///< of every agent
  TeamSites sites;
  bool dead_reckoning = false;  ///< whether forecasts use teammates' places, core/law/forecast.h
  bool wait_for_logger =
      true;  ///< lockstep: the world runs a bounded number of ticks ahead of the record
};

/// The same mission with the cosines (2) as its basis. A team that steers by other modes is judged
/// by cosines with it.
Mission in_cosines(Mission mission);

/// The longest time between two broadcasts of a block.
inline Tick longest_period_ticks(const Timing& timing) {
  return Tick{timing.broadcast_period_ticks} * timing.high_mode_period_factor;
}

/// The first tick after `tick` at which agent `id` broadcasts a block. The planned agents take
/// turns within the period of that block. An agent that will rest (core/mission/station.h) sends
/// all blocks once more at its last tick before the rest, and nothing after it.
Tick next_broadcast(const Mission& mission, AgentId id, Tick tick, int block = 0);
class EndSchedule;
/// The same if the end was amended: by the end that holds at `tick`.
Tick next_broadcast(const Mission& mission, const EndSchedule& ends, AgentId id, Tick tick,
                    int block);

}  // namespace ergocast
