// SPDX-License-Identifier: BSD-3-Clause
// A scenario's text and its rules, without the integrals over its target, which take too long for
// millions of texts. A negative weight in each keeps the loader from them.
#include "scenario/scenario.h"
#include "tests/fuzz/target.h"

namespace ergocast::fuzz {

FUZZ_TARGET(scenario_text) {
  Overrides overrides;
  overrides.fields.push_back({"target.uniform_weight", "-1", "--set"});
  const auto parsed = Scenario::parse(text_of(input), "/fuzzed/mission.textproto", overrides);
  const auto* problems = std::get_if<std::vector<Problem>>(&parsed);
  ERGOCAST_REQUIRE(problems != nullptr && !problems->empty());
  for (const Problem& problem : *problems) {
    ERGOCAST_REQUIRE(!problem.where.empty() && !problem.what.empty() && !problem.remedy.empty());
  }
}

}  // namespace ergocast::fuzz
