// SPDX-License-Identifier: BSD-3-Clause
// Looks an agent's kind up, and its place within the kind.
#include "core/mission/station.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ergocast {
namespace {

/// Tolerance with which a reserve of whole ticks is not rounded up.
constexpr double kWholeTick = 1e-9;

/// The kind of a planned agent that has a station, and the agent's place within the kind.
struct AtHome {
  const AgentKind* kind = nullptr;
  int place = 0;
};

AtHome at_home(const Mission& mission, AgentId id) {
  int first = 0;
  for (const AgentKind& kind : mission.kinds) {
    const int place = id - first;
    if (place < 0) break;
    if (place < kind.count) return {kind.stations_m.empty() ? nullptr : &kind, place};
    first += kind.count;
  }
  return {};
}

}  // namespace

std::optional<Eigen::Vector3d> station_of(const Mission& mission, AgentId id) {
  const auto [kind, place] = at_home(mission, id);
  if (kind == nullptr) return std::nullopt;
  const auto count = kind->stations_m.size();
  return kind->stations_m[std::min(static_cast<std::size_t>(place), count - 1)];
}

std::optional<Eigen::Vector3d> home_of(const Mission& mission, AgentId id) {
  if (const auto station_m = station_of(mission, id)) return station_m;
  const auto at = static_cast<std::size_t>(id);
  return at < mission.starts_m.size() ? std::optional(mission.starts_m[at]) : std::nullopt;
}

const Battery* battery_of(const Mission& mission, AgentId id) {
  const AgentKind* const kind = at_home(mission, id).kind;
  return kind != nullptr && kind->battery.any() ? &kind->battery : nullptr;
}

bool any_station(const Mission& mission) {
  return std::ranges::any_of(mission.kinds,
                             [](const AgentKind& kind) { return !kind.stations_m.empty(); });
}

bool any_battery(const Mission& mission) {
  return std::ranges::any_of(mission.kinds,
                             [](const AgentKind& kind) { return kind.battery.any(); });
}

Tick rest_from(const Mission& mission, AgentId id) {
  const AgentKind* const kind = at_home(mission, id).kind;
  if (kind == nullptr) return std::numeric_limits<Tick>::max();
  const double ticks = kind->reserve_s / mission.timing.dt_s;
  return mission.timing.tick_count - static_cast<Tick>(std::ceil(ticks * (1 - kWholeTick)));
}

}  // namespace ergocast
