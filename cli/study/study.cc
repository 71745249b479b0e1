// SPDX-License-Identifier: BSD-3-Clause
// `ergocast study`: distributes the missing runs to worker processes, writes a row for each, then
// makes the table and the page.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>
#include <utility>

#include "cli/command_text.h"
#include "cli/commands.h"
#include "cli/progress_line.h"
#include "cli/report_error.h"
#include "cli/study/python_law.h"
#include "cli/study/study_directory.h"
#include "cli/study/study_options.h"
#include "cli/study/study_points.h"
#include "cli/study/study_results.h"
#include "cli/study/workers.h"
#include "plan/plan.h"
#include "runtime/process/program_options.h"
#include "runtime/process/signals.h"
#include "studies/study_run.h"
#include "text/shell_word.h"

namespace ergocast::cli {
namespace {

constexpr std::size_t kMostFailuresNamed = 20;

/// One run: a point and a seed.
using Run = std::pair<std::size_t, std::uint64_t>;

/// The figures of one run, or why there are none.
struct RunResult {
  studies::StudyFigures figures;
  char problem[600] = "";
};

/// The missing runs, seed by seed, so that an incomplete table allows comparisons, too.
std::vector<Run> missing_runs(std::size_t points, const StudyOptions& options,
                              const std::vector<Run>& done) {
  const StudyShard shard = options.shard.value_or(StudyShard());
  std::vector<Run> missing;
  for (std::uint64_t i = 0; i < options.seeds.count(); ++i) {
    for (std::size_t point = 0; point < points; ++point) {
      const Run run{point, options.seeds.first + i};
      if (shard.has(i * points + point) && !std::binary_search(done.begin(), done.end(), run))
        missing.push_back(run);
    }
  }
  return missing;
}

/// Simulates the missing runs and writes each result when it arrives.
class StudyRunner {
 public:
  StudyRunner(const StudyPoints& points, std::vector<Run> missing, StudyDirectory& directory)
      : points_(points), missing_(std::move(missing)), directory_(directory) {}

  void run_all(int processes) {
    Jobs jobs = jobs_with_results<RunResult>(
        [this](std::uint64_t job) { return run_one(missing_[job]); },
        [this](std::uint64_t job, const RunResult& result) { take(missing_[job], result); });
    jobs.count = missing_.size();
    jobs.processes = processes;
    jobs.lost = [this](std::uint64_t job, const std::string& how) { fail(missing_[job], how); };
    jobs.go_on = [this] {
      show();
      return !problem_;
    };
    StopSignals signals;
    work_in_processes(jobs, signals);
    progress_.end();
  }

  std::size_t completed() const { return completed_; }
  std::size_t failed() const { return failed_; }
  std::size_t missing() const { return missing_.size() - completed_; }
  /// The reason why rows could not be written.
  const std::optional<std::string>& problem() const { return problem_; }

 private:
  RunResult run_one(const Run& run) const {
    const Scenario scenario = points_.scenarios[run.first].with_seed(run.second);
    const auto plan = encode_plan(scenario.mission());
    const std::string& law = points_.laws[run.first];
    if (law.empty()) return {studies::run_study_mission(plan)};
    const auto figures = run_under_python_law(law, plan);
    RunResult result{figures.value_or(studies::StudyFigures())};
    if (!figures)
      std::snprintf(result.problem, sizeof result.problem, "%s", figures.error().c_str());
    return result;
  }

  void take(const Run& run, const RunResult& result) {
    const studies::StudyFigures& figures = result.figures;
    if (result.problem[0] != '\0') return fail(run, result.problem);
    if (!figures.complete) return fail(run, "the mission did not come to its last tick");
    if (!std::isfinite(figures.metric)) return fail(run, "phi^2 is not a number");
    ++completed_;
    if (!problem_) problem_ = directory_.add({run.first, figures});
  }

  void fail(const Run& run, const std::string& how) {
    if (++failed_ > kMostFailuresNamed) return;
    const studies::Study& study = points_.identity.study;
    progress_.print(name_of(study.points[run.first], study) + ", seed " +
                    std::to_string(run.second) + ": " + how);
  }

