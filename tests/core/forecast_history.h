// SPDX-License-Identifier: BSD-3-Clause
// What one agent can know of a team, and ĉ by its formula, evaluated again from all received
// blocks.
#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/base/noise.h"
#include "core/law/forecast.h"

namespace ergocast::test {

constexpr double kDt = 0.1;
constexpr std::int64_t kManySteps = 1000000;
constexpr std::uint64_t kHistories = 60;
constexpr Tick kPeriod = 5, kEnd = 60;
const Author kSelf{0, 9};

/// 12 × 12 modes: two blocks, the second not full.
inline Mission mission_of(bool dead_reckoning) {
  Mission mission;
  mission.domain = {{-100, 30, 0}, {2000, 1000, 0}};
  mission.basis.modes_x = mission.basis.modes_y = 12;
  mission.target_coefficients = Coefficients::Zero(144);
  mission.target_coefficients[0] = 1;
  mission.target_coefficients[24] = -0.3;
  mission.law.u_max_mps = 100;
  mission.law.anticipation = 2;
  mission.timing.dt_s = kDt;
  mission.timing.tick_count = 1000;
  mission.timing.broadcast_period_ticks = kPeriod;
  mission.dead_reckoning = dead_reckoning;
  return mission;
}

/// Numbers of one history.
class Dice {
 public:
  explicit Dice(std::uint64_t history) : history_(history) {}
  std::uint64_t below(std::uint64_t limit) {
    return random_words(history_, Purpose::kFault, 2, ++throws_).first % limit;
  }
  bool one_in(std::uint64_t many) { return below(many) == 0; }
  Tick tick(Tick from, Tick until) {
    return from + static_cast<Tick>(below(static_cast<std::uint64_t>(until - from)));
  }

 private:
  std::uint64_t history_, throws_ = 0;
};

/// Where the vehicle of `agent` is.
inline Eigen::Vector3d place(AgentId agent, Tick tick, const Mission& mission) {
  return uniform_in(mission.domain, 11, Purpose::kStart, static_cast<std::uint32_t>(agent),
                    static_cast<std::uint64_t>(tick));
}

/// An agent that samples the place of its vehicle, tick by tick, and broadcasts on request.
class Life {
 public:
  Life(const Author& author, const Mission& mission)
      : author_(author), mission_(mission), own_(mission.basis, kDt) {
    own_.set_half_life(HalfLife(mission));
  }
  void cover(Tick tick) {
    own_.set_now(tick);
    own_.add_sample(author_,
                    BasisAt(place(author_.agent, tick, mission_), mission_.domain, mission_.basis));
  }
  std::vector<Contribution> blocks(Tick tick, Tick period = kPeriod) const {
    std::vector<Contribution> sent;
    for (int b = 0; b < own_.block_count(); ++b) {
      sent.push_back(own_.block(author_, b));
      sent.back().header.tick = tick;
      sent.back().next_broadcast_tick = tick + period;
    }
    return sent;
  }

