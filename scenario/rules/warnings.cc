// SPDX-License-Identifier: BSD-3-Clause
// One function for each warning, such as steps, weights, packing, stations and walls.
#include "scenario/rules/warnings.h"

#include <algorithm>
#include <optional>
#include <string>

#include "core/law/block_layout.h"
#include "core/law/perturbation.h"
#include "core/mission/kinds.h"
#include "core/mission/station.h"
#include "core/motion/filter_rules.h"
#include "core/motion/home.h"
#include "core/motion/starts.h"
#include "core/motion/vehicle.h"
#include "scenario/rules/checks.h"
#include "scenario/rules/footprint_reach.h"
#include "scenario/rules/hidden_mass.h"
#include "scenario/rules/law_advice.h"
#include "scenario/rules/validate_separation.h"

namespace ergocast {
namespace {

/// A normal vector in the plane is longer than this many deviations once in 65 million steps.
constexpr double kDeviations = 6;

/// Agents with a forecast need steps of at most this share of the shorter side: docs/law.md.
constexpr double kLongestStep = 0.05;

/// Agents with a forecast need weights that fall at least like this power of the wave number.
constexpr double kLeastDecay = 0.75;
/// With at most this anticipation they lose nothing to the classical law.
constexpr double kLittleAnticipation = 0.5;

/// A least φ² above this share of an even coverage's makes a target finer than the footprints.
constexpr double kReachable = 0.01;

/// The share of a target that walls may hide from the rest of it, docs/targets.md.
constexpr double kMostHidden = 0.1;

/// The time for detours around others: this times the way past all of them, side by side.
constexpr double kDetours = 4;

/// The law's noise as a formula of scenario fields.
std::string noise_text(const ControlLaw& law, double dt_s) {
  const std::string own = "noise_intensity / sqrt(dt_s)";
  if (law.perturbation == Perturbation::kConstant) return own;
  const Tick held = push_ticks(law, dt_s);
  return own + " and a push of " + shortest(rounded_up(greatest_push_mps(law, dt_s))) +
         " m/s held for " + std::to_string(held) + (held == 1 ? " step" : " steps");
}

/// The fastest kind of those without a speed limit of their own; nothing if all have one.
std::optional<int> fastest_kind(const Mission& mission) {
  if (mission.kinds.empty()) return 0;
  std::optional<int> fastest;
  for (int kind = 0; kind < std::ssize(mission.kinds); ++kind) {
    const AgentKind& one = mission.kinds[static_cast<std::size_t>(kind)];
    const bool faster = !fastest || one.u_max_mps > law_of(mission, *fastest).u_max_mps;
    if (one.speed_limit_mps == 0 && faster) fastest = kind;
  }
  return fastest;
}

/// A limit below the law's commands cuts off the tails of its noise.
void warn_of_speed_limit(const Mission& mission, int kind, const std::string& field,
                         Findings& findings) {
  const ControlLaw law = law_of(mission, kind);
  const double limit_mps = motion_of_kind(mission, kind).speed_limit_mps;
  const double dt_s = mission.timing.dt_s;
  const double pull_mps =
      law.contraction_gain_per_s * mission.domain.farthest_distance_m(law.contraction_center_m);
  const double noise_mps = kDeviations * greatest_deviation_mps(law, dt_s);
  const double needed_mps = law.u_max_mps + pull_mps + noise_mps;
  if (limit_mps <= 0 || limit_mps >= needed_mps) return;
  const std::string needed = shortest(rounded_up(needed_mps));
  findings.add(
      field,
      shortest(limit_mps) + " cuts the method's noise short: the law commands up to " + needed +
          " m/s = u_max_mps " + shortest(law.u_max_mps) + " + contraction at the farthest corner " +
          shortest(rounded_up(pull_mps)) + " + 6 deviations of its noise " +
          shortest(rounded_up(noise_mps)) + " (" + noise_text(law, dt_s) + ")",
      limit_mps < law.u_max_mps
          ? std::string("if vehicles are no faster, write a ") +
                (field == "world.speed_limit_mps" ? "law." : "") + "u_max_mps of at most " +
                shortest(limit_mps) + ": even without noise it is cut"
          : "write at least " + needed +
                ", less noise or a greater dt_s, or accept it: the cuts are counted");
}

void warn_of_speed_limits(const Mission& mission, Findings& findings) {
  if (const auto kind = fastest_kind(mission))
    warn_of_speed_limit(mission, *kind, "world.speed_limit_mps", findings);
  for (int kind = 0; kind < std::ssize(mission.kinds); ++kind) {
    if (mission.kinds[static_cast<std::size_t>(kind)].speed_limit_mps > 0)
      warn_of_speed_limit(mission, kind, indexed("agents.kind", kind) + ".speed_limit_mps",
                          findings);
  }
}

/// A teammate's last step does not predict its next one if it crosses the domain in a few steps.
void warn_of_coarse_steps(const Mission& mission, Findings& findings) {
  const double longest_s = kLongestStep * mission.domain.shortest_side_m() / mission.law.u_max_mps;
  if (mission.law.anticipation <= 0 || mission.timing.dt_s <= longest_s) return;
  findings.add(
      "time.dt_s",
      shortest(mission.timing.dt_s) +
          " is coarse for agents that look ahead: one step at u_max_mps is longer than 5 % of the "
          "shorter side, and in the long run a uniform target may be covered worse than without "
          "looking "
          "ahead",
      "write at most " + shortest(rounded_down(longest_s)) + ", or law.anticipation: 0");
}

/// If short waves count nearly as much as long ones, most of what counts is beyond the forecast:
/// docs/law.md.
void warn_of_flat_weights(const Mission& mission, Findings& findings) {
  const Basis& basis = mission.basis;
  const bool squared = basis.sobolev_form == SobolevForm::kSquaredNorm;
  const double least = squared ? kLeastDecay / 2 : kLeastDecay;
  if (mission.law.anticipation <= kLittleAnticipation || basis.sobolev_exponent >= least) return;
  findings.add(
      "basis.sobolev_exponent",
      shortest(basis.sobolev_exponent) +
          " lets short waves count nearly as much as long ones, and agents that look ahead "
          "then cover worse than without: phi^2 was found up to 1.5 times as large",
      "write at least " + shortest(least) +
          ", or law.anticipation: " + shortest(kLittleAnticipation));
}

/// An agent forgets what it has covered before it is back there: docs/law.md.
void warn_of_short_memory(const Mission& mission, Findings& findings) {
  const double half_life_s = mission.law.memory_half_life_s;
  const double crossing_s = mission.domain.size_m.maxCoeff() / mission.law.u_max_mps;
  if (half_life_s == 0 || half_life_s >= crossing_s) return;
  findings.add("law.memory_half_life_s",
               shortest(half_life_s) + " is shorter than the " + shortest(rounded_up(crossing_s)) +
                   " s that an agent takes to cross the domain: the team then forgets coverage "
                   "before it is used, and covers worse",
               "write at least " + shortest(rounded_up(crossing_s)) +
                   ", better several times as much, or leave it out");
}

/// Agents find ways around each other only if there is room.
void warn_of_packing(const Mission& mission, Findings& findings) {
  if (!keeps_distance(mission)) return;
  const double share = packing(mission, mission.starts_m.size());
  if (share <= kTightPacking) return;
  findings.add("separation.distance_m",
               std::to_string(mission.starts_m.size()) + " agents " +
                   spacing_text(mission, mission.starts_m.size()) + " m apart take up " +
                   shortest(rounded_up(100 * share)) +
                   " % of the domain: above 10 % they often block each other",
               "write a smaller distance or fewer agents, or accept it: status and summary report "
               "how long agents are blocked");
}

/// The computed way home has no detours around other agents.
void warn_of_crowded_ways_home(const Mission& mission, Findings& findings) {
  if (!keeps_distance(mission) || mission.starts_m.size() < 2) return;
  AgentId first = 0;
  for (int kind = 0; kind < std::ssize(mission.kinds); ++kind) {
    const AgentKind& its = mission.kinds[static_cast<std::size_t>(kind)];
    const double around_m =
        start_distance_m(mission, first, first) * static_cast<double>(mission.starts_m.size());
    const double least_s = kDetours * around_m / home_speed_mps(mission, first);
    first += its.count;
    if (its.stations_m.empty() || its.reserve_s >= least_s) continue;
    findings.add(indexed("agents.kind", kind) + ".reserve_s",
                 shortest(its.reserve_s) + " is little for " +
                     std::to_string(mission.starts_m.size()) +
                     " agents that keep their distance: an agent that gives way to others on the "
                     "way home may come late",
                 "write at least " + shortest(rounded_up(least_s)) + ", or accept it");
  }
}

/// An agent at home stands in the way of agents that are not home yet.
void warn_of_tight_stations(const Mission& mission, Findings& findings) {
  const auto team = static_cast<AgentId>(mission.starts_m.size());
  for (AgentId one = 0; one < team && keeps_distance(mission); ++one) {
    const auto home_m = station_of(mission, one);
    const double passage_m = 2 * start_distance_m(mission, one, one);
    for (AgentId other = 0; home_m && other < one; ++other) {
      const auto their_m = station_of(mission, other);
      if (!their_m || (*home_m - *their_m).norm() >= passage_m) continue;
      return findings.add("agents.kind",
                          "agents " + std::to_string(other) + " and " + std::to_string(one) +
                              " have stations that no agent can pass between: the first agent at "
                              "home may block the others",
                          "write stations at least " + shortest(rounded_up(passage_m)) +
                              " m apart, or accept it for one row that all can reach from a side");
    }
  }
}

/// A vehicle that follows late needs room to stop.
void warn_of_late_vehicles(const Mission& mission, Findings& findings) {
  if (!keeps_distance(mission) || mission.separation.response_s == 0) return;
  const double side_m = mission.domain.shortest_side_m();
  for (AgentId id = 0; id < std::ssize(mission.starts_m); ++id) {
    const double margin_m = late_edge_margin_m(mission, id);
    if (margin_m > side_m / 4) {
      findings.add("separation.response_s",
                   "vehicles that follow so late keep " + shortest(rounded_up(margin_m)) +
                       " m from every edge, more than a quarter of the domain's shorter side: "
                       "little of the domain is left to them",
                   "write a smaller world.speed_limit_mps or response_s, or a larger domain");
      return;
    }
    if (room_to_begin(mission, id).contains(mission.starts_m[static_cast<std::size_t>(id)]))
      continue;
    findings.add(
        indexed("agents.starts", id),
        "is nearer to an edge than the " + shortest(rounded_up(margin_m)) +
            " m that a vehicle with this delay keeps: it may cross the edge while it is there",
        "move it inside");
  }
}

/// Coarse sensors blur what they see, and no path can compensate for it.
void warn_of_footprints(const Mission& mission, Findings& findings) {
  const bool any = std::ranges::any_of(
      mission.kinds, [](const AgentKind& kind) { return kind.footprint_sigma_m > 0; });
  if (!any) return;
  const Coefficients& mu = mission.target_coefficients;
  const Coefficients weights = sobolev_weights(mission.basis, mission.domain);
  Coefficients even = Coefficients::Zero(mu.size());
  even[0] = 1;
  double figure = kReachable * ergodic_metric(even, mu, weights);
  if (mission.goal_ergodic_metric > 0) figure = std::min(figure, mission.goal_ergodic_metric);
  const FootprintReach reach = footprint_reach(mission, figure);
  if (reach.low <= figure) return;
  findings.add("agents.kind",
               "the target is finer than the sensors see: whatever the agents do, phi^2 of what "
               "they see stays above about " +
                   shortest(rounded_down(reach.low)) + ", which is " +
                   shortest(rounded_down(100 * reach.low / reach.even)) +
                   " % of an even coverage's",
               "write smaller footprints, more agents or a higher quality of the finer kind, or a "
               "smoother target");
}

/// Sending high modes less often requires that there are high modes, and enough time.
void warn_of_rare_modes(const Mission& mission, Findings& findings) {
  const Timing& timing = mission.timing;
  if (timing.high_mode_period_factor == 1) return;
  const std::string factor = std::to_string(timing.high_mode_period_factor);
  const Tick between = longest_period_ticks(timing);
  if (!separates_low_modes(mission)) {
    findings.add("time.high_mode_period_factor",
                 factor + " has no effect: the basis has " +
                     std::to_string(mission.basis.mode_count()) + " modes, and the " +
                     std::to_string(kLowModes) + " lowest are sent every period",
                 "leave it out, or write more modes");
  } else if (between >= timing.tick_count) {
    findings.add("time.high_mode_period_factor",
                 factor + " makes " + std::to_string(between) +
                     " ticks between two broadcasts of a high mode, and the mission has " +
                     std::to_string(timing.tick_count) +
                     ": agents send those once or twice and then know little of them",
                 "write a smaller factor or a shorter broadcast_period_ticks");
  }
}

/// Cosines do not depend on walls.
void warn_of_hidden_mass(const Mission& mission, const DensityGrid& density, Findings& findings) {
  if (mission.walls.empty() || mission.basis.free_domain) return;
  const double hidden = hidden_share(mission, density);
  if (hidden <= kMostHidden) return;
  findings.add("world.walls",
               "separate parts of the target: for " + shortest(rounded_up(100 * hidden)) +
                   " % of its pairs of places the shortest way is more than " + shortest(kDetour) +
                   " times the straight line, and the cosines of the basis ignore walls. Agents "
                   "then follow walls where they get stuck, and cover the target late",
               "write basis { free_domain: true }, open more passages, or accept it");
}

/// Lanes for even targets that a team hardly passes over, a search for those with peaks.
void warn_of_law(const Mission& mission, const DensityGrid& density, Findings& findings) {
  const LawKind advised = advised_law(mission, density);
  if (advised == mission.law.kind) return;
  const double spread = spread_share(density);
  if (advised == LawKind::kMow) {
    findings.add("law.kind",
                 "SEARCH goes from peak to peak, and this target is nearly even: with time to pass "
                 "over it " +
                     shortest(rounded_down(passes(mission, spread))) +
                     " times, agents in lanes find more",
                 "write kind: MOW, or measure both: ergocast study with --vary "
                 "law.kind=SEARCH,MOW --measure detection_probability");
  } else {
    findings.add("law.kind",
                 "MOW gives all places equal time, and this target is spread over " +
                     shortest(rounded_up(100 * spread)) + " % of the domain: a search finds more",
                 "write kind: SEARCH, or measure both: ergocast study with --vary "
                 "law.kind=SEARCH,MOW --measure detection_probability");
  }
}

}  // namespace

void warn(const Mission& mission, Findings& findings) {
  warn_of_speed_limits(mission, findings);
  warn_of_coarse_steps(mission, findings);
  warn_of_flat_weights(mission, findings);
  warn_of_short_memory(mission, findings);
  warn_of_packing(mission, findings);
  warn_of_crowded_ways_home(mission, findings);
  warn_of_tight_stations(mission, findings);
  warn_of_late_vehicles(mission, findings);
  warn_of_rare_modes(mission, findings);
}

void warn_of_target(const Mission& mission, const DensityGrid& density, Findings& findings) {
  warn_of_footprints(mission, findings);
  warn_of_hidden_mass(mission, density, findings);
  warn_of_law(mission, density, findings);
}

}  // namespace ergocast
