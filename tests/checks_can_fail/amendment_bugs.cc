// SPDX-License-Identifier: BSD-3-Clause
// Bugs of new targets.
#include "core/law/coverage_table.h"
#include "core/law/target_shift.h"
#include "tests/checks_can_fail/bugs.h"

namespace ergocast {

// clang-format off
WRAPPED(void, note_targets, "_ZN8ergocast11TargetShift4noteERKNS_10AmendmentsE", TargetShift*, const Amendments&)
WRAPPED(void, shift_sample, "_ZN8ergocast13CoverageTable12shift_sampleERKNS_6AuthorEPKd", CoverageTable*, const Author&, const double*)
// clang-format on

void bug_note_targets(TargetShift* self, const Amendments& list) {
  Amendments changed = list;
  if (bug("a pause does not delay a target")) changed.holds.clear();
  if (bug("a target holds a tick late")) {
    for (TargetChange& change : changed.targets) ++change.from;
  }
  real_note_targets(self, changed);
}

void bug_shift_sample(CoverageTable* self, const Author& author, const double* shift) {
  if (bug("one agent keeps to the plan's target") && author.agent == 0) return;
  real_shift_sample(self, author, shift);
  if (bug("a target counts twice")) real_shift_sample(self, author, shift);
}

}  // namespace ergocast
