// SPDX-License-Identifier: BSD-3-Clause
// `ergocast new`: writes a scenario for robots in the rooms of a map, and what to do with it.
#include <cstdio>
#include <memory>

#include "cli/commands.h"
#include "cli/report_error.h"
#include "core/base/ids.h"
#include "logger/run_record.h"
#include "runtime/process/program_options.h"
#include "scenario/new_scenario.h"
#include "text/printable.h"

namespace ergocast::cli {
namespace {

namespace fs = std::filesystem;

struct NewOptions {
  fs::path map, out;
  NewTeam team;
};

int make_new(const NewOptions& options) {
  const fs::path file =
      options.out.empty() ? options.map.filename().replace_extension(".textproto") : options.out;
  std::error_code error;
  if (fs::exists(file, error))
    return report_error(kExitBadInput,
                        file.string() + " is there already: remove it, or write --out");
  const auto made = new_scenario(options.map, file, options.team);
  if (!made) return report_error(kExitBadInput, made.error());
  if (const auto problem = write_file(file, made->text))
    return report_error(kExitBadInput, *problem);
  for (const Problem& warning : made->warnings) print_message("warning: " + to_string(warning));
  const std::string name = printable(file.string());
  std::printf(
      "%s: %d robots; their centres can be in %.3g m^2\n"
      "  ergocast simulate %s\n"
      "  ergocast run %s --watch\n"
      "edit first: agents.starts (where your robots stand), target, time.duration_s\n",
      name.c_str(), options.team.robots, made->free_m2, name.c_str(), name.c_str());
  return kExitDone;
}

}  // namespace

void add_new(CLI::App& app, Action& action) {
  auto options = std::make_shared<NewOptions>();
  auto* command = app.add_subcommand("new", "Write a scenario for robots in the rooms of a map");
  command
      ->add_option("--map", options->map,
                   "The map: the .yaml that map_server or nav2 wrote beside the picture")
      ->type_name("FILE")
      ->required();
  command->add_option("--robots", options->team.robots, "The number of robots")
      ->check(CLI::Range(1, kMaxAgents))
      ->capture_default_str();
  command->add_option("--speed", options->team.speed_mps, "Their speed limit [m/s]")
      ->check(CLI::Range(1e-3, 1e3))
      ->capture_default_str();
  command->add_option("--radius", options->team.radius_m, "Their radius [m]")
      ->check(CLI::Range(1e-3, 1e3))
      ->capture_default_str();
  command
      ->add_option("--out", options->out,
                   "The scenario to write, never over another file. Default: the map's name, with "
                   ".textproto")
      ->type_name("FILE");
  command->footer(
      "The scenario names the map by its place, covers all that the robots can reach, and passes\n"
      "`ergocast check`. Exit codes: 0 done; 2 the map has no such room, or a file is there "
      "already.");
  command->callback([&action, options] { action = [options] { return make_new(*options); }; });
}

}  // namespace ergocast::cli
