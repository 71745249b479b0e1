// SPDX-License-Identifier: BSD-3-Clause
// Chooses or checks the run directory, and prints where the results of a mission are.
#include "cli/record/run_directory.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <utility>
#include <vector>

#include "cli/record/amendment_lines.h"
#include "cli/report_error.h"
#include "cli/team/recorded_team.h"
#include "logger/amendments_file.h"
#include "logger/run_data.h"
#include "logger/run_record.h"
#include "logger/summary.h"
#include "modes/table_file.h"
#include "plan/plan.h"
#include "report/report.h"
#include "report/target_density.h"
#include "runtime/process/program_options.h"

namespace ergocast::cli {
namespace {

namespace fs = std::filesystem;

fs::path default_folder(const std::string& scenario) {
  const std::time_t now = std::time(nullptr);
  std::tm local{};
  localtime_r(&now, &local);
  char stamp[32];
  std::strftime(stamp, sizeof stamp, "%Y%m%d-%H%M%S", &local);
  const std::string stem = scenario + '-' + stamp;
  fs::path folder = fs::path("runs") / stem;
  for (int i = 2; fs::exists(folder); ++i)
    folder = fs::path("runs") / (stem + '-' + std::to_string(i));
  return folder;
}

using Json = nlohmann::ordered_json;

/// The value at `pointer` ("/messages/sent") as text; "unknown" if there is none.
std::string text_at(const Json& summary, const char* pointer) {
  const Json value = summary.value(Json::json_pointer(pointer), Json(nullptr));
  if (value.is_null()) return "unknown";
  return value.is_string() ? value.get<std::string>() : value.dump();
}

std::string number_at(const Json& summary, const char* pointer, const char* format, double factor) {
  const Json value = summary.value(Json::json_pointer(pointer), Json(nullptr));
  if (!value.is_number()) return "unknown";
  char text[32];
  std::snprintf(text, sizeof text, format, factor * value.get<double>());
  return text;
}

void print_stations(const Json& stations) {
  if (stations.value("agents", 0) == 0) {
    std::printf("  stations  no agent had to be home yet\n");
    return;
  }
  std::printf("  stations  %s of %s agents home in time, at most %s m away",
              text_at(stations, "/home").c_str(), text_at(stations, "/agents").c_str(),
              number_at(stations, "/farthest_m", "%.2f", 1).c_str());
  const Json late = stations.value("late", Json::array());
  if (!late.empty()) std::printf("; not home: %s", late.dump().c_str());
  std::printf("\n");
}

/// Which objects the team has found, as `summary` has them.
void print_objects(const Json& objects) {
  std::printf("  objects   found %s of %s objects\n", text_at(objects, "/found").c_str(),
              text_at(objects, "/count").c_str());
  for (const Json& find : objects.value("finds", Json::array())) {
    const Find known{.object = find.value("object", 0),
                     .agent = find.value("agent", kUnassigned),
                     .tick = find.value("tick", Tick{0}),
                     .t_s = find.value("t_s", 0.0),
                     .x_m = {find.value("x_m", 0.0), find.value("y_m", 0.0), 0}};
    std::printf("            %s\n", to_text(known).c_str());
  }
}

/// What the team would have found, how long it left places alone, and how far it moved.
void print_achievement(const Json& summary) {
  const auto number = [&](const char* pointer, const char* format, double factor = 1) {
    return number_at(summary, pointer, format, factor);
  };
  const auto after = [&](const char* pointer) {
    const bool came = !summary.at(Json::json_pointer(pointer)).is_null();
    return came ? "after " + number(pointer, "%.0f") + " s" : std::string("never");
  };
  std::printf("  found     %s %% of objects drawn from the target, by sensors of %s m, %s per s\n",
              number("/detection/probability", "%.1f", 100).c_str(),
              number("/sensor/radius_m", "%.3g").c_str(),
              number("/sensor/detections_per_s", "%g").c_str());
  std::printf("            50 %% %s, 80 %% %s\n", after("/detection/time_to_half_s").c_str(),
              after("/detection/time_to_four_fifths_s").c_str());
  std::printf("  watched   95 %% of the target left alone for at most %s s\n",
              number("/greatest_age_s", "%.0f").c_str());
  std::printf("  moved     %s m in all; the time spent is %s m from the target\n",
              number("/path_m", "%.0f").c_str(), number("/sliced_wasserstein_m", "%.3g").c_str());
}

void print_summary(const Json& summary) {
  const auto text = [&](const char* pointer) { return text_at(summary, pointer); };
  const auto number = [&](const char* pointer, const char* format, double factor = 1) {
    return number_at(summary, pointer, format, factor);
  };
  std::printf("\n%s: %s\n", text("/result").c_str(), text("/reason").c_str());
  std::printf("  ticks     %s of %s in %s s, %s ticks/s\n", text("/ticks").c_str(),
              text("/tick_count").c_str(), number("/wall_time_s", "%.1f").c_str(),
              number("/ticks_per_s", "%.0f").c_str());
  const bool free_domain = summary.contains("ergodic_metric_in_cosines");
  std::printf("  phi^2     %s -> %s, slope %s over the last decade%s\n",
              number("/ergodic_metric/first", "%.4g").c_str(),
              number("/ergodic_metric/last", "%.4g").c_str(),
              number("/log_log_slope", "%.2f").c_str(),
              free_domain ? ", in the modes of the free domain" : "");
  if (free_domain) {
    std::printf("            %s in cosines\n",
                number("/ergodic_metric_in_cosines/last", "%.4g").c_str());
  }
  if (summary.contains("goal")) {
    const bool reached = summary["goal"].value("reached", false);
    std::printf("  goal      %s%s, %s\n", number("/goal/ergodic_metric", "%.4g").c_str(),
                free_domain ? " in the modes of the free domain" : "",
                reached ? "reached" : "not reached");
  }
  if (summary.contains("detection")) print_achievement(summary);
  if (summary.contains("objects")) print_objects(summary["objects"]);
  if (const int wrong = summary.value("wrong_confirmations", 0); wrong > 0)
    std::printf("            %s\n", wrong_confirmations_text(wrong).c_str());
  std::printf("  messages  %s sent, %s received, %s lost, %s dropped by the kernel\n",
              text("/messages/sent").c_str(), text("/messages/received").c_str(),
              text("/messages/lost").c_str(), text("/messages/kernel_drops").c_str());
  if (summary.value("restarts", 0) > 0) {
    std::printf("  restarts  %s\n", text("/restarts").c_str());
  }
  if (summary.value("mode", "") == "realtime") {
    std::printf("  deadlines %s commands too late, %s ticks skipped\n",
                text("/missed_deadlines").c_str(), text("/skipped_ticks").c_str());
  }
  if (summary.contains("speed_limit")) {
    std::printf("  speed     limited to %s m/s, %s commands cut to it\n",
                number("/speed_limit/mps", "%g").c_str(),
                text("/speed_limit/clamped_commands").c_str());
  }
  if (summary.contains("separation")) {
    std::printf(
        "  distance  %s m kept, nearest %s m; blocked in %s %% of the ticks, at most %s s\n",
        number("/separation/distance_m", "%g").c_str(),
        number("/separation/nearest_m", "%.2f").c_str(),
        number("/separation/blocked_share", "%.1f", 100).c_str(),
        number("/separation/longest_block_s", "%.1f").c_str());
  }
  if (summary.contains("stations")) print_stations(summary["stations"]);
}

/// What has changed in the mission, if it can be read.
void print_amendments(const fs::path& run_dir, const Json& summary, const Mission& mission) {
  constexpr std::size_t kMost = 20;
  auto amendments = recorded_amendments(run_dir, summary, mission);
  if (!amendments || amendments->empty()) return;
  const auto has_zone = [](const ReceivedAmendment& one) { return one.zone.has_value(); };
  RunData run;
  if (std::ranges::any_of(amendments->all(), has_zone))
    run = read_tracks(run_dir).value_or(RunData());
  run.amendments = *std::move(amendments);
  const std::vector<std::string> lines = amendment_lines(run, mission);
  const std::size_t hidden = lines.size() - std::min(lines.size(), kMost);
  if (hidden > 0) std::printf("  earlier   %zu others, in amendments.json\n", hidden);
  for (std::size_t i = hidden; i < lines.size(); ++i) std::printf("  %s\n", lines[i].c_str());
}

}  // namespace

std::optional<Scenario> load_or_complain(const fs::path& file, const Overrides& overrides) {
  auto loaded = Scenario::load(file, overrides);
  if (loaded) return *std::move(loaded);
  const std::size_t count = loaded.error().size();
  report_error(kExitBadInput, loaded.error());
  report_error(kExitBadInput, std::to_string(count) + (count == 1 ? " problem" : " problems"));
  return std::nullopt;
}

std::optional<Mission> recorded_mission_or_complain(const fs::path& run_dir) {
  auto read = read_mission(run_dir);
  if (read) return *std::move(read);
  report_error(kExitBadInput, read.error());
  return std::nullopt;
}

double recorded_end_s(const fs::path& run_dir, const Mission& mission) {
  const auto summary = read_summary(run_dir);
  const auto read = recorded_amendments(run_dir, summary.value_or(Json()), mission);
  const ReceivedAmendments amendments = read.value_or(ReceivedAmendments());
  Tick end = tick_count_of(mission.timing, amendments.ends());
  if (!is_open(amendments.holds())) end = tick_after(amendments.holds(), end);
  return static_cast<double>(end) * mission.timing.dt_s;
}

Result<fs::path> prepare_run_directory(const fs::path& wanted, const Scenario& scenario) {
  const fs::path folder = wanted.empty() ? default_folder(scenario.name()) : wanted;
  std::error_code error;
  if (fs::exists(folder, error) && !fs::is_directory(folder, error)) {
    return failure("--out " + folder.string() + ": is a file; give a new folder");
  }
  if (fs::exists(folder, error) && !fs::is_empty(folder, error)) {
    return failure("--out " + folder.string() +
                   ": is not empty; give a new folder, or empty this one");
  }
  fs::create_directories(folder / "log", error);
  if (error)
    return failure("--out " + folder.string() + ": " + error.message() + "; give another folder");
  const std::vector<std::byte> bytes = encode_plan(scenario.mission());
  const std::string_view plan(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (auto problem = write_file(folder / kScenarioFile, scenario.print())) return failure(*problem);
  if (auto problem = write_file(folder / kPlanFile, plan)) return failure(*problem);
  if (auto problem = write_target_density(folder / kTargetDensityFile, scenario.target_density())) {
    return failure(*problem);
  }
  if (const auto& table = scenario.mission().basis.table) {
    if (auto problem = save_table(*table, folder)) return failure(*problem);
  }
  return folder;
}

void conclude(const fs::path& run_dir, const Json& summary, const Scenario& scenario) {
  const auto problem =
      write_report(run_dir, scenario.mission(), recorded_team(run_dir, scenario.mission()));
  print_summary(summary);
  print_amendments(run_dir, summary, scenario.mission());
  std::printf("  record    %s\n", run_dir.c_str());
  if (!problem) std::printf("  report    %s\n", (fs::absolute(run_dir) / "report.html").c_str());
  std::fflush(stdout);
  if (problem) report_error(kExitDone, "no report: " + *problem);
}

}  // namespace ergocast::cli