  void show() {
    const auto now = ProgressLine::Clock::now();
    if (completed_ == 0 || !progress_.due(now)) return;
    const auto all = static_cast<double>(missing_.size());
    const auto done = static_cast<double>(completed_ + failed_);
    const double per_s = done / std::chrono::duration<double>(now - since_).count();
    std::vector<std::string> facts{std::to_string(completed_ + failed_) + " of " +
                                   std::to_string(missing_.size()) + " runs"};
    facts.push_back(clock_text((all - done) / per_s) + " left");
    if (failed_ > 0) facts.push_back(std::to_string(failed_) + " failed");
    facts.push_back(text_of("%.3g runs/s", per_s));
    progress_.show(done / all, facts);
  }

  const StudyPoints& points_;
  const std::vector<Run> missing_;
  StudyDirectory& directory_;
  ProgressLine progress_;
  const ProgressLine::Clock::time_point since_ = ProgressLine::Clock::now();
  std::size_t completed_ = 0, failed_ = 0;
  std::optional<std::string> problem_;
};

/// The command that makes this study, without --out.
std::string command_of(const StudyOptions& options) {
  std::string command = "ergocast study";
  for (const auto& file : options.scenarios) command += ' ' + shell_word(file.string());
  for (const Variation& variation : options.variations) {
    command += " \\\n  --vary " + shell_word(variation.path) + '=';
    for (const std::string& value : variation.values) {
      command += (&value == &variation.values.front() ? "" : ",") + shell_word(value);
    }
  }
  command += options_of({.duration_s = options.duration_s, .fields = options.settings});
  return command + " \\\n  --seeds " + std::to_string(options.seeds.first) + ':' +
         std::to_string(options.seeds.last);
}

/// Prints the paths of the results, and the command that completes the study if runs are missing.
void say_how_it_went(const StudyRunner& runner, const StudyDirectory& directory,
                     const StudyOptions& options) {
  std::printf("\n%zu runs done now, %zu in %s\n", runner.completed(), directory.rows().size(),
              (options.out / "study.csv").c_str());
  std::printf("report: %s\n", (std::filesystem::absolute(options.out) / "report.html").c_str());
  if (runner.missing() == 0 && options.shard) {
    std::printf("when all shards are done: ergocast study merge FOLDER… --out DIR\n");
  }
  if (runner.missing() == 0) return;
  std::printf("%zu runs are missing%s: the same command runs them\n", runner.missing(),
              runner.failed() > 0
                  ? (", " + std::to_string(runner.failed()) + " of them failed").c_str()
                  : "");
}

int study(const StudyOptions& options) {
  auto compiled = study_points(options);
  if (!compiled) return report_error(kExitBadInput, compiled.error());
  auto& points = *compiled;
  const std::size_t count = points.scenarios.size();
  if (options.seeds.count() > kMostStudyRuns / count) {
    return report_error(kExitBadInput, "--seeds: " + std::to_string(count) + " points with " +
                                           std::to_string(options.seeds.count()) +
                                           " seeds each are above the limit, " +
                                           std::to_string(kMostStudyRuns) + " runs (give fewer)");
  }
  const std::string command = command_of(options);
  if (options.shard) {
    points.identity.shard = {options.shard->index, options.shard->of, options.seeds.first,
                             options.seeds.last,   command,           points.missions};
  }
  auto opened = StudyDirectory::open(options.out, points.identity);
  if (!opened) return report_error(kExitBadInput, opened.error());
  StudyDirectory& directory = **opened;

  StudyRunner runner(points, missing_runs(count, options, directory.done()), directory);
  runner.run_all(options.jobs);
  std::optional<std::string> problem = runner.problem();
  if (!problem) {
    problem = conclude(directory, {points.identity.study, command, points.missions,
                                   options.seeds.first, options.out, options.measures});
  }
  if (problem) {
    print_message(*problem + "; the same command goes on");
    return kExitFailed;
  }
  say_how_it_went(runner, directory, options);
  return runner.failed() > 0 ? kExitFailed : kExitDone;
}

}  // namespace

void add_study(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand(
      "study", "Compare many simulated missions: scenarios, varied fields, seeds");
  auto options = std::make_shared<StudyOptions>();
  add_study_options(*command, *options);
  auto merge_options = std::make_shared<MergeOptions>();
  const CLI::App* merge = add_merge(*command, *merge_options);
  command->callback([&action, options, merge, merge_options] {
    if (merge->parsed()) {
      action = [merge_options] { return merge_studies(*merge_options); };
      return;
    }
    // CLI11 would take the word "merge" for a scenario that is required.
    if (options->scenarios.empty()) throw CLI::RequiredError("SCENARIO");
    action = [options] { return study(*options); };
  });
}

}  // namespace ergocast::cli
