// SPDX-License-Identifier: BSD-3-Clause
// What one agent knows, as seen from outside, and how a violation names it.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <sstream>
#include <string>
#include <vector>

#include "core/base/ids.h"
#include "core/base/portable_math.h"
#include "core/basis/basis.h"
#include "core/law/coverage_table.h"
#include "core/mission/mission.h"
#include "core/search/efforts.h"
#include "team/messages.h"

namespace ergocast::lab {

struct TableView {
  Author self;
  const CoverageTable* table = nullptr;              ///< null: it is not admitted
  const Coefficients* coverage = nullptr;            ///< its c_k, as of `answered`
  const std::vector<RosterEntry>* roster = nullptr;  ///< in ticks that count
  Tick answered = -1;
  std::int64_t roster_revision = 0;        ///< the revision that the world uses for this tick
  const Coefficients* foreseen = nullptr;  ///< its ĉ_k, as of `answered`, where its law looks ahead
  std::span<const Hold> holds{};           ///< the holds that the agent knows
  const Amendments* amendments = nullptr;  ///< the list that the agent knows; null: empty
  Tick counted = -1;                       ///< the number of `answered` among ticks that count
  const Efforts* efforts = nullptr;        ///< where the team has searched; null: it does not
  bool held = false;                       ///< whether `answered` does not count
};

/// How far a sum of `steps` terms ≤ dt may be from the exact one, relative.
inline double rounding(std::int64_t steps) { return 1e-12 + static_cast<double>(steps) * 0x1p-53; }

/// How often coverage has been halved by the sample of a counted tick.
inline Tick halvings_at(const Mission& mission, Tick counted) {
  if (mission.law.memory_half_life_s <= 0) return 0;
  const double ticks = std::round(mission.law.memory_half_life_s / mission.timing.dt_s);
  return std::max<Tick>(0, counted) / std::max<Tick>(1, static_cast<Tick>(ticks));
}
/// What is left of coverage after so many halvings more.
inline double left_after(Tick halvings) {
  return portable::pow(0.5, static_cast<double>(halvings));
}

inline std::int64_t steps_of(const CoverageTable& table, const Author& author) {
  return table.steps_held(author).value_or(0);
}

/// Null if it is not in this roster.
inline const RosterEntry* entry_of(const std::vector<RosterEntry>& roster, const Author& author) {
  const auto at = std::find_if(roster.begin(), roster.end(),
                               [&](const RosterEntry& entry) { return entry.author == author; });
  return at == roster.end() ? nullptr : &*at;
}

/// An agent always counts its own row, whatever others know of it.
inline bool is_forgotten(const RosterEntry& entry, const TableView& by) {
  return entry.author != by.self && entry.forgotten_at(by.answered, by.roster_revision);
}

/// Whether the agent rests because it was recalled, by the roster that `by` knows.
inline bool is_recalled(const RosterEntry& entry, const TableView& by) {
  return entry.recall_revision >= 0 && by.roster_revision >= entry.recall_revision;
}

/// The number of ticks that the mission has by the newest end of a list; null: by its plan.
inline Tick ticks_of(const Mission& mission, const Amendments* list) {
  return list == nullptr || list->ends.empty() ? mission.timing.tick_count
                                               : list->ends.back().tick_count;
}

/// The same by the end that holds at a counted tick.
inline Tick ticks_at(const Mission& mission, const Amendments* list, Tick counted) {
  Tick ticks = mission.timing.tick_count;
  if (list == nullptr) return ticks;
  for (const EndChange& end : list->ends)
    if (counted_ticks(list->holds, end.from) <= counted) ticks = end.tick_count;
  return ticks;
}

/// The numbers of the law of a kind that hold at a tick of the world; null: the plan's.
inline const LawNumbers* law_numbers_at(const Amendments* list, int kind, Tick tick) {
  const LawNumbers* numbers = nullptr;
  if (list == nullptr) return numbers;
  for (const LawChange& law : list->laws)
    if (law.from <= tick) numbers = &law.kinds.at(static_cast<std::size_t>(kind));
  return numbers;
}

/// The first tick, of those that count, at which an agent with a station covers no more, by the
/// ends that hold at a counted tick; the greatest number without a station. An agent that rests
/// when another end begins to hold goes on resting.
inline Tick covers_until(const Mission& mission, AgentId id, const Amendments* list = nullptr,
                         Tick counted = std::numeric_limits<Tick>::max()) {
  for (const AgentKind& kind : mission.kinds) {
    if (id < kind.count && kind.stations_m.empty()) break;
    if (id < kind.count) {
      Tick reserve = 0;
      while (static_cast<double>(reserve) * mission.timing.dt_s < kind.reserve_s * (1 - 1e-9))
        ++reserve;
      Tick until = mission.timing.tick_count - reserve;
      if (list == nullptr) return until;
      for (const EndChange& end : list->ends) {
        const Tick from = counted_ticks(list->holds, end.from);
        if (from <= counted && from < until) until = end.tick_count - reserve;
      }
      return until;
    }
    id -= kind.count;
  }
  return std::numeric_limits<Tick>::max();
}

inline std::string name_of(const Author& author) {
  return "agent " + std::to_string(author.agent) + " (" + to_hex(author.incarnation) + ")";
}

template <class... Parts>
std::string text(const Parts&... parts) {
  std::ostringstream out;
  out.precision(17);
  (out << ... << parts);
  return out.str();
}

}  // namespace ergocast::lab
