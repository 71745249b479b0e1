// SPDX-License-Identifier: BSD-3-Clause
// Checks what agents hold, what they compute from it, and what they learn from each other.
#include <algorithm>
#include <cmath>

#include "core/law/look_ahead.h"
#include "core/mission/kinds.h"
#include "lab/invariants.h"

namespace ergocast::lab {
namespace {

/// Not a multiple of a usual period, so that blocks of every age are checked.
constexpr Tick kTicksBetweenAverages = 11;

}  // namespace

// ---- safety: what is known ----

void Invariants::received(const TableView& listener, const Message& message) {
  if (listener.table == nullptr) return;
  if (std::holds_alternative<MissionPart>(message)) {
    const RosterEntry* own = entry_of(*listener.roster, listener.self);
    if (own == nullptr) return;
    const auto shadow = shadows_.try_emplace(listener.self, own->active_from).first;
    if (listener.amendments != nullptr) shadow->second.note_targets(mission_, *listener.amendments);
    return;
  }
  if (!looks_ahead(mission_)) return;
  const bool is_block = std::holds_alternative<Contribution>(message);
  if (!is_block && !std::holds_alternative<WorldState>(message)) return;
  shadows_.at(listener.self).receive(mission_, listener, message);
}

void Invariants::answered(double t_s, const TableView& holder,
                          const std::optional<Eigen::Vector3d>& x_m) {
  check_steps(t_s, holder);
  if (x_m) check_sample(t_s, holder, *x_m);
  const bool looks_ahead =
      ergocast::looks_ahead(mission_) && holder.foreseen != nullptr && !holder.held;
  if (looks_ahead) shadows_.at(holder.self).answer(mission_, holder);
  // This costs as much as the control step itself. Every few ticks is enough to find a lasting
  // error.
  if (holder.answered % kTicksBetweenAverages != 0) return;
  check_average(t_s, holder);
  check_looks(t_s, holder);
  if (looks_ahead) check_forecast(t_s, holder);
}

void Invariants::check_sample(double t_s, const TableView& holder, const Eigen::Vector3d& x_m) {
  const double error_s = shadows_.at(holder.self).sample_error_s(mission_, holder, x_m);
  const double covered_s = static_cast<double>(last_tick_ + 1) * mission_.timing.dt_s;
  if (error_s <= kShiftedRange * covered_s * rounding(last_tick_)) return;
  violate(t_s, Invariant::kSamplesAreTrue, name_of(holder.self),
          text("differs by ", error_s, " s at tick ", holder.answered));
}

void Invariants::check_steps(double t_s, const TableView& holder) {
  auto& held_before = held_[holder.self];
  std::map<AgentId, std::int64_t> steps_of_id;
  for (const Author& author : authors_) {
    const std::int64_t steps = steps_of(*holder.table, author);
    std::int64_t& before = held_before[author];
    if (steps < before) {
      violate(t_s, Invariant::kHeldNeverShrinks, name_of(holder.self),
              text(before, " steps of ", name_of(author), " became ", steps));
    }
    before = steps;
    steps_of_id[author.agent] += steps;
  }
  // In real time an agent that does not know of a pause yet continues to sample.
  const bool exact = mission_.timing.pace == Pace::kLockstep;
  const Tick counted = counted_ticks(truth_.holds(), last_tick_ + 1);
  const Tick unknown = exact ? 0 : last_tick_ + 1 - counted;
  for (const auto& [id, steps] : steps_of_id) {
    // A process that is replaced within a tick may have sampled it, too.
    const std::int64_t most = std::min(counted, covers_until(mission_, id, &truth_.amendments())) +
                              unknown + incarnation_count_[id] - 1;
    if (steps <= most) continue;
    violate(t_s, Invariant::kNoStepCountsTwice, name_of(holder.self),
            text("holds ", steps, " steps of agent ", id, " in all, ", most, " are possible"));
  }
}

void Invariants::check_average(double t_s, const TableView& holder) {
  const Coefficients expected = average_of(best_of({holder}));
  const double error = (*holder.coverage - expected).cwiseAbs().maxCoeff();
  if (error > rounding(last_tick_ * static_cast<std::int64_t>(authors_.size()))) {
    violate(t_s, Invariant::kAverageOfWhatIsHeld, name_of(holder.self),
            text("differs by ", error, " at tick ", holder.answered));
  }
  // A newcomer covers nothing itself while the mission is paused, nor before its own first tick, to
  // which a restarted world may go back.
  if (holder.held) return;
  // One that has rested since its admission covers nothing, and may have received nothing yet.
  const RosterEntry* const own = entry_of(*holder.roster, holder.self);
  const bool rests = own != nullptr && is_recalled(*own, holder);
  if (rests && holder.table->covered_s() == 0) return;
  const auto shadow = shadows_.find(holder.self);
  if (shadow != shadows_.end() && holder.counted < shadow->second.active_from()) return;
  const double c_00 = (*holder.coverage)[0];
  if (std::abs(c_00 - 1) > rounding(last_tick_)) {
    violate(t_s, Invariant::kZerothIsOne, name_of(holder.self), text("c_00 = ", c_00));
  }
}

void Invariants::check_forecast(double t_s, const TableView& holder) {
  const Coefficients expected = shadows_.at(holder.self).foreseen(mission_, holder);
  const double error = (*holder.foreseen - expected).cwiseAbs().maxCoeff();
  if (error <= rounding(last_tick_ * static_cast<std::int64_t>(authors_.size()))) return;
  violate(t_s, Invariant::kForecastOfWhatIsKnown, name_of(holder.self),
          text("differs by ", error, " at tick ", holder.answered));
}

// ---- liveness ----

/// The newest of each author's blocks that any agent holds and counts: a forgotten row does not
/// count any more, nor does a teammate's that the holder's roster lacks.
std::map<Author, std::vector<Invariants::Best>> Invariants::best_of(
    const std::vector<TableView>& living) const {
  std::map<Author, std::vector<Best>> best;
  for (const TableView& holder : living) {
    if (holder.table == nullptr) continue;
    for (const Author& author : authors_) {
      if (!holder.table->steps_held(author)) continue;
      const RosterEntry* entry = entry_of(*holder.roster, author);
      if (entry == nullptr ? author != holder.self : is_forgotten(*entry, holder)) continue;
      auto& blocks = best.try_emplace(author, static_cast<std::size_t>(block_count_)).first->second;
      for (int b = 0; b < block_count_; ++b) {
        const Contribution held = holder.table->block(author, b);
        Best& known = blocks[static_cast<std::size_t>(b)];
        if (held.steps > known.steps)
          known = {held.steps, held.sums, held.elapsed_s, halvings_at(mission_, held.header.tick)};
      }
    }
  }
  return best;
}

/// The plan decides: in the laboratory no agent brings a kind of its own.
double Invariants::quality_of(const Author& author) const {
  if (mission_.kinds.empty()) return 1;
  return mission_.kinds[static_cast<std::size_t>(planned_kind(mission_, author.agent))].quality;
}

/// The time that a block covered when it was sent.
double Invariants::remembered_s(const Best& block) const {
  if (mission_.law.memory_half_life_s > 0) return block.elapsed_s;
  return static_cast<double>(block.steps) * mission_.timing.dt_s;
}

Tick Invariants::most_halvings(const std::map<Author, std::vector<Best>>& rows) const {
  Tick most = 0;
  for (const auto& [author, blocks] : rows) {
    for (const Best& block : blocks) most = std::max(most, block.halvings);
  }
  return most;
}

/// (4) from the blocks alone, weighted by quality and by the time that each covers.
Coefficients Invariants::average_of(const std::map<Author, std::vector<Best>>& rows) const {
  Coefficients c = Coefficients::Zero(mission_.basis.mode_count());
  const Tick most = most_halvings(rows);
  for (std::size_t b = 0; b < wire_modes_.size(); ++b) {
    for (std::size_t i = 0; i < wire_modes_[b].size(); ++i) {
      double sum_s = 0, time_s = 0;
      for (const auto& [author, blocks] : rows) {
        const double weight = quality_of(author) * left_after(most - blocks[b].halvings);
        sum_s += weight * blocks[b].sums[i];
        time_s += weight * remembered_s(blocks[b]);
      }
      if (time_s > 0) c.data()[wire_modes_[b][i]] = sum_s / time_s;
    }
  }
  return c;
}

void Invariants::recovered(double t_s, const std::vector<TableView>& living) {
  for (const TableView& holder : living) {
    if (holder.table != nullptr && holder.answered >= 0) continue;
    return violate(t_s, Invariant::kEverybodyIsBack, name_of(holder.self),
                   holder.table == nullptr ? "is not admitted" : "has seen no tick");
  }
  for (const TableView& holder : living) check_counted(t_s, holder, living);
  const auto best = best_of(living);
  const Coefficients c_true = average_of(best);
  compare_views(living);
  for (const TableView& holder : living) {
    if (mission_.radio_range_m <= 0) check_rows(t_s, holder, best);
    check_view(t_s, holder, best, c_true);
  }
  if (mission_.radio_range_m > 0) check_neighbours(t_s, living);
  check_quiet(t_s);
}

void Invariants::check_counted(double t_s, const TableView& holder,
                               const std::vector<TableView>& living) {
  for (const TableView& other : living) {
    const RosterEntry* entry = entry_of(*holder.roster, other.self);
    if (entry == nullptr || !is_forgotten(*entry, holder)) continue;
    violate(t_s, Invariant::kLiveAgentsCount, name_of(holder.self),
            text("leaves out what ", name_of(other.self), " covers at tick ", holder.answered));
  }
}

void Invariants::compare_views(const std::vector<TableView>& living) {
  const Coefficients c_true = average_of(best_of(living));
  largest_view_error_ = 0;
  for (const TableView& holder : living) {
    if (holder.coverage == nullptr || holder.answered < 0) continue;
    const Coefficients difference = *holder.coverage - c_true;
    largest_view_error_ = std::max(
        largest_view_error_, std::sqrt((weights_.array() * difference.array().square()).sum()));
  }
}

void Invariants::check_view(double t_s, const TableView& holder,
                            const std::map<Author, std::vector<Best>>& best,
                            const Coefficients& c_true) {
  double stale_s = 0, covered_s = 0;
  const Tick most_halved = most_halvings(best);
  for (const auto& [author, blocks] : best) {
    const double weight_s = quality_of(author) * mission_.timing.dt_s;
    covered_s += quality_of(author) * remembered_s(blocks.front()) *
                 left_after(most_halved - blocks.front().halvings);
    const RosterEntry* entry = entry_of(*holder.roster, author);
    if (mission_.radio_range_m > 0) {
      const std::int64_t lacks = blocks.front().steps - steps_of(*holder.table, author);
      stale_s += static_cast<double>(std::max<std::int64_t>(lacks, 0)) * weight_s;
      continue;
    }
    if (entry == nullptr || entry->active_until >= 0 || is_recalled(*entry, holder)) continue;
    // Two periods until a digest asks for it, and two ticks on the way.
    const Tick period = holder.table->announced_period(author);
    stale_s += static_cast<double>(2 * period + 2) * weight_s;
  }
  // This is c_k of what it holds now, because an agent without ticks computes none.
  Coefficients c = Coefficients::Zero(mission_.basis.mode_count());
  holder.table->average(c);
  const double error = (c - c_true).cwiseAbs().maxCoeff();
  if (covered_s <= stale_s) return;
  // One holder may have the author's own sums of a row, and another the sums that have travelled.
  const double range = holder.table->allows_shifts() ? kShiftedRange : 1;
  const double most =
      range * (2 * stale_s / (covered_s - stale_s) +
               2 * rounding_of(mission_.timing.contribution_encoding) + rounding(last_tick_));
  if (error <= most) return;
  violate(t_s, Invariant::kViewsAgree, name_of(holder.self),
          text("|c - c_true| = ", error, " > ", most, " with ", stale_s, " s of ", covered_s,
               " s unknown"));
}

void Invariants::check_rows(double t_s, const TableView& holder,
                            const std::map<Author, std::vector<Best>>& best) {
  for (const auto& [author, blocks] : best) {
    const auto newest =
        std::min_element(blocks.begin(), blocks.end(), [](const Best& a, const Best& b) {
          return a.steps < b.steps;
        })->steps;
    const RosterEntry* entry = entry_of(*holder.roster, author);
    // The coordinator stopped before it sent this admission to any other process: no member.
    if (entry == nullptr) continue;
    const bool speaks = entry->active_until < 0 && !is_recalled(*entry, holder);
    const Tick period = holder.table->announced_period(author);
    const std::int64_t tolerated = speaks ? 2 * period + 2 : 0;
    const std::int64_t held = steps_of(*holder.table, author);
    if ((held > 0 || newest == 0) && held + tolerated >= newest) continue;
    violate(t_s, Invariant::kEverybodyLearnsEveryRow, name_of(holder.self),
            text("holds ", held, " of ", newest, " steps of ", name_of(author),
                 speaks ? ", a member" : ", which has left or rests"));
  }
}

/// What an agent held is known to others after a round of digests for each hop between them.
void Invariants::check_neighbours(double t_s, const std::vector<TableView>& living) {
  Memory& present = memories_.emplace_back(Memory{t_s, {}});
  for (const TableView& holder : living) {
    for (const Author& author : authors_)
      present.held[holder.self][author] = steps_of(*holder.table, author);
  }
  std::size_t entries = 0;
  for (const TableView& holder : living) entries = std::max(entries, holder.roster->size());
  for (int hops = 1; hops < static_cast<int>(living.size()); ++hops) {
    const double takes_s = hops * hop_s(entries);
    const auto past = std::find_if(memories_.rbegin(), memories_.rend(), [&](const Memory& memory) {
      return memory.t_s <= t_s - takes_s;
    });
    if (past == memories_.rend()) return;
    for (const TableView& holder : living) {
      for (const Author& other : within(hops, holder.self, t_s - past->t_s, t_s, living)) {
        check_learned(t_s, holder, other, past->held[other], hops);
      }
    }
  }
}

/// The authors from which `self` has received for `heard_for_s` without a break, over at most
/// `hops` hops.
std::set<Author> Invariants::within(int hops, const Author& self, double heard_for_s, double t_s,
                                    const std::vector<TableView>& living) const {
  const auto receives = [&](const Author& a, const Author& b) {
    const auto apart = last_apart_t_s_.find(std::minmax(a.agent, b.agent));
    return apart == last_apart_t_s_.end() || t_s - apart->second > heard_for_s;
  };
  std::set<Author> reached{self};
  for (int hop = 0; hop < hops; ++hop) {
    const std::set<Author> inner = reached;
    for (const TableView& holder : living) {
      const auto heard = [&](const Author& one) { return receives(one, holder.self); };
      if (std::any_of(inner.begin(), inner.end(), heard)) reached.insert(holder.self);
    }
  }
  return reached;
}

void Invariants::check_learned(double t_s, const TableView& holder, const Author& other,
                               const std::map<Author, std::int64_t>& held_then, int hops) {
  for (const auto& [author, then] : held_then) {
    const RosterEntry* entry = entry_of(*holder.roster, author);
    if (entry == nullptr || author == holder.self) continue;
    // No agent repeats what a running author will soon send itself, so each hop adds a slack.
    const Tick period = holder.table->announced_period(author);
    const std::int64_t tolerated = entry->active_until < 0 ? hops * (2 * period + 2) : 0;
    const std::int64_t held = steps_of(*holder.table, author);
    if (held + tolerated >= then) continue;
    violate(t_s, Invariant::kEverybodyLearnsEveryRow, name_of(holder.self),
            text("holds ", held, " steps of ", name_of(author), ", of which ", name_of(other), ", ",
                 hops, " hops away, has long held ", then));
  }
}

}  // namespace ergocast::lab
