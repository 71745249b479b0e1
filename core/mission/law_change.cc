// SPDX-License-Identifier: BSD-3-Clause
// Puts the numbers of a change in the place of the plan's, kind by kind.
#include "core/mission/law_change.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>

#include "core/mission/kinds.h"

namespace ergocast {
namespace {

int kind_count(const Mission& mission) {
  return std::max(1, static_cast<int>(mission.kinds.size()));
}

LawNumbers numbers_of(const ControlLaw& law) {
  return {law.u_max_mps, law.noise_intensity, law.noise_ceiling};
}

/// ", u_max_mps 8" if it is not the plan's.
std::string difference(const char* name, double value, double plans) {
  char text[60];
  std::snprintf(text, sizeof text, ", %s %.6g", name, value);
  return value == plans ? "" : text;
}

}  // namespace

LawChange plans_law(const Mission& mission) {
  LawChange plans;
  for (int kind = 0; kind < kind_count(mission); ++kind)
    plans.kinds.push_back(numbers_of(law_of(mission, kind)));
  return plans;
}

LawNumbers law_numbers(const Mission& mission, int kind, const LawChange* change) {
  const auto at = static_cast<std::size_t>(std::max(0, kind));
  if (change != nullptr && at < change->kinds.size()) return change->kinds[at];
  return numbers_of(law_of(mission, kind));
}

ControlLaw law_of(const Mission& mission, int kind, const LawChange* change) {
  ControlLaw law = law_of(mission, kind);
  const LawNumbers numbers = law_numbers(mission, kind, change);
  law.u_max_mps = numbers.u_max_mps;
  law.noise_intensity = numbers.noise_intensity;
  law.noise_ceiling = numbers.noise_ceiling;
  return law;
}

bool bounded_by_plan(const LawChange& change, const Mission& mission) {
  if (std::ssize(change.kinds) != kind_count(mission)) return false;
  for (int kind = 0; kind < kind_count(mission); ++kind) {
    const LawNumbers& numbers = change.kinds[static_cast<std::size_t>(kind)];
    const bool bounded = numbers.u_max_mps > 0 &&
                         numbers.u_max_mps <= law_of(mission, kind).u_max_mps &&
                         numbers.noise_intensity >= 0 && std::isfinite(numbers.noise_intensity) &&
                         numbers.noise_ceiling >= 0 && std::isfinite(numbers.noise_ceiling);
    if (!bounded) return false;
  }
  return true;
}

std::uint64_t law_hash(const LawChange& change) {
  std::uint64_t hash = 3;
  for (const LawNumbers& one : change.kinds) {
    for (const double value : {one.u_max_mps, one.noise_intensity, one.noise_ceiling}) {
      hash = (hash ^ std::bit_cast<std::uint64_t>(value)) * 0x9e3779b97f4a7c15;
      hash ^= hash >> 29;
    }
  }
  return hash;
}

std::string law_text(const LawChange& change, const Mission& mission) {
  std::string text;
  for (int kind = 0; kind < std::ssize(change.kinds); ++kind) {
    const LawNumbers& now = change.kinds[static_cast<std::size_t>(kind)];
    const LawNumbers plans = numbers_of(law_of(mission, kind));
    const std::string all =
        difference("u_max_mps", now.u_max_mps, plans.u_max_mps) +
        difference("noise_intensity", now.noise_intensity, plans.noise_intensity) +
        difference("noise_ceiling", now.noise_ceiling, plans.noise_ceiling);
    if (all.empty()) continue;
    const std::string& name = name_of_kind(mission, kind);
    text += (text.empty() ? "" : "; ") + (name.empty() ? "" : name + ": ") + all.substr(2);
  }
  return text.empty() ? "as planned" : text;
}

const LawChange* law_at(std::span<const LawChange> laws, Tick tick) {
  const auto found = std::find_if(laws.rbegin(), laws.rend(),
                                  [tick](const LawChange& change) { return change.from <= tick; });
  return found == laws.rend() ? nullptr : &*found;
}

}  // namespace ergocast
