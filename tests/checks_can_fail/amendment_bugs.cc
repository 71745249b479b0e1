// SPDX-License-Identifier: BSD-3-Clause
// Bugs of new targets, other ends, other laws, and of what undoes them.
#include <map>
#include <span>
#include <utility>

#include "core/law/coverage_table.h"
#include "core/law/target_shift.h"
#include "core/mission/end_by_finding.h"
#include "core/mission/end_schedule.h"
#include "core/mission/law_change.h"
#include "core/motion/end_rules.h"
#include "tests/checks_can_fail/bugs.h"

namespace ergocast {

// clang-format off
WRAPPED(void, note_targets, "_ZN8ergocast11TargetShift4noteERKNS_10AmendmentsE", TargetShift*, const Amendments&)
WRAPPED(void, shift_sample, "_ZN8ergocast13CoverageTable12shift_sampleERKNS_6AuthorEPKd", CoverageTable*, const Author&, const double*)
WRAPPED(void, note_ends, "_ZN8ergocast11EndSchedule4noteESt4spanIKNS_4HoldELm18446744073709551615EES1_IKNS_9EndChangeELm18446744073709551615EE", EndSchedule*, std::span<const Hold>, std::span<const EndChange>)
WRAPPED(EndProblem, end_problem, "_ZN8ergocast8EndRules7problemERKNS_7MissionERKNS_10AmendmentsElllSt4spanIKNS_10AgentPlaceELm18446744073709551615EE", EndRules*, const Mission&, const Amendments&, Tick, Tick, Tick, std::span<const AgentPlace>)
WRAPPED(void, set_rest, "_ZN8ergocast7WayHome8set_restEl", WayHome*, Tick)
WRAPPED(const LawChange*, law_at, "_ZN8ergocast6law_atESt4spanIKNS_9LawChangeELm18446744073709551615EEl", std::span<const LawChange>, Tick)
WRAPPED(LawNumbers, law_numbers, "_ZN8ergocast11law_numbersERKNS_7MissionEiPKNS_9LawChangeE", const Mission&, int, const LawChange*)
WRAPPED(bool, lacks_end_by_finding, "_ZN8ergocast20lacks_end_by_findingERKNS_7MissionERKNS_10AmendmentsEil", const Mission&, const Amendments&, int, Tick)
// clang-format on

namespace {

/// The targets that were first named for each tick.
std::map<std::pair<const TargetShift*, Tick>, TargetChange> first_named;

/// Without the newest, if another one is before it.
template <class Change>
std::span<const Change> without_newest(std::span<const Change> changes) {
  return changes.size() > 1 ? changes.first(changes.size() - 1) : changes;
}

}  // namespace

void bug_note_targets(TargetShift* self, const Amendments& list) {
  Amendments changed = list;
  if (bug("a pause does not delay a target")) changed.holds.clear();
  if (bug("a target holds a tick late")) {
    for (TargetChange& change : changed.targets) ++change.from;
  }
  if (bug("a target that is undone before its tick holds"))
    for (TargetChange& change : changed.targets)
      change = first_named.try_emplace({self, change.from}, change).first->second;
  real_note_targets(self, changed);
}

void bug_shift_sample(CoverageTable* self, const Author& author, const double* shift) {
  if (bug("one agent keeps to the plan's target") && author.agent == 0) return;
  real_shift_sample(self, author, shift);
  if (bug("a target counts twice")) real_shift_sample(self, author, shift);
}

void bug_note_ends(EndSchedule* self, std::span<const Hold> holds,
                   std::span<const EndChange> ends) {
  if (bug("agents go by the plan's end")) ends = {};
  if (bug("agents go by an end that is undone")) ends = without_newest(ends);
  real_note_ends(self, holds, ends);
}

EndProblem bug_end_problem(EndRules* self, const Mission& mission, const Amendments& list,
                           Tick tick, Tick from, Tick tick_count,
                           std::span<const AgentPlace> agents) {
  if (bug("the way home is not asked for")) agents = {};
  return real_end_problem(self, mission, list, tick, from, tick_count, agents);
}

void bug_set_rest(WayHome* self, Tick counted) {
  if (bug("agents go home by the plan's end")) return;
  real_set_rest(self, counted);
}

const LawChange* bug_law_at(std::span<const LawChange> laws, Tick tick) {
  if (bug("agents keep to the plan's law")) laws = {};
  if (bug("a law holds a tick late")) --tick;
  if (bug("agents keep to a law that is undone")) laws = without_newest(laws);
  return real_law_at(laws, tick);
}

bool bug_lacks_end_by_finding(const Mission& mission, const Amendments& list, int found,
                              Tick tick) {
  if (bug("finds end nothing")) return false;
  if (bug("the first find ends the mission") && found > 0) found = mission.objects.end_when_found;
  return real_lacks_end_by_finding(mission, list, found, tick);
}

LawNumbers bug_law_numbers(const Mission& mission, int kind, const LawChange* change) {
  if (bug("all kinds have the law of the last") && change != nullptr)
    kind = static_cast<int>(change->kinds.size()) - 1;
  return real_law_numbers(mission, kind, change);
}

}  // namespace ergocast
