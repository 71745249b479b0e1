// SPDX-License-Identifier: BSD-3-Clause
// Where bodies begin: planned or drawn, far enough from each other and from walls.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>

#include "core/base/geometry.h"
#include "core/base/ids.h"
#include "core/mission/mission.h"

namespace ergocast {

/// Where a body is.
struct Placed {
  AgentId id = kUnassigned;
  Eigen::Vector3d position_m{0, 0, 0};
};

/// The start of agent `id`: as planned, or beyond the plan drawn from the seed, outside all walls.
Eigen::Vector3d start_of(const Mission& mission, AgentId id);
/// A random place, uniform in the domain.
Eigen::Vector3d random_start(const Box& domain, std::uint64_t seed, AgentId id, int attempt = 0);

/// Where body `id` may begin if the plan gives no start: room_to_begin() of its vehicle, less
/// late_edge_margin_m() or a quarter of the shorter side, whichever is less.
Box room_to_begin(const Mission& mission, AgentId id);

/// How far apart two bodies must begin [m]: D + 2 R and what their vehicles need. Nearer bodies
/// might never move. 0 where no distance is kept.
double start_distance_m(const Mission& mission, AgentId one, AgentId other);

/// The first planned body that begins too near to an earlier one, and the first such earlier one;
/// nothing if all begin start_distance_m() apart.
std::optional<std::pair<AgentId, AgentId>> too_near_at_start(const Mission& mission,
                                                             AgentId from = 0);

/// The least distance of any two of `places_m` [m]; the greatest number if there is only one.
double least_distance_m(std::span<const Eigen::Vector3d> places_m);

/// The share of the domain that is taken up by discs, in space balls, around the first `bodies`.
/// Each is as wide as the start_distance_m() of two of its kind.
double packing(const Mission& mission, std::size_t bodies);
/// A team blocks itself often above the first packing, and most of the time above the second.
inline constexpr double kTightPacking = 0.1;
/// Limit (Scenario): share of the area that agents take up, each as wide as the distance of two
/// starts. Beyond it: the scenario is refused.
inline constexpr double kHopelessPacking = 0.3;

/// How far from body `other` the body `newcomer` must appear among moving bodies [m]. A moving body
/// does not know of it until it has executed the commands that it holds.
double join_distance_m(const Mission& mission, AgentId newcomer, AgentId other);

/// Where agent `id` begins if the plan gives no start. Places are drawn from the seed until one is
/// distance_m(mission, id, other) away from each of `others`. After kMostDraws it is the place that
/// lacks least.
Eigen::Vector3d start_beside(const Mission& mission, AgentId id, std::span<const Placed> others,
                             double (*distance_m)(const Mission&, AgentId, AgentId));
inline constexpr int kMostDraws = 1000;

}  // namespace ergocast
