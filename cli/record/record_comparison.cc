// SPDX-License-Identifier: BSD-3-Clause
// Makes each file of a record again in memory and reports the first place where the recorded file
// differs.
#include "cli/record/record_comparison.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <sstream>
#include <string_view>
#include <utility>

#include "cli/record/trajectory_comparison.h"
#include "cli/team/recorded_team.h"
#include "logger/amendments_file.h"
#include "logger/mission_text.h"
#include "logger/run_record.h"
#include "logger/summary.h"
#include "plan/plan.h"
#include "report/report.h"
#include "report/target_density.h"
#include "runtime/process/program_options.h"
#include "text/input_file.h"

namespace ergocast::cli {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// A recorded file that is longer than its source by at most this is read to show the difference.
constexpr std::size_t kMostSurplusBytes = std::size_t{1} << 20;

std::string why_left_out(const FileProblem& problem) {
  return problem.kind == FileProblem::Kind::kMissing ? "is not there" : problem.what;
}

/// Line `number` of `text`, counted from 1. If `text` is shorter, a text that states this.
std::string line_of(const std::string& text, std::size_t number) {
  constexpr std::size_t kLongest = 160;
  std::istringstream lines(text);
  std::string line;
  for (std::size_t i = 0; i < number; ++i) {
    if (!std::getline(lines, line)) return "(the file has ended)";
  }
  return line.size() <= kLongest ? line : line.substr(0, kLongest) + "…";
}

/// The first line and column in which `recorded` differs from `expected`; empty if they are equal.
std::string text_difference(const fs::path& file, const std::string& recorded,
                            const std::string& expected) {
  if (recorded == expected) return "";
  const auto at =
      std::mismatch(recorded.begin(), recorded.end(), expected.begin(), expected.end()).first;
  const auto line = 1 + std::count(recorded.begin(), at, '\n');
  const auto line_begin = std::find(std::reverse_iterator(at), recorded.rend(), '\n').base();
  const auto number = static_cast<std::size_t>(line);
  return file.string() + ':' + std::to_string(line) + ':' + std::to_string(at - line_begin + 1) +
         "\nrecorded:  " + line_of(recorded, number) + "\nexpected:  " + line_of(expected, number) +
         '\n';
}

FileComparison compare_text(const fs::path& run_dir, const std::string& name,
                            const std::string& expected, const char* compared) {
  const fs::path file = run_dir / name;
  const auto read = read_whole(file, expected.size() + kMostSurplusBytes);
  if (read) return {name, compared, "", text_difference(file, *read, expected)};
  const FileProblem& problem = read.error();
  if (problem.kind == FileProblem::Kind::kTooLarge)
    return {name, compared, "",
            file.string() + " is longer than what it should hold, " +
                std::to_string(expected.size()) + " bytes\n"};
  return {name, "", why_left_out(problem), ""};
}

/// Whether all problems are maps that no longer exist.
bool lacks_a_map(const std::vector<Problem>& problems) {
  return std::all_of(problems.begin(), problems.end(), [](const Problem& problem) {
    return problem.what.find("there is no such file") != std::string::npos;
  });
}

/// Compares plan.binpb with the plan that the scenario compiles to.
FileComparison compare_plan(const fs::path& run_dir, const Mission& mission,
                            const Scenario& scenario, const FileComparison& hash) {
  const fs::path file = run_dir / kPlanFile;
  FileComparison plan_file = hash;
  plan_file.compared = "with the scenario, compiled anew";
  const std::vector<std::byte> recorded = encode_plan(mission),
                               expected = encode_plan(scenario.mission());
  if (!plan_file.difference.empty() || recorded == expected) return plan_file;
  const auto at =
      std::mismatch(recorded.begin(), recorded.end(), expected.begin(), expected.end()).first -
      recorded.begin();
  plan_file.difference = file.string() + ": not what " + kScenarioFile +
                         " compiles to, first at byte " + std::to_string(at) +
                         "\nrecorded:  " + plan_hash(recorded) +
                         "\nexpected:  " + plan_hash(expected) + '\n';
  return plan_file;
}

/// Values that depend on the wall clock and the machine.
constexpr std::array kOfTheMachine{"/started", "/build", "/cpu_fma", "/wall_time_s",
                                   "/ticks_per_s"};
/// Values that depend on the network and its faults, or come from agents' last statuses.
constexpr std::array kOfTheNetwork{"/reason",
                                   "/interruptions",
                                   "/events_removed",
                                   "/restarts",
                                   "/messages",
                                   "/record_complete",
                                   "/processes",
                                   "/authenticated",
                                   "/separation/blocked_share",
                                   "/separation/longest_block_s"};
/// An agent's values that roster and plan determine; its other values come from its last status.
constexpr std::array kOfTheRoster{"/id", "/active_from", "/active_until"};

template <std::size_t kCount>
bool names_one_of(const std::array<const char*, kCount>& keys, const std::string& pointer) {
  return std::any_of(keys.begin(), keys.end(), [&pointer](std::string_view key) {
    return pointer == key || (pointer.starts_with(key) && pointer[key.size()] == '/');
  });
}

/// Whether the value at `pointer` of a summary depends on more than the plan.
bool is_free(const std::string& pointer, const Json& recorded, const Expectation& expectation) {
  const std::string last = pointer.substr(pointer.rfind('/'));
  const bool of_an_agent = pointer.starts_with("/agents/");
  if (names_one_of(kOfTheMachine, pointer) || (of_an_agent && last == "/host")) return true;
  if (expectation.whole) return false;
  if (of_an_agent)
    return std::find(kOfTheRoster.begin(), kOfTheRoster.end(), last) == kOfTheRoster.end();
  if (pointer == "/run_id" && recorded.value("mode", Json()) != "simulate") return true;
  // A launcher can report a failed mission although its record is complete.
  if (pointer == "/result") return recorded.value("result", Json()) == "failed";
  if (pointer == "/speed_limit/clamped_commands") {
    return !expectation.complete || recorded.value("restarts", Json()) != 0;
  }
  return names_one_of(kOfTheNetwork, pointer);
}

Json expected_summary(const Json& recorded, const Mission& mission, const fs::path& run_dir,
                      const Expectation& expectation) {
  RunContext context;
  context.run = expectation.recorder.run();
  context.version = version();
  context.scenario_hash = plan_hash(encode_plan(mission));
  context.simulated = expectation.simulation;
  context.segments = std::max(1, segment_count(run_dir));
  Json summary = summarize(expectation.recorder, context);
  if (!expectation.amendments.empty())
    summary["amendments"] = amendments_json(expectation.amendments, mission.timing.dt_s);
  if (summary.contains("speed_limit")) {
    summary["speed_limit"]["clamped_commands"] = expectation.clamped_commands;
  }
  if (recorded.value("emergency_stop", Json()) == true && !expectation.complete) {
    summary["emergency_stop"] = true;
  }
  return summary;
}

/// The file and the key of a value, as text for people.
std::string place_of(const fs::path& file, const std::string& pointer) {
  return file.string() + ", " + pointer;
}

}  // namespace

