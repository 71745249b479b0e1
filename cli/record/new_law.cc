// SPDX-License-Identifier: BSD-3-Clause
// Sets each number for its kinds, then looks for the limit that one breaks.
#include "cli/record/new_law.h"

#include <algorithm>
#include <cmath>

#include "core/mission/kinds.h"
#include "core/motion/vehicle.h"
#include "plan/mission_limits.h"
#include "text/read_number.h"
#include "text/shortest.h"

namespace ergocast::cli {
namespace {

constexpr std::string_view kSpeed = "u_max_mps", kFloor = "noise_intensity",
                           kCeiling = "noise_ceiling";

double* number_of(LawNumbers& numbers, std::string_view field) {
  if (field == kSpeed) return &numbers.u_max_mps;
  if (field == kFloor) return &numbers.noise_intensity;
  return field == kCeiling ? &numbers.noise_ceiling : nullptr;
}

/// " of kind scout", or nothing in a mission without kinds.
std::string of_kind(const Mission& mission, int kind) {
  const std::string& name = name_of_kind(mission, kind);
  return name.empty() ? "" : " of kind " + name;
}

/// Why this wish cannot be fulfilled; nothing if it can.
std::optional<std::string> why_impossible(const Mission& mission, const LawWish& wish) {
  LawNumbers any;
  const auto has = [&](const AgentKind& kind) { return kind.name == wish.kind; };
  if (number_of(any, wish.field) == nullptr)
    return "only u_max_mps, noise_intensity and noise_ceiling of a running mission can be changed: "
           "name one of these";
  if (!wish.kind.empty() && std::ranges::none_of(mission.kinds, has))
    return "the mission has no kind \"" + wish.kind + "\": name one of its kinds, or none";
  if (wish.field == kCeiling && mission.law.perturbation == Perturbation::kConstant)
    return "noise_ceiling has no effect with perturbation CONSTANT: set noise_intensity";
  if (wish.field != kSpeed) return std::nullopt;
  double most_mps = 0;
  for (int kind = 0; kind < std::ssize(plans_law(mission).kinds); ++kind)
    if (wish.kind.empty() || name_of_kind(mission, kind) == wish.kind)
      most_mps = std::max(most_mps, law_of(mission, kind).u_max_mps);
  if (wish.value > 0 && wish.value <= most_mps) return std::nullopt;
  return "a speed is above 0 and at most that of the plan, " + shortest(most_mps) +
         " m/s: name such a speed";
}

/// Which limit a kind's law breaks; nothing if none.
std::optional<std::string> why_no_law(const Mission& mission, int kind, const LawChange& change) {
  const ControlLaw law = law_of(mission, kind, &change);
  const std::string whose = of_kind(mission, kind);
  const double most = mission.domain.shortest_side_m() / std::sqrt(mission.timing.dt_s);
  for (const double noise : {law.noise_intensity, law.noise_ceiling})
    if (!(noise >= 0 && noise <= std::min(most, limits::kIntensity.high)))
      return "noise" + whose + " is from 0 to " +
             shortest(std::min(most, limits::kIntensity.high)) +
             " m/sqrt(s), so that no step is longer than the domain: name such a noise";
  if (law.perturbation == Perturbation::kAdaptive && law.noise_ceiling < law.noise_intensity)
    return "noise_ceiling" + whose + ", " + shortest(law.noise_ceiling) +
           ", is below noise_intensity, " + shortest(law.noise_intensity) + ": set both";
  const double pull_mps =
      law.contraction_gain_per_s * mission.domain.farthest_distance_m(law.contraction_center_m);
  if (law.u_max_mps < pull_mps)
    return "u_max_mps" + whose + " is too weak for the contraction, which needs " +
           shortest(pull_mps) + " m/s at the domain's farthest corner: name at least that speed";
  const double least_mps = motion_of_kind(mission, kind).vehicle.min_speed_mps;
  if (least_mps > 0 && law.u_max_mps <= least_mps)
    return "a fixed wing" + whose + " is never slower than " + shortest(least_mps) +
           " m/s: name a greater speed";
  return std::nullopt;
}

}  // namespace

std::optional<LawWish> law_wish_from(std::string_view text) {
  LawWish wish{.written = std::string(text)};
  const std::size_t equals = text.find('=');
  if (equals == std::string_view::npos) return std::nullopt;
  const auto value = read_number<double>(text.substr(equals + 1));
  if (!value || !std::isfinite(*value)) return std::nullopt;
  wish.value = *value;
  const std::string_view path = text.substr(0, equals);
  const std::size_t dot = path.rfind('.');
  wish.field = path.substr(dot == std::string_view::npos ? 0 : dot + 1);
  if (dot != std::string_view::npos && path.substr(0, dot) != "law")
    wish.kind = path.substr(0, dot);
  if (wish.field.empty() || dot == 0) return std::nullopt;
  return wish;
}

Result<LawChange, std::string> law_with(const Mission& mission, const LawChange& holds,
                                        std::span<const LawWish> wishes) {
  LawChange change{.kinds = holds.kinds};
  for (const LawWish& wish : wishes) {
    if (const auto problem = why_impossible(mission, wish))
      return failure("\"" + wish.written + "\": " + *problem);
    for (int kind = 0; kind < std::ssize(change.kinds); ++kind) {
      if (!wish.kind.empty() && name_of_kind(mission, kind) != wish.kind) continue;
      double value = wish.value;
      if (wish.field == kSpeed) value = std::min(value, law_of(mission, kind).u_max_mps);
      *number_of(change.kinds[static_cast<std::size_t>(kind)], wish.field) = value;
    }
  }
  for (int kind = 0; kind < std::ssize(change.kinds); ++kind)
    if (const auto problem = why_no_law(mission, kind, change)) return failure(*problem);
  if (is_law(change, mission)) return change;
  return failure(std::string("a scenario with these numbers would be refused: name others"));
}

LawChange newest_law(const Mission& mission, std::span<const LawChange> laws) {
  return laws.empty() ? plans_law(mission) : laws.back();
}

}  // namespace ergocast::cli
