// SPDX-License-Identifier: BSD-3-Clause
// A scenario from its text to its plan. It is refused with problems that have place, error and
// remedy, or it gives a mission. The mission's printed text and plan give the same mission again.
#include "scenario/scenario.h"

#include "plan/plan.h"
#include "tests/fuzz/files.h"
#include "tests/fuzz/target.h"

namespace ergocast::fuzz {
namespace {

/// A folder with the maps map.csv and map.asc, for scenarios that name them.
const Folder& folder_with_maps() {
  static const Folder folder;
  static const bool written = [] {
    folder.write("map.csv", "0,1\n2,3\n");
    folder.write("map.asc", "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 500\n0 1\n2 3\n");
    return true;
  }();
  ERGOCAST_REQUIRE(written);
  return folder;
}

/// Correlated Gaussians take seconds here, and long texts find no more than short ones.
bool too_costly(std::string_view text) {
  return text.size() > 2048 || text.find("xy_m2") != text.npos;
}

}  // namespace

FUZZ_TARGET(scenario) {
  const std::string_view text = text_of(input);
  if (too_costly(text)) return;
  const std::string file = (folder_with_maps().path() / "fuzzed.textproto").string();
  const auto parsed = Scenario::parse(text, file);
  if (!parsed) {
    ERGOCAST_REQUIRE(!parsed.error().empty());
    for (const Problem& problem : parsed.error()) {
      ERGOCAST_REQUIRE(!problem.where.empty() && !problem.what.empty() && !problem.remedy.empty());
    }
    return;
  }
  const auto plan = encode_plan(parsed->mission());
  ERGOCAST_REQUIRE(decode_plan(plan).has_value());
  const auto again = Scenario::parse(parsed->print(), file);
  ERGOCAST_REQUIRE(again.has_value());
  ERGOCAST_REQUIRE(encode_plan(again->mission()) == plan);
}

}  // namespace ergocast::fuzz
