// SPDX-License-Identifier: BSD-3-Clause
// The tables of a run directory: trajectory.csv, and after a line "--" metrics.csv.
#include <cmath>

#include "logger/recorder.h"
#include "logger/run_data.h"
#include "tests/fuzz/files.h"
#include "tests/fuzz/target.h"
#include "tests/support/team.h"

namespace ergocast::fuzz {
namespace {

void check(const RunData& run) {
  std::pair<Tick, AgentId> last{-1, -1};
  for_each_row(run, [&last](AgentId id, const TrackPoint& row) {
    ERGOCAST_REQUIRE(std::pair(row.tick, id) > last);
    last = {row.tick, id};
  });
  const auto slope = fit_last_decade(run);
  ERGOCAST_REQUIRE(!slope || !std::isnan(slope->slope));
  const Coefficients coverage = coverage_of(run, test::small_mission(2));
  for (const double c : coverage.reshaped()) ERGOCAST_REQUIRE(std::abs(c) <= 1 + 1e-6);
}

/// A restarted logger continues such a record.
void resume(RunData run) {
  std::ostringstream trajectory, metrics;
  test::announce(test::small_mission(2));
  Recorder recorder(test::kRun, test::kLoggerLife, trajectory, metrics);
  recorder.resume(std::move(run));
  const Instant now = test::at(std::chrono::seconds(1));
  test::give(recorder, test::mission_part(0, MissionState::kRunning, test::roster_of(2)), now);
  Outbox out;
  recorder.advance(now, out);
}

}  // namespace

FUZZ_TARGET(run_tables) {
  static const Folder folder;
  constexpr std::string_view kSeparator = "--\n";
  const std::string_view text = text_of(input);
  const std::size_t end = std::min(text.find(kSeparator), text.size());
  const std::size_t next = std::min(end + kSeparator.size(), text.size());
  folder.write("trajectory.csv", text.substr(0, end));
  folder.write("metrics.csv", text.substr(next));
  auto read = read_run(folder.path(), test::small_mission(2));
  if (!read) {
    ERGOCAST_REQUIRE(!read.error().empty());
    return;
  }
  check(*read);
  resume(*std::move(read));
}

}  // namespace ergocast::fuzz
