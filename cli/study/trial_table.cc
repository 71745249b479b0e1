// SPDX-License-Identifier: BSD-3-Clause
// One table of counts yields the CSV header, the CSV rows and the totals.
#include "cli/study/trial_table.h"

#include <algorithm>
#include <cstdio>
#include <sstream>

#include "logger/summary.h"

namespace ergocast::cli {
namespace {

using lab::TrialFigures;

struct Count {
  const char* column;   ///< in the CSV file
  const char* meaning;  ///< in the summary; null: not shown
  std::int64_t& (*of)(TrialFigures&);
};

/// All counters, in the order of the columns.
constexpr Count kCounts[] = {
    {"agent_steps", nullptr, [](TrialFigures& f) -> std::int64_t& { return f.agent_steps; }},
    {"messages", nullptr, [](TrialFigures& f) -> std::int64_t& { return f.messages; }},
    {"contributions", nullptr, [](TrialFigures& f) -> std::int64_t& { return f.contributions; }},
    {"digests", nullptr, [](TrialFigures& f) -> std::int64_t& { return f.digests; }},
    {"relayed", nullptr, [](TrialFigures& f) -> std::int64_t& { return f.relayed; }},
    {"lost", "messages lost", [](TrialFigures& f) -> std::int64_t& { return f.faults.lost; }},
    {"cut", "lost at a partition", [](TrialFigures& f) -> std::int64_t& { return f.faults.cut; }},
    {"duplicated", "duplicated",
     [](TrialFigures& f) -> std::int64_t& { return f.faults.duplicated; }},
    {"replayed", "replayed", [](TrialFigures& f) -> std::int64_t& { return f.faults.replayed; }},
    {"corrupted", "corrupted", [](TrialFigures& f) -> std::int64_t& { return f.faults.corrupted; }},
    {"delayed", "delayed", [](TrialFigures& f) -> std::int64_t& { return f.faults.delayed; }},
    {"reordered", "reordered", [](TrialFigures& f) -> std::int64_t& { return f.faults.reordered; }},
    {"clogged", "held on clogged links",
     [](TrialFigures& f) -> std::int64_t& { return f.faults.clogged; }},
    {"clogs", "links clogged", [](TrialFigures& f) -> std::int64_t& { return f.faults.clogs; }},
    {"splits", "partitions", [](TrialFigures& f) -> std::int64_t& { return f.splits; }},
    {"one_way_cuts", "one-way cuts",
     [](TrialFigures& f) -> std::int64_t& { return f.one_way_cuts; }},
    {"evictions", "agents evicted", [](TrialFigures& f) -> std::int64_t& { return f.evictions; }},
    {"agent_crashes", "agents crashed",
     [](TrialFigures& f) -> std::int64_t& { return f.agent_crashes; }},
    {"coordinator_crashes", "coordinators crashed",
     [](TrialFigures& f) -> std::int64_t& { return f.coordinator_crashes; }},
    {"world_crashes", "worlds crashed",
     [](TrialFigures& f) -> std::int64_t& { return f.world_crashes; }},
    {"pauses", "pauses", [](TrialFigures& f) -> std::int64_t& { return f.pauses; }},
    {"recalls", "recalls", [](TrialFigures& f) -> std::int64_t& { return f.recalls; }},
    {"ends", "other ends", [](TrialFigures& f) -> std::int64_t& { return f.ends; }},
    {"targets", "new targets", [](TrialFigures& f) -> std::int64_t& { return f.targets; }},
    {"zones", "zones", [](TrialFigures& f) -> std::int64_t& { return f.zones; }},
    {"laws", "other laws", [](TrialFigures& f) -> std::int64_t& { return f.laws; }},
    {"cancels", "changes undone", [](TrialFigures& f) -> std::int64_t& { return f.cancels; }},
    {"held_ticks", "ticks held", [](TrialFigures& f) -> std::int64_t& { return f.held_ticks; }},
    {"skewed_clocks", "clocks skewed",
     [](TrialFigures& f) -> std::int64_t& { return f.skewed_clocks; }},
    {"recoveries", nullptr, [](TrialFigures& f) -> std::int64_t& { return f.recoveries; }},
};

const char* result_of(const TrialReport& report) {
  constexpr const char* kNames[] = {"fine", "timed out", "violated", "died"};
  return kNames[static_cast<int>(report.verdict)];
}

}  // namespace

std::string csv_header(const Basis& basis) {
  std::string line =
      "seed,result,virtual_s,ergodic_metric,view_error,recovery_mean_s,recovery_max_s";
  for (const Count& count : kCounts) line += std::string(",") + count.column;
  if (basis.free_domain) line += ",basis";
  return line;
}

std::string csv_row(const TrialReport& report, const Basis& basis) {
  TrialFigures figures = report.figures;
  std::ostringstream line;
  line.precision(17);
  line << figures.seed << ',' << result_of(report);
  for (const double value : {figures.virtual_s, figures.ergodic_metric, figures.view_error,
                             figures.recovery_mean_s, figures.recovery_max_s}) {
    line << ',' << value;
  }
  for (const Count& count : kCounts) line << ',' << count.of(figures);
  if (basis.free_domain) line << ',' << name_of_basis(basis);
  return line.str();
}

void TrialTotals::add(const TrialReport& report) {
  ++trials;
  timed_out += report.verdict == Verdict::kTimedOut;
  failed += report.verdict == Verdict::kViolated || report.verdict == Verdict::kDied;
  TrialFigures figures = report.figures;
  for (const Count& count : kCounts) count.of(sums) += count.of(figures);
  sums.virtual_s += figures.virtual_s;
  recovery_sum_s += figures.recovery_mean_s * static_cast<double>(figures.recoveries);
  sums.recovery_max_s = std::max(sums.recovery_max_s, figures.recovery_max_s);
  if (report.verdict != Verdict::kFine) return;
  worst_metric = std::max(worst_metric, figures.ergodic_metric);
  worst_view_error = std::max(worst_view_error, figures.view_error);
}

std::string TrialTotals::describe(double wall_s, const Basis& basis) const {
  std::string text;
  const auto row = [&text](const char* meaning, const char* format, double value) {
    char line[100];
    const int used = std::snprintf(line, sizeof line, "  %-26s", meaning);
    std::snprintf(line + used, sizeof line - static_cast<std::size_t>(used), format, value);
    text += std::string(line) + '\n';
  };
  TrialFigures figures = sums;
  text += "Faults:\n";
  for (const Count& count : kCounts) {
    if (count.meaning != nullptr)
      row(count.meaning, "%14.0f", static_cast<double>(count.of(figures)));
  }
  text += "Results:\n";
  row("greatest phi^2 at the end",
      basis.free_domain ? "%14.4g in modes of the free domain" : "%14.4g", worst_metric);
  row("greatest view error", "%14.4g", worst_view_error);
  if (sums.recoveries > 0) {
    row("mean recovery [s]", "%14.2f", recovery_sum_s / static_cast<double>(sums.recoveries));
    row("longest recovery [s]", "%14.2f", sums.recovery_max_s);
  }
  row("messages sent", "%14.0f", static_cast<double>(sums.messages));
  row("blocks relayed", "%14.0f", static_cast<double>(sums.relayed));
  row("virtual hours", "%14.2f", sums.virtual_s / 3600);
  row("runs/s", "%14.1f", static_cast<double>(trials) / wall_s);
  row("agent-steps/s", "%14.0f", static_cast<double>(sums.agent_steps) / wall_s);
  if (timed_out > 0) row("missions timed out", "%14.0f", static_cast<double>(timed_out));
  row("failures", "%14.0f", static_cast<double>(failed));
  return text;
}

}  // namespace ergocast::cli