std::vector<FileComparison> compare_sources(const fs::path& run_dir, const Mission& mission,
                                            const Json& summary) {
  FileComparison hash{kPlanFile, "", "", ""};
  if (summary.contains("scenario_hash")) {
    hash.compared = "with the summary's hash";
    const std::string expected = plan_hash(encode_plan(mission));
    if (summary["scenario_hash"] != expected) {
      hash.difference = place_of(run_dir / kSummaryFile, "/scenario_hash") +
                        "\nrecorded:  " + summary["scenario_hash"].dump() + "\nexpected:  \"" +
                        expected + "\" of " + (run_dir / kPlanFile).string() + '\n';
    }
  }
  const auto read = read_whole(run_dir / kScenarioFile, kMaxScenarioBytes);
  if (!read) return {hash, {kScenarioFile, "", why_left_out(read.error()), ""}};
  if (*read == mission_text(mission))
    return {hash, {kScenarioFile, "all but the target, which it lacks", "", ""}};
  const auto loaded = Scenario::load(run_dir / kScenarioFile);
  if (!loaded) {
    const std::string problem = to_string(loaded.error().front());
    if (lacks_a_map(loaded.error())) {
      return {hash,
              {kScenarioFile, "", problem, ""},
              {kTargetDensityFile, "", "its maps are missing", ""}};
    }
    return {hash, {kScenarioFile, "", "", problem + '\n'}};
  }
  return {compare_plan(run_dir, mission, *loaded, hash),
          compare_text(run_dir, kScenarioFile, loaded->print(), "with the plan"),
          compare_text(run_dir, kTargetDensityFile, target_density_text(loaded->target_density()),
                       "with the scenario's target")};
}

