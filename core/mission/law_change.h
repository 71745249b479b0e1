// SPDX-License-Identifier: BSD-3-Clause
// Another speed and other noise of the law, in the place of the plan's numbers.
//
// The input stays at or below the plan's u_max_mps, so all bounds of the plan hold. Only the law
// goes by these numbers: an agent goes home, leaves a zone and rests with the plan's speed, and the
// look-ahead keeps the plan's horizon.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/base/ids.h"
#include "core/mission/mission.h"

namespace ergocast {

/// What a law change sets for one kind of agents; as in ControlLaw.
struct LawNumbers {
  double u_max_mps = 1;
  double noise_intensity = 0, noise_ceiling = 0;

  bool operator==(const LawNumbers&) const = default;
};

struct LawChange {
  std::int32_t number = 0;          ///< of the amendment
  Tick from = 0;                    ///< the world's tick from which it holds
  std::vector<LawNumbers> kinds{};  ///< of each kind; one in a mission without kinds

  bool operator==(const LawChange&) const = default;
};

/// The numbers of the plan, without number and tick.
LawChange plans_law(const Mission& mission);

/// What the law of `kind` has of these numbers: those of the change, or the plan's if there is
/// none.
LawNumbers law_numbers(const Mission& mission, int kind, const LawChange* change);
/// The law that an agent of `kind` follows under a change; null: the plan's.
ControlLaw law_of(const Mission& mission, int kind, const LawChange* change);

/// Whether the numbers are finite, there are as many as kinds, 0 < u_max ≤ the plan's, and noise is
/// at least 0. plan/mission_limits.h has the whole condition, is_law().
bool bounded_by_plan(const LawChange& change, const Mission& mission);

/// A number that identifies a law's numbers.
std::uint64_t law_hash(const LawChange& change);

/// What differs from the plan, for people: "u_max_mps 8, noise_intensity 0.1", with kinds
/// "scout: u_max_mps 8; mapper: u_max_mps 4", or "as planned".
std::string law_text(const LawChange& change, const Mission& mission);

/// The law that holds at a tick of the world; null: the plan's.
const LawChange* law_at(std::span<const LawChange> laws, Tick tick);

}  // namespace ergocast
