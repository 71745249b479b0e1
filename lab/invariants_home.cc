// SPDX-License-Identifier: BSD-3-Clause
// Checks the places of agents that have a station, and computes them again.
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "core/mission/kinds.h"
#include "core/mission/station.h"
#include "core/motion/filter_rules.h"
#include "core/motion/vehicle.h"
#include "lab/invariants.h"
#include "lab/shadow/shadow_equations.h"

namespace ergocast::lab {
namespace {

/// Where agent `id` is to be.
Eigen::Vector3d station_m_of(const Mission& mission, AgentId id) {
  int place = id;
  for (const AgentKind& kind : mission.kinds) {
    if (place < kind.count)
      return kind.stations_m.size() == 1 ? kind.stations_m.front()
                                         : kind.stations_m[static_cast<std::size_t>(place)];
    place -= kind.count;
  }
  return mission.domain.center_m();
}

/// Two steps; across the circle of a fixed wing; two pushes of the world, by 6 deviations each; and
/// two errors of what it knows of its place.
double tolerated_m(const Mission& mission, AgentId id) {
  const Motion motion = motion_of(mission, id);
  const double dt_s = mission.timing.dt_s;
  const double v_mps = law_of(mission, planned_kind(mission, id)).u_max_mps;
  const VehicleLimits& vehicle = motion.vehicle;
  const double across_m = vehicle.kind == VehicleKind::kFixedWing
                              ? 2 * vehicle.min_speed_mps / vehicle.max_turn_radps
                              : 0;
  return 2 * v_mps * dt_s + across_m + 12 * mission.disturbance_intensity * std::sqrt(dt_s) +
         2 * mission.separation.position_error_m;
}

/// The least distance from `to_m` to any place that a body at `from_m` can get to in a plane, if it
/// has to keep `kept_m` from each of `bodies_m`. A cell of the grid counts as free if any of its
/// places may be, so the result is never too great.
double nearest_reached_m(const Box& domain, const std::vector<Eigen::Vector2d>& bodies_m,
                         double kept_m, const Eigen::Vector2d& from_m,
                         const Eigen::Vector2d& to_m) {
  constexpr double kCellsInDistance = 16, kMostCells = 1024;
  const Eigen::Vector2d origin_m = domain.origin_m.head<2>(), size_m = domain.size_m.head<2>();
  const double cell_m = std::max(kept_m / kCellsInDistance, size_m.maxCoeff() / kMostCells);
  const double corner_m = cell_m * std::sqrt(0.5);
  const int columns = static_cast<int>(size_m.x() / cell_m) + 1;
  const int rows = static_cast<int>(size_m.y() / cell_m) + 1;
  const auto index = [&](int column, int row) {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
           static_cast<std::size_t>(column);
  };
  std::vector<bool> seen(index(0, rows), false);
  std::vector<std::pair<int, int>> open;
  double nearest_m = (from_m - to_m).norm();
  const auto visit = [&](int column, int row) {
    if (column < 0 || row < 0 || column >= columns || row >= rows || seen[index(column, row)])
      return;
    seen[index(column, row)] = true;
    const Eigen::Vector2d x_m = origin_m + cell_m * Eigen::Vector2d(column + 0.5, row + 0.5);
    const bool taken = std::ranges::any_of(bodies_m, [&](const Eigen::Vector2d& body_m) {
      return (body_m - x_m).norm() < kept_m - corner_m;
    });
    if (taken) return;
    open.emplace_back(column, row);
    nearest_m = std::min(nearest_m, std::max(0.0, (x_m - to_m).norm() - corner_m));
  };
  const Eigen::Vector2d first = (from_m - origin_m) / cell_m;
  visit(static_cast<int>(first.x()), static_cast<int>(first.y()));
  while (!open.empty()) {
    const auto [column, row] = open.back();
    open.pop_back();
    for (int side = -1; side <= 1; side += 2) {
      visit(column + side, row);
      visit(column, row + side);
    }
  }
  return nearest_m;
}

/// The longest straight way, at the speed of the way home.
double longest_way_home_s(const Mission& mission, AgentId id) {
  const double limit_mps = motion_of(mission, id).speed_limit_mps;
  double v_mps = law_of(mission, planned_kind(mission, id)).u_max_mps;
  if (limit_mps > 0) v_mps = std::min(v_mps, limit_mps);
  return mission.domain.size_m.norm() / v_mps;
}

}  // namespace

/// Whether a zone may keep an agent from being home at a counted tick. One that has ended for long
/// enough does not: from then on the agent has the whole time that the longest way takes. If it may
/// have to turn, give way or go against the wind, it has twice the time and some seconds. Ways
/// among walls are not known here.
bool Invariants::zone_may_delay(AgentId id, Tick home_from) const {
  constexpr double kSpare_s = 1, kTurns_s = 10;
  if (!mission_.walls.empty()) return !zones_.empty();
  const bool straight = motion_of(mission_, id).is_point() && !keeps_distance(mission_) &&
                        mission_.disturbance_intensity == 0;
  const double longest_s = longest_way_home_s(mission_, id);
  const double spare_s = straight ? longest_s + kSpare_s : 2 * longest_s + kTurns_s;
  const auto spare = static_cast<Tick>(std::ceil(spare_s / mission_.timing.dt_s));
  return std::ranges::any_of(zones_, [&](const auto& zone) {
    return counted_ticks(truth_.holds(), zone.second.end()) > home_from - spare;
  });
}

/// How near its station a vehicle that keeps a distance can get: vehicles of agents that were sent
/// out stand for good, perhaps at the station or around it. 0 where that is not known.
double Invariants::nearest_to_station_m(const Vehicle& vehicle) const {
  if (!keeps_distance(mission_) || !mission_.domain.planar()) return 0;
  std::vector<Eigen::Vector2d> standing_m;
  for (const auto& [id, place_m] : places_m_) {
    const bool stands = std::ranges::any_of(truth_.roster(), [gone = id](const RosterEntry& entry) {
      return entry.author.agent == gone && entry.leaves;
    });
    if (stands && id != vehicle.id) standing_m.push_back(place_m.head<2>());
  }
  if (standing_m.empty()) return 0;
  return nearest_reached_m(mission_.domain, standing_m, mission_.separation.distance_m,
                           vehicle.position_m.head<2>(),
                           station_m_of(mission_, vehicle.id).head<2>());
}

/// Checks the agents that the mission began with, in lockstep, where no tick is lost. An agent that
/// was sent out of the mission stands where it was. The others are as near to their stations as
/// they can get.
void Invariants::check_home(double t_s, const WorldState& world) {
  const Timing& timing = mission_.timing;
  if (home_from_.empty() || timing.pace == Pace::kRealtime ||
      timing.on_timeout == OnTimeout::kEvict)
    return;
  const Tick counted = counted_ticks(truth_.holds(), world.header.tick);
  for (const Vehicle& vehicle : world.vehicles_in_part()) {
    const auto from = home_from_.find(vehicle.id);
    if (from == home_from_.end() || counted < from->second) continue;
    if (zone_may_delay(vehicle.id, from->second)) continue;
    if (!counts_for_home(vehicle.id)) continue;
    const double apart_m = (vehicle.position_m - station_m_of(mission_, vehicle.id)).norm();
    const double most_m = tolerated_m(mission_, vehicle.id);
    if (apart_m <= most_m * (1 + 1e-9)) continue;
    const double nearest_m = nearest_to_station_m(vehicle);
    if (apart_m <= nearest_m + most_m * (1 + 1e-9)) continue;
    violate(t_s, Invariant::kHomeInTime, "vehicle " + std::to_string(vehicle.id),
            text("is ", apart_m, " m from its station at tick ", world.header.tick, ", and ",
                 nearest_m + most_m, " m are tolerated"));
  }
}

/// Whether it is an agent that the mission began with, and was not sent out.
bool Invariants::counts_for_home(AgentId id) const {
  bool from_the_start = false, sent_out = false;
  for (const RosterEntry& entry : truth_.roster()) {
    if (entry.author.agent != id) continue;
    from_the_start = from_the_start || entry.active_from == 0;
    sent_out = sent_out || entry.leaves;
  }
  return from_the_start && !sent_out;
}

/// Checks lockstep, where an agent answers each tick. Zones may close the way home for any time.
void Invariants::check_batteries(double t_s, const WorldState& world) {
  const Timing& timing = mission_.timing;
  if (timing.pace == Pace::kRealtime) return;
  const bool free = zones_.empty() && timing.on_timeout != OnTimeout::kEvict;
  for (const Vehicle& vehicle : world.vehicles_in_part()) {
    if (vehicle.id >= std::ssize(mission_.starts_m)) continue;
    const int kind = planned_kind(mission_, vehicle.id);
    const Battery battery =
        mission_.kinds.empty() ? Battery{} : mission_.kinds[static_cast<std::size_t>(kind)].battery;
    if (battery.capacity_wh == 0) continue;
    const double apart_m = (vehicle.position_m - station_m_of(mission_, vehicle.id)).norm();
    check_charge(t_s, vehicle, battery, world.header.tick, apart_m);
    const double most_m = tolerated_m(mission_, vehicle.id) * (1 + 1e-9);
    if (free && vehicle.charge_ppm == 0 && apart_m > most_m && counts_for_home(vehicle.id))
      violate(t_s, Invariant::kEmptyOnlyAtHome, "vehicle " + std::to_string(vehicle.id),
              text("is empty ", apart_m, " m from its station at tick ", world.header.tick));
  }
}

/// A restarted world may report a tick again, without the velocities.
void Invariants::note_charge(const Vehicle& vehicle, Tick tick) {
  constexpr std::size_t kTicksKept = 256;
  if (!any_battery(mission_)) return;
  auto& ticks = charged_[vehicle.id];
  const bool now = is_charged(mission_, vehicle);
  const auto [at, is_new] = ticks.try_emplace(tick, now);
  if (!is_new && at->second != now) at->second.reset();
  if (ticks.size() > kTicksKept) ticks.erase(ticks.begin());
}

/// Nothing if that is not known; false if the mission has no batteries.
std::optional<bool> Invariants::charged(AgentId id, Tick tick) const {
  const auto ticks = charged_.find(id);
  if (ticks == charged_.end()) return false;
  const auto at = ticks->second.find(tick);
  return at == ticks->second.end() ? std::nullopt : at->second;
}

/// Compares the charge with that of the tick before. At the edge of its station it may have been
/// charged or not, and a restarted world knows the charge in whole millionths.
void Invariants::check_charge(double t_s, const Vehicle& vehicle, const Battery& battery, Tick tick,
                              double apart_m) {
  constexpr double kRounded_ppm = 4;
  const auto [before, before_ppm] =
      std::exchange(charges_[vehicle.id], std::pair(tick, vehicle.charge_ppm));
  if (before_ppm == 0 || before + 1 != tick || worlds_.size() > 1) return;
  const double per_w = mission_.timing.dt_s / (battery.capacity_wh * 3600) * 1e6;
  const double used_ppm = is_held(truth_.holds(), before) ? 0 : battery.power_w * per_w;
  const double change_ppm = vehicle.charge_ppm - before_ppm;
  const double most_m = tolerated_m(mission_, vehicle.id);
  const bool used = std::abs(change_ppm + std::min<double>(used_ppm, before_ppm)) <= kRounded_ppm;
  const bool charged = change_ppm >= 0 && change_ppm <= battery.charge_w * per_w + kRounded_ppm;
  if (apart_m > most_m * (1 + 1e-9) ? used : apart_m < most_m * (1 - 1e-9) ? charged : true) return;
  violate(t_s, Invariant::kChargesAreTrue, "vehicle " + std::to_string(vehicle.id),
          text("has a charge that changed by ", change_ppm, " ppm at tick ", tick));
}

/// Whether it rests because it was recalled, by the newest roster that was sent.
bool Invariants::recalled_in_truth(const TableView& holder) const {
  const RosterEntry* const entry = truth_.entry_of(holder.self.incarnation);
  return entry != nullptr && is_recalled(*entry, holder);
}

/// Checks points in lockstep that nothing keeps from their way.
void Invariants::check_recalled_home(double t_s, const TableView& holder) {
  const AgentId id = holder.self.agent;
  const bool free = mission_.separation.distance_m == 0 && mission_.walls.empty() &&
                    mission_.disturbance_intensity == 0 && motion_of(mission_, id).is_point();
  const auto rested = rested_.find(holder.self);
  const auto place = places_m_.find(id);
  if (mission_.timing.pace == Pace::kRealtime || !free || rested == rested_.end() ||
      place == places_m_.end())
    return;
  const double longest_s = longest_way_home_s(mission_, id) + 2 * mission_.timing.dt_s;
  if (static_cast<double>(rested->second) * mission_.timing.dt_s <= longest_s) return;
  const bool has_station = home_from_.contains(id);
  const Eigen::Vector3d home_m =
      has_station ? station_m_of(mission_, id) : mission_.starts_m[static_cast<std::size_t>(id)];
  const double apart_m = (place->second - home_m).norm();
  const double most_m = tolerated_m(mission_, id);
  if (apart_m <= most_m * (1 + 1e-9)) return;
  violate(t_s, Invariant::kRecalledComeHome, name_of(holder.self),
          text("is ", apart_m, " m from home at tick ", holder.answered, ", ", rested->second,
               " ticks after it was recalled"));
}

/// A number has no other present member than the one that was sent out.
void Invariants::check_closed_numbers(double t_s) {
  for (const RosterEntry& gone : truth_.roster()) {
    if (!gone.leaves) continue;
    for (const RosterEntry& other : truth_.roster()) {
      if (other.author.agent != gone.author.agent || other.author == gone.author) continue;
      if (other.active_until >= 0) continue;
      violate(t_s, Invariant::kClosedNumbersStayEmpty, name_of(other.author),
              text("follows ", name_of(gone.author)));
    }
  }
}

}  // namespace ergocast::lab
