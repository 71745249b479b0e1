// SPDX-License-Identifier: BSD-3-Clause
// Lines of a study's table: lines that were read are written again with the same figures.
#include "studies/study_table.h"

#include "tests/fuzz/target.h"

namespace ergocast::fuzz {
namespace {

studies::Study two_points() {
  return {{"law.epsilon"}, {{"mission", {"0.1"}, 2, 15}, {"mission", {"1"}, 3, 20}}};
}

}  // namespace

FUZZ_TARGET(study_table) {
  static const studies::Study study = two_points();
  static const studies::StudyTable table(study);
  std::string_view rest = text_of(input);
  while (!rest.empty()) {
    const std::string_view line = rest.substr(0, rest.find('\n'));
    rest.remove_prefix(std::min(rest.size(), line.size() + 1));
    const auto row = table.parse(line);
    if (!row) continue;
    ERGOCAST_REQUIRE(row->point < study.points.size());
    const auto again = table.parse(table.line(*row));
    ERGOCAST_REQUIRE(again && table.line(*again) == table.line(*row));
  }
}

}  // namespace ergocast::fuzz