 private:
  Author author_;
  const Mission& mission_;
  CoverageTable own_;
};

/// All that one agent can know at a tick.
struct Known {
  std::vector<Contribution> heard;  // in the order of arrival
  std::vector<RosterEntry> roster;  // ascending by author
  std::vector<Author> forgotten;
  std::map<AgentId, std::vector<Tick>> seen;    // ascending
  std::set<std::pair<AgentId, Tick>> charging;  // of these
  Tick joined = 0, tick = 0;
};

inline CoverageTable table_of(const Known& known, const Mission& mission) {
  CoverageTable table(mission.basis, kDt, known.joined);
  table.set_half_life(HalfLife(mission));
  // The tick comes while half of the messages are still on their way.
  std::size_t arrived = 0;
  for (const Contribution& block : known.heard) {
    if (2 * arrived++ >= known.heard.size()) table.set_now(known.tick);
    table.merge(block, kManySteps);
  }
  table.set_now(known.tick);
  for (const Author& author : known.forgotten) table.forget(author);
  return table;
}

inline Coefficients foreseen(const Known& known, const Mission& mission) {
  Forecast forecast(mission, kSelf);
  for (const auto& [agent, ticks] : known.seen) {
    for (const Tick tick : ticks)
      forecast.see(agent, tick, place(agent, tick, mission),
                   known.charging.contains({agent, tick}));
  }
  Coefficients coverage = Coefficients::Constant(144, 77);
  forecast.look_ahead(table_of(known, mission), known.roster, known.tick, coverage);
  return coverage;
}

// ---- the formula, again ----

struct Row {
  std::int64_t steps = 0, gained_steps = 0;
  double time_s = 0, gained_s = 0;  // as halved as the sums at `tick`, later as of the present tick
  Tick tick = 0, period = 0;
  std::vector<double> sums = std::vector<double>(kBlockSize), gains = sums;
};

/// What is left at tick `now` of what was covered at `tick`.
inline double left_at(Tick now, Tick tick, const Mission& mission) {
  const double half_life_s = mission.law.memory_half_life_s;
  if (half_life_s == 0) return 1;
  const auto ticks = static_cast<Tick>(std::round(half_life_s / kDt));
  const auto halvings = std::max<Tick>(now, 0) / ticks - std::max<Tick>(tick, 0) / ticks;
  return std::pow(0.5, static_cast<double>(std::clamp<Tick>(halvings, -64, 512)));
}

/// The block held of each author, and what it has gained since the one held before, as remembered
/// at the present tick.
inline std::map<std::pair<Author, int>, Row> rows_of(const Known& known, const Mission& mission) {
  std::map<std::pair<Author, int>, Row> rows;
  for (const Contribution& sent : known.heard) {
    Row& row = rows[{sent.author(), sent.block}];
    if (sent.steps <= row.steps) continue;
    const bool has_before = row.steps > 0 && row.tick >= known.joined;
    const std::int64_t before = has_before ? row.steps : 0;
    const double kept = has_before ? left_at(sent.header.tick, row.tick, mission) : 0;
    row.gained_s = sent.elapsed_s - kept * row.time_s;
    row.time_s = sent.elapsed_s;
    bool possible = row.gained_s > 0;
    for (std::size_t k = 0; k < kBlockSize; ++k) {
      row.gains[k] = sent.sums[k] - kept * row.sums[k];
      row.sums[k] = sent.sums[k];
      possible &= std::abs(row.gains[k]) < row.gained_s * (1 + 1e-6);
    }
    row.steps = sent.steps;
    row.gained_steps = possible ? sent.steps - before : 0;
    row.tick = sent.header.tick;
    row.period = sent.next_broadcast_tick - sent.header.tick;
  }
  for (auto& [key, row] : rows) {
    const double left = left_at(known.tick, row.tick, mission);
    row.time_s *= left;
    row.gained_s *= left;
    for (double& sum : row.sums) sum *= left;
    for (double& gain : row.gains) gain *= left;
  }
  return rows;
}

inline bool has_forecast(const Author& author, const Known& known) {
  const RosterEntry* own = nullptr;
  for (const RosterEntry& entry : known.roster) {
    if (entry.author == author && entry.active_at(known.tick)) own = &entry;
  }
  const auto seen = known.seen.find(author.agent);
  if (seen != known.seen.end() && known.charging.contains({author.agent, seen->second.back()}))
    return false;
  return own != nullptr && author != kSelf &&
         std::none_of(known.roster.begin(), known.roster.end(), [&](const RosterEntry& entry) {
           return entry.author.agent == author.agent && entry.active_from <= known.tick &&
                  entry.active_from > own->active_from;
         });
}

/// Where a vehicle was: the seen places at which its battery was not charged, and those on the line
/// between two of them that lack at most 8 ticks, if the first one is not from before its author
/// took part.
inline std::map<Tick, Eigen::Vector3d> places_of(AgentId id, std::vector<Tick> seen,
                                                 Tick active_from, const Known& known,
                                                 const Mission& mission) {
  std::erase_if(seen, [&](Tick tick) { return known.charging.contains({id, tick}); });
  std::map<Tick, Eigen::Vector3d> all;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    all[seen[i]] = place(id, seen[i], mission);
    if (i == 0 || seen[i - 1] < active_from || seen[i] - seen[i - 1] > 9) continue;
    const Eigen::Vector3d from_m = place(id, seen[i - 1], mission);
    const auto ticks = static_cast<double>(seen[i] - seen[i - 1]);
    for (Tick lost = 1; lost < seen[i] - seen[i - 1]; ++lost)
      all[seen[i - 1] + lost] =
          from_m + static_cast<double>(lost) / ticks * (all[seen[i]] - from_m);
  }
  return all;
}

