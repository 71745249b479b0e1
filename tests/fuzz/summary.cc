// SPDX-License-Identifier: BSD-3-Clause
// summary.json as the report reads it: any JSON gives a page.
#include "logger/summary.h"

#include "report/page.h"
#include "tests/fuzz/files.h"
#include "tests/fuzz/target.h"
#include "tests/support/team.h"

namespace ergocast::fuzz {

FUZZ_TARGET(summary) {
  static const Folder folder;
  static const Mission mission = test::small_mission(2);
  folder.write("summary.json", text_of(input));
  const auto read = read_summary(folder.path());
  if (!read) {
    ERGOCAST_REQUIRE(!read.error().empty());
    return;
  }
  const auto& summary = *read;
  const std::string page = report_page({}, mission, summary, {}, nullptr);
  ERGOCAST_REQUIRE(page.find("<script>alert") == std::string::npos);
  to_text(summary);
}

}  // namespace ergocast::fuzz