FileComparison compare_metrics(const fs::path& run_dir, const Expectation& expectation) {
  constexpr int kOfTheTrajectory = 4;  // columns
  const auto cells = [&](const std::string& row) {
    std::size_t end = 0;
    for (int i = 0; i < kOfTheTrajectory; ++i) end = row.find(',', end + (i > 0 ? 1 : 0));
    return expectation.whole ? row : row.substr(0, end);
  };
  FileComparison metrics{kMetricsFile, "", "", ""};
  TableLines lines(run_dir, kMetricsFile, {kMetricsHeader});
  std::istringstream expected_lines(expectation.metrics);
  std::string recorded, expected;
  std::getline(expected_lines, expected);  // the header
  std::int64_t rows = 0;
  while (lines.next(recorded)) {
    if (!std::getline(expected_lines, expected)) {
      metrics.difference = lines.place() + "goes on after the trajectory's end\n";
      return metrics;
    }
    if (cells(recorded) != cells(expected)) {
      metrics.difference =
          first_difference(lines.place(), kMetricsHeader, cells(recorded), cells(expected));
      return metrics;
    }
    ++rows;
  }
  if (lines.problem()) {
    metrics.difference = *lines.problem() + '\n';
  } else if (expectation.closed && (lines.torn() || std::getline(expected_lines, expected))) {
    metrics.difference = lines.place() + "ends before the trajectory does\n";
  }
  metrics.compared = std::to_string(rows) + " rows";
  if (!expectation.whole) {
    metrics.compared += ": tick, t_s, ergodic_metric, detection_probability";
    metrics.left_out = "the other columns are the agents' reports of the network";
  }
  return metrics;
}

FileComparison compare_summary(const fs::path& run_dir, const Mission& mission,
                               const Json& recorded, const Expectation& expectation) {
  const Json expected = expected_summary(recorded, mission, run_dir, expectation);
  const Json left = recorded.flatten(), right = expected.flatten();
  FileComparison summary{kSummaryFile, "", "", ""};
  int compared = 0, free = 0;
  const auto differ = [&](const std::string& pointer) {
    const auto value_in = [&](const Json& flat) {
      return flat.contains(pointer)
                 ? flat[pointer].dump(-1, ' ', false, Json::error_handler_t::replace)
                 : std::string("nothing");
    };
    summary.difference = place_of(run_dir / kSummaryFile, pointer) +
                         "\nrecorded:  " + value_in(left) + "\nexpected:  " + value_in(right) +
                         '\n';
  };
  for (const auto* side : {&right, &left}) {
    for (const auto& [pointer, value] : side->items()) {
      if (is_free(pointer, recorded, expectation)) {
        free += side == &left ? 1 : 0;
        continue;
      }
      compared += side == &left ? 1 : 0;
      if (!left.contains(pointer) || !right.contains(pointer) || left[pointer] != right[pointer]) {
        differ(pointer);
        return summary;
      }
    }
  }
  summary.compared = std::to_string(compared) + " values";
  summary.left_out = std::to_string(free) + " values of the clock" +
                     (expectation.whole ? " and the machine" : ", the machine and the network");
  return summary;
}

FileComparison compare_report(const fs::path& run_dir, const Mission& mission) {
  const auto drawn = draw_report(run_dir, mission, recorded_team(run_dir, mission));
  if (!drawn) return {kReportFile, "", "", drawn.error() + '\n'};
  const bool sources_are_there =
      fs::exists(run_dir / kSummaryFile) && fs::exists(run_dir / kTargetDensityFile);
  const FileComparison compared = compare_text(run_dir, kReportFile, drawn->html, "drawn anew");
  if (compared.difference.empty() || sources_are_there) return compared;
  return {kReportFile, "", "a file that it may have been drawn from is not there", ""};
}

}  // namespace ergocast::cli
