// SPDX-License-Identifier: BSD-3-Clause
// `ergocast simulate --seeds`: simulates each seed in a worker process, prints failures with the
// command that repeats them.
#include "cli/study/trials.h"

#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <map>

#include "cli/command_text.h"
#include "cli/progress_line.h"
#include "cli/record/run_directory.h"
#include "cli/report_error.h"
#include "cli/study/fault_file.h"
#include "cli/study/trial_table.h"
#include "cli/study/workers.h"
#include "lab/trial.h"
#include "logger/null_buffer.h"
#include "plan/plan.h"
#include "runtime/process/program_options.h"
#include "text/shell_word.h"

namespace ergocast::cli {
namespace {

constexpr const char* kSwarm = "swarm";
constexpr std::int64_t kMostFailuresShown = 20;
/// A trial takes some hundredths of a second; above this time it hangs.
constexpr unsigned kPatience_s = 120;

/// Faults by seed: from a file, or drawn. Nothing, after an error message, if the file is invalid.
std::optional<std::function<lab::Faults(std::uint64_t)>> faults_by_seed(const std::string& source) {
  if (source == kSwarm) return lab::drawn;
  if (source.empty()) return [](std::uint64_t) { return lab::Faults(); };
  const auto read = read_faults(source);
  if (!read) {
    report_error(kExitBadInput, read.error());
    return std::nullopt;
  }
  return [faults = *read](std::uint64_t) { return faults; };
}

TrialReport report_of(const lab::TrialResult& result) {
  TrialReport report;
  report.figures = result.figures;
  if (result.timed_out) report.verdict = Verdict::kTimedOut;
  if (result.violation) {
    report.verdict = Verdict::kViolated;
    std::snprintf(report.what, sizeof report.what, "%s", to_string(*result.violation).c_str());
  } else if (!std::isfinite(report.figures.ergodic_metric)) {
    report.verdict = Verdict::kViolated;
    std::snprintf(report.what, sizeof report.what, "phi^2 is not a number");
  }
  return report;
}

TrialReport report_of_death(std::uint64_t seed, const std::string& how) {
  TrialReport report;
  report.figures.seed = seed;
  report.verdict = Verdict::kDied;
  std::snprintf(report.what, sizeof report.what, "%s", how.c_str());
  return report;
}

/// The command that repeats the trial of one seed.
std::string replay_of(const TrialsOptions& options, std::uint64_t seed) {
  std::string command = "ergocast simulate " + shell_word(options.mission.scenario.string()) +
                        options_of(options.mission.overrides);
  if (!options.faults.empty()) command += " --faults " + shell_word(options.faults);
  return command + " --seeds " + std::to_string(seed);
}

/// Processes the reports when they arrive: rows, totals, a line of progress.
class Desk {
 public:
  Desk(const TrialsOptions& options, const Basis& basis, std::ostream& csv)
      : options_(options), basis_(basis), csv_(csv) {
    csv_ << csv_header(basis_) << '\n';
    next_row_ = options.seeds.first;
  }

  void take(const TrialReport& report) {
    totals_.add(report);
    rows_[report.figures.seed] = csv_row(report, basis_);
    // Rows are written in the order of the seeds, in whichever order the workers finish.
    for (auto first = rows_.begin(); first != rows_.end() && first->first == next_row_;
         first = rows_.erase(first), ++next_row_) {
      csv_ << first->second << '\n';
    }
    if (report.verdict != Verdict::kViolated && report.verdict != Verdict::kDied) return;
    if (totals_.failed > kMostFailuresShown) return;
    progress_.print("seed " + std::to_string(report.figures.seed) + ": " + report.what +
                    "\n  again: " + replay_of(options_, report.figures.seed));
  }

  void show() {
    const auto now = ProgressLine::Clock::now();
    const auto done = static_cast<double>(totals_.trials);
    const auto all = static_cast<double>(options_.seeds.count());
    const double per_s = done / std::chrono::duration<double>(now - since_).count();
    if (!progress_.due(now) || totals_.trials == 0) return;
    std::vector<std::string> facts{std::to_string(totals_.trials) + " of " +
                                   std::to_string(options_.seeds.count()) + " seeds"};
    facts.push_back(clock_text((all - done) / per_s) + " left");
    facts.push_back(std::to_string(totals_.failed) + " failed");
    facts.push_back(text_of("%.0f runs/s", per_s));
    progress_.show(done / all, facts);
  }

  const TrialTotals& close() {
    for (const auto& [seed, row] : rows_) csv_ << row << '\n';
    csv_.flush();
    progress_.end();
    return totals_;
  }

 private:
  const TrialsOptions& options_;
  const Basis& basis_;
  std::ostream& csv_;
  ProgressLine progress_;
  const ProgressLine::Clock::time_point since_ = ProgressLine::Clock::now();
  TrialTotals totals_;
  std::map<std::uint64_t, std::string> rows_;  // rows that wait for smaller seeds
  std::uint64_t next_row_;
};

}  // namespace

int trials(const TrialsOptions& options) {
  for (const FieldValue& field : options.mission.overrides.fields) {
    if (field.path != "seed") continue;
    return report_error(kExitBadInput,
                        field.flag + ": --seeds sets it too (leave out one of them)");
  }
  const auto scenario = load_or_complain(options.mission.scenario, options.mission.overrides);
  if (!scenario) return kExitBadInput;
  if (scenario->mission().sites.any())
    return report_error(kExitBadInput,
                        "--seeds: the laboratory has no team of sites yet; use study");
  const auto faults = faults_by_seed(options.faults);
  if (!faults) return kExitBadInput;
  const auto& path = options.mission.out;
  std::ofstream csv;
  if (!path.empty()) csv.open(path);
  if (!path.empty() && !csv)
    return report_error(kExitBadInput,
                        path.string() + ": cannot be written (--out takes a file here)");

  NullBuffer nowhere;
  const auto run = [&](std::uint64_t job) {
    const std::uint64_t seed = options.seeds.first + job;
    const Mission mission = scenario->with_seed(seed).mission();
    return report_of(
        lab::run_trial({encode_plan(mission), (*faults)(seed), version()}, nowhere, nowhere));
  };
  StopSignals signals;
  const Basis basis = scenario->mission().basis;
  Desk desk(options, basis, path.empty() ? static_cast<std::ostream&>(nowhere) : csv);
  const auto start = std::chrono::steady_clock::now();
  Jobs jobs = jobs_with_results<TrialReport>(
      run, [&](std::uint64_t, const TrialReport& report) { desk.take(report); });
  jobs.count = options.seeds.count();
  jobs.processes = options.jobs;
  jobs.patience_s = kPatience_s;
  jobs.lost = [&](std::uint64_t job, const std::string& how) {
    desk.take(report_of_death(options.seeds.first + job, how));
  };
  jobs.go_on = [&] {
    desk.show();
    return true;
  };
  work_in_processes(jobs, signals);
  const double wall_s =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const TrialTotals& totals = desk.close();
  std::printf("%lld of %llu missions simulated in %.1f s\n%s",
              static_cast<long long>(totals.trials),
              static_cast<unsigned long long>(options.seeds.count()), wall_s,
              totals.describe(wall_s, basis).c_str());
  if (!path.empty() && !csv)
    return report_error(kExitBadInput, path.string() + ": writing failed; rows are missing");
  return totals.failed > 0 ? kExitFailed : kExitDone;
}

}  // namespace ergocast::cli