/// Adds the places of the author's vehicle since its last broadcast.
inline void dead_reckon(const Author& author, int block, const Known& known, const Mission& mission,
                        Row& row) {
  const auto seen = known.seen.find(author.agent);
  if (seen == known.seen.end() || author.agent == kSelf.agent || row.steps == 0) return;
  const auto entry = std::find_if(known.roster.begin(), known.roster.end(),
                                  [&](const RosterEntry& one) { return one.author == author; });
  for (const auto& [tick, x_m] :
       places_of(author.agent, seen->second, entry->active_from, known, mission)) {
    if (tick < row.tick || !entry->active_at(tick)) continue;
    const Coefficients f = basis_values(x_m, mission.domain, mission.basis);
    const double left = left_at(known.tick, tick, mission);
    std::fill(row.gains.begin(), row.gains.end(), 0);
    for (int k = block * kBlockSize;
         k < std::min((block + 1) * kBlockSize, mission.basis.mode_count()); ++k) {
      const auto at = static_cast<std::size_t>(k - block * kBlockSize);
      row.gains[at] = f.data()[k] * kDt;
      if (tick > row.tick) row.sums[at] += left * f.data()[k] * kDt;
    }
    row.gained_steps = 1;
    row.gained_s = kDt;
    if (tick > row.tick) row.time_s += left * kDt;
    row.tick = tick;
  }
}

inline double weight_s(const Row& row, double horizon_s, Tick now) {
  const double cap_s = 8 * kDt * static_cast<double>(std::min(row.period, kPeriod));
  const double age_s = kDt * static_cast<double>(now - row.tick);
  if (age_s > std::max(horizon_s, cap_s)) return 0;
  return horizon_s + std::min(kDt * static_cast<double>(row.gained_steps), cap_s) + age_s;
}

inline Coefficients by_the_formula(const Known& known, const Mission& mission) {
  const Eigen::Matrix3d covariance_m2 =
      target_covariance_m2(mission.target_coefficients, mission.basis, mission.domain);
  const double spread_m = target_spread_m(covariance_m2);
  const double dimensions = shared_dimensions(covariance_m2);
  Coefficients foreseen = Coefficients::Zero(144);
  auto rows = rows_of(known, mission);
  for (int b = 0; b < 2; ++b) {
    int n = 1;
    std::vector<Row*> counting, with_forecast;
    for (auto& [key, row] : rows) {
      const auto& [author, block] = key;
      const bool forgotten = std::count(known.forgotten.begin(), known.forgotten.end(), author) > 0;
      if (block != b || forgotten) continue;
      counting.push_back(&row);
      if (!has_forecast(author, known)) continue;
      if (mission.dead_reckoning) dead_reckon(author, b, known, mission, row);
      if (row.gained_steps == 0) continue;
      with_forecast.push_back(&row);
      ++n;
    }
    const double horizon_s = mission.law.anticipation * spread_m * std::sqrt(dimensions / 2) /
                             (mission.law.u_max_mps * std::pow(n, 1 / dimensions));
    for (int k = b * kBlockSize; k < std::min((b + 1) * kBlockSize, 144); ++k) {
      const auto at = static_cast<std::size_t>(k - b * kBlockSize);
      double above = 0, below_s = 0;
      for (const Row* row : counting) {
        above += row->sums[at];
        below_s += row->time_s;
      }
      for (const Row* row : with_forecast) {
        const double w_s = weight_s(*row, horizon_s, known.tick);
        above += w_s * row->gains[at] / row->gained_s;
        below_s += w_s;
      }
      if (below_s > 0) foreseen.data()[k] = above / below_s;
    }
  }
  return foreseen;
}

// ---- teams ----

inline RosterEntry entry_of(const Author& author, Tick from, Tick until = -1) {
  return {author, from, until};
}

/// The messages of a team of `agents` that has broadcast everything at each of the ticks 0 … kEnd −
/// 1.
inline std::vector<Contribution> told_each_tick(int agents, const Mission& mission,
                                                Tick every = 1) {
  std::vector<Contribution> sent;
  std::vector<Life> incarnations;
  for (AgentId id = 0; id < agents; ++id)
    incarnations.emplace_back(id == 0 ? kSelf : Author{id, 1}, mission);
  for (Tick tick = 0; tick < kEnd; ++tick) {
    for (Life& life : incarnations) {
      life.cover(tick);
      if (tick % every != 0) continue;
      for (const Contribution& block : life.blocks(tick)) sent.push_back(block);
    }
  }
  return sent;
}

inline Known team_of(int agents, const Mission& mission, Tick every = 1) {
  Known known;
  known.heard = told_each_tick(agents, mission, every);
  for (AgentId id = 0; id < agents; ++id) {
    known.roster.push_back(entry_of(id == 0 ? kSelf : Author{id, 1}, 0));
  }
  known.tick = kEnd - 1;
  return known;
}

}  // namespace ergocast::test
