// ergocast: the command a person types.
#include <cstdio>
#include <functional>

#include "cli/commands.h"
#include "runtime/node.h"

namespace ergocast::cli {
namespace {

constexpr const char* kExitCodes =
    "Exit codes: 0 done; 1 verify: the run differs; 2 bad scenario, arguments or run directory;\n"
    "3 LCM cannot be used on this machine; 4 the mission failed or its record broke off.";

void add_mission_options(CLI::App& command, MissionOptions& options) {
  command.add_option("SCENARIO", options.scenario, "Scenario file (scenarios/*.textproto)")
      ->required()
      ->type_name("FILE");
  command
      .add_option("--out", options.out,
                  "Run directory: new or empty (default: runs/<scenario>-<time>)")
      ->type_name("DIR");
  command.add_option("--seed", options.overrides.seed, "Other random numbers")
      ->check([](const std::string& text) {
        return text.starts_with('-') ? "--seed must not be negative" : std::string();
      });
  command.add_option("--duration", options.overrides.duration_s, "Mission time [s]");
  command.add_option("--agents", options.overrides.agents,
                     "Team size: listed starts are cut, or random ones added");
  auto* lockstep = command.add_flag_callback(
      "--lockstep", [&options] { options.overrides.pace = Pace::kLockstep; },
      "As fast as the machine goes, bit for bit repeatable");
  command
      .add_option_function<double>(
          "--realtime",
          [&options](double factor) {
            options.overrides.pace = Pace::kRealtime;
            options.overrides.realtime_factor = factor;
          },
          "By the wall clock, FACTOR times as fast (default 1)")
      ->expected(0, 1)
      ->default_str("1")
      ->type_name("FACTOR")
      ->excludes(lockstep);
}

void add_url_option(CLI::App& command, MissionOptions& options) {
  command.add_option_function<std::string>(
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

int parse_and_do(int argc, char** argv) {
  CLI::App app("Ergocast: teams of robots that spread their time over a region as a map demands.",
               "ergocast");
  app.require_subcommand(1);
  app.set_version_flag("--version", version_text());
  app.footer(kExitCodes);
  MissionOptions mission;
  std::filesystem::path path;
  bool print = false;
  std::function<int()> action;

  auto* run_command = app.add_subcommand("run", "Run a mission as processes over LCM on this host");
  add_mission_options(*run_command, mission);
  add_url_option(*run_command, mission);
  run_command->callback([&] { action = [&] { return run(mission); }; });

  auto* simulate_command =
      app.add_subcommand("simulate", "Run a mission in this process, in virtual time");
  add_mission_options(*simulate_command, mission);
  simulate_command->callback([&] { action = [&] { return simulate(mission); }; });

  auto* check_command = app.add_subcommand("check", "Name every problem of a scenario");
  check_command->add_option("SCENARIO", path, "Scenario file")->required()->type_name("FILE");
  check_command->add_flag("--print", print, "Show the scenario with all defaults filled in");
  check_command->callback([&] { action = [&] { return check(path, print); }; });

  auto* report_command = app.add_subcommand("report", "Make a run's report again");
  report_command->add_option("RUN_DIR", path, "Run directory")->required()->type_name("DIR");
  report_command->callback([&] { action = [&] { return report(path); }; });

  auto* verify_command =
      app.add_subcommand("verify", "Simulate a recorded run again and compare the trajectories");
  verify_command->add_option("RUN_DIR", path, "Run directory")->required()->type_name("DIR");
  verify_command->callback([&] { action = [&] { return verify(path); }; });

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
    std::fprintf(stderr, "ergocast: %s\n", error.what());
    return ergocast::kExitFailed;
  }
}
