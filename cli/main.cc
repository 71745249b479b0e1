// SPDX-License-Identifier: BSD-3-Clause
// ergocast: parses the command line and runs the selected command.
#include <algorithm>
#include <cstdio>
#include <functional>
#include <string_view>
#include <thread>

#include "cli/commands.h"
#include "cli/report_error.h"
#include "runtime/node.h"
#include "runtime/shipped_scenarios.h"
#include "scenario/override_options.h"
#include "text/read_number.h"

namespace ergocast::cli {
namespace {

constexpr std::uint64_t kMostSeeds = 1000000000;
constexpr const char* kExitCodes =
    "Exit codes: 0 done; 1 verify, status or doctor found something; 2 bad scenario, arguments or\n"
    "run directory; 3 LCM cannot be used on this machine; 4 the mission failed or its record "
    "broke\n"
    "off, some of many missions failed, or stop, pause or resume did not see the team obey.";

void add_mission_options(CLI::App& command, MissionOptions& options) {
  command.add_option("SCENARIO", options.scenario, "Scenario file, or the name of a shipped one")
      ->required()
      ->transform(shipped_scenario())
      ->type_name("FILE");
  command
      .add_option("--out", options.out,
                  "Run directory: new or empty (default: runs/<scenario>-<time>)")
      ->type_name("DIR");
  add_override_options(command, options.overrides);
}

void add_url_option(CLI::App& command, MissionOptions& options) {
  command
      .add_option_function<std::string>(
          "--lcm-url",
          [&options](const std::string& text) {
            auto parsed = LcmUrl::parse(text);
            if (const auto* problem = std::get_if<std::string>(&parsed)) {
              throw CLI::ValidationError("--lcm-url", *problem);
            }
            options.url = std::get<LcmUrl>(parsed);
          },
          "Base URL of the three buses (default: this host, free ports of the run's own)")
      ->type_name("URL");
}

/// "A:B" or "A".
Seeds parse_seeds(const std::string& text) {
  const auto number = [&text](std::string_view part) {
    const auto value = read_number<std::uint64_t>(part);
    if (value) return *value;
    throw CLI::ValidationError("--seeds", "\"" + text + "\" is neither a number nor FIRST:LAST");
  };
  const std::string_view view = text;
  const std::size_t colon = view.find(':');
  if (colon == std::string_view::npos) return {number(view), number(view)};
  const Seeds seeds{number(view.substr(0, colon)), number(view.substr(colon + 1))};
  if (seeds.last < seeds.first || seeds.last - seeds.first >= kMostSeeds) {
    throw CLI::ValidationError("--seeds", text + ": the last must not be before the first, nor " +
                                              std::to_string(kMostSeeds) + " after it");
  }
  return seeds;
}

void add_trial_options(CLI::App& command, TrialsOptions& options) {
  auto* seeds =
      command
          .add_option_function<std::string>(
              "--seeds", [&options](const std::string& text) { options.seeds = parse_seeds(text); },
              "One mission for each seed, in the laboratory; --out is a CSV file then")
          ->type_name("FIRST:LAST")
          ->excludes("--seed");
  command
      .add_option("--faults", options.faults,
                  "What goes wrong: a file, or \"swarm\": each seed draws")
      ->type_name("FILE|swarm")
      ->needs(seeds);
  command.add_option("--jobs", options.jobs, "Worker processes (default: one a processor)")
      ->check(CLI::Range(1, 1024))
      ->needs(seeds);
}

/// "field=a,b,c".
Variation parse_variation(const std::string& text) {
  const auto refuse = [&text](const std::string& why) {
    throw CLI::ValidationError("--vary", "\"" + text + "\" " + why);
  };
  const auto [path, list] = split_field(text, "--vary", "FIELD=VALUE,VALUE…");
  Variation variation{path, {}};
  for (std::size_t begin = 0; begin <= list.size();) {
    const std::size_t end = std::min(list.find(',', begin), list.size());
    const std::string value = list.substr(begin, end - begin);
    if (value.find_first_not_of(" \t") == std::string::npos) refuse("has an empty value");
    const auto& values = variation.values;
    if (std::find(values.begin(), values.end(), value) != values.end())
      refuse("has " + value + " twice");
    variation.values.push_back(value);
    begin = end + 1;
  }
  return variation;
}

/// "I/N".
StudyShard parse_shard(const std::string& text) {
  const std::string_view view = text;
  const std::size_t slash = std::min(view.find('/'), view.size());
  const auto index = read_number<std::uint64_t>(view.substr(0, slash));
  const auto of = read_number<std::uint64_t>(view.substr(std::min(slash + 1, view.size())));
  if (!index || !of || *index < 1 || *index > *of || *of > kMostStudyRuns) {
    throw CLI::ValidationError("--shard",
                               "\"" + text + "\" is not I/N with I from 1 to N, such as 2/8");
  }
  StudyShard shard;
  shard.index = *index;
  shard.of = *of;
  return shard;
}

void add_study_options(CLI::App& command, StudyOptions& options) {
  command.add_option("SCENARIO", options.scenarios, "Scenario files, or names of shipped ones")
      ->transform(shipped_scenario())
      ->type_name("FILE");
  command
      .add_option_function<std::vector<std::string>>(
          "--vary",
          [&options](const std::vector<std::string>& texts) {
            for (const std::string& text : texts)
              options.variations.push_back(parse_variation(text));
          },
          "A field and its values, such as law.noise_intensity=0,0.1,1; again for another field")
      ->allow_extra_args(false)
      ->type_name("FIELD=VALUE,…");
  add_set_option(command, options.settings);
  command
      .add_option_function<std::string>(
          "--seeds", [&options](const std::string& text) { options.seeds = parse_seeds(text); },
          "One mission of every combination for each seed")
      ->required()
      ->type_name("FIRST:LAST");
  command
      .add_option_function<std::string>(
          "--shard", [&options](const std::string& text) { options.shard = parse_shard(text); },
          "Only part I of N of the missions; `study merge` joins the folders of all parts")
      ->type_name("I/N");
  command.add_option("--out", options.out, "The study's folder: new, or one to go on in")
      ->required()
      ->type_name("DIR");
  command.add_option("--duration", options.duration_s, "Mission time [s]");
  command.add_option("--jobs", options.jobs, "Worker processes (default: one a processor)")
      ->check(CLI::Range(1, 1024));
}

/// `study merge`, whose options are not those of `study`.
CLI::App* add_merge(CLI::App& study, MergeOptions& options) {
  auto* command = study.add_subcommand("merge", "Join the folders of all shards of one study");
  command->add_option("FOLDER", options.shards, "The folder of each shard")
      ->required()
      ->type_name("DIR");
  command->add_option("--out", options.out, "The study's folder: new or empty")
      ->required()
      ->type_name("DIR");
  command->preparse_callback([&study](std::size_t) {
    for (CLI::Option* option : study.get_options()) {
      if (option->count() > 0) throw CLI::ValidationError("merge", "stands before all options");
      option->required(false);
    }
  });
  return command;
}

int parse_and_do(int argc, char** argv) {
  CLI::App app("Ergocast: teams of robots that spread their time over a region as a map demands.",
               "ergocast");
  app.require_subcommand(1);
  app.set_version_flag("--version", version_text());
  MissionOptions mission;
  std::filesystem::path path;
  bool print = false;
  Action action;

  auto* run_command = app.add_subcommand("run", "Run a mission as processes over LCM on this host");
  add_mission_options(*run_command, mission);
  add_url_option(*run_command, mission);
  add_key_option(*run_command, mission.authenticator, &mission.key_file);
  add_event_log_options(*run_command, mission.event_log_mib, mission.event_log_zstd);
  run_command
      ->add_option("--world", mission.world,
                   "Start this program in the place of ergocast-sim: a driver of robots or another "
                   "simulation; a name without '/' is one beside ergocast")
      ->type_name("PROGRAM");
  run_command
      ->add_option("--world-arg", mission.world_arguments,
                   "Argument of that program, as in --world-arg=--robots --world-arg=quadrotors; "
                   "again for another one")
      ->type_name("ARG")
      ->allow_extra_args(false)
      ->needs("--world");
  run_command->add_flag("--watch", mission.watch,
                        "Show it in a browser, and the record afterwards, until Ctrl-C");
  add_page_options(*run_command, mission.page);
  for (const char* option : {"--port", "--listen"})
    run_command->get_option(option)->needs("--watch");
  run_command->callback([&] { action = [&] { return run(mission); }; });

  auto* simulate_command =
      app.add_subcommand("simulate", "Run a mission in this process, in virtual time");
  add_mission_options(*simulate_command, mission);
  const int processors = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  TrialsOptions trial_options;
  trial_options.jobs = processors;
  add_trial_options(*simulate_command, trial_options);
  simulate_command
      ->add_flag("--event-log", mission.event_log,
                 "Write every message, as run does: events-000.lcm …")
      ->excludes("--seeds");
  simulate_command->callback([&] {
    action = [&] {
      if (simulate_command->count("--seeds") == 0) return simulate(mission);
      trial_options.mission = mission;
      return trials(trial_options);
    };
  });

  auto* study_command = app.add_subcommand(
      "study", "Compare many simulated missions: scenarios, varied fields, seeds");
  StudyOptions study_options;
  study_options.jobs = processors;
  add_study_options(*study_command, study_options);
  MergeOptions merge_options;
  const CLI::App* merge_command = add_merge(*study_command, merge_options);
  study_command->callback([&, merge_command] {
    action = [&] { return study(study_options); };
    if (merge_command->parsed()) action = [&] { return merge_studies(merge_options); };
    // CLI11 would read "merge" as the required scenario.
    if (!merge_command->parsed() && study_options.scenarios.empty())
      throw CLI::RequiredError("SCENARIO");
  });

  auto* check_command = app.add_subcommand("check", "Name every problem of a scenario");
  check_command->add_option("SCENARIO", path, "Scenario file, or the name of a shipped one")
      ->required()
      ->transform(shipped_scenario())
      ->type_name("FILE");
  check_command->add_flag("--print", print, "Show the scenario with all defaults filled in");
  add_override_options(*check_command, mission.overrides);
  check_command->callback([&] { action = [&] { return check(path, mission.overrides, print); }; });

  auto* report_command = app.add_subcommand("report", "Make a run's report again");
  report_command->add_option("RUN_DIR", path, "Run directory")->required()->type_name("DIR");
  report_command->callback([&] { action = [&] { return report(path); }; });

  auto* verify_command =
      app.add_subcommand("verify", "Simulate a recorded run again and compare the trajectories");
  verify_command->add_option("RUN_DIR", path, "Run directory")->required()->type_name("DIR");
  verify_command->callback([&] { action = [&] { return verify(path); }; });

  add_keygen(app, action);
  add_deploy(app, action);
  add_list(app, action);
  add_status(app, action);
  add_watch(app, action);
  add_run_page(app, action);
  add_export(app, action);
  add_replay(app, action);
  add_pause(app, action);
  add_stop(app, action);
  add_spy(app, action);
  add_doctor(app, action);

  app.footer(kExitCodes);  // set last, or each command without its own footer would inherit it
  for (CLI::App* command : app.get_subcommands({})) {
    command->set_version_flag("--version", version_text());
  }
  if (const int code = parse_command_line(app, argc, argv); code >= 0) return code;
  return action();
}

}  // namespace
}  // namespace ergocast::cli

int main(int argc, char** argv) {
  try {
    return ergocast::cli::parse_and_do(argc, argv);
  } catch (const std::exception& error) {
    ergocast::cli::print_message(std::string("ergocast: ") + error.what());
    return ergocast::kExitFailed;
  }
}
