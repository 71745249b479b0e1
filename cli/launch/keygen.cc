// SPDX-License-Identifier: BSD-3-Clause
// `ergocast keygen`: writes the two files of a new mission key.
#include <cstdio>
#include <memory>

#include "cli/commands.h"
#include "cli/launch/key_pair.h"
#include "cli/report_error.h"
#include "runtime/process/key_file.h"
#include "runtime/process/program_options.h"

namespace ergocast::cli {
namespace {

int make_keys(const std::string& name) {
  const std::string team = team_key_file(name), coordinator = coordinator_key_file(name);
  const MissionKey key = make_mission_key();
  // The coordinator's file first: the team's file is useless without it.
  if (const auto problem = write_key_file(coordinator, key_text(key, true)))
    return report_error(kExitBadInput, *problem);
  if (const auto problem = write_key_file(team, key_text(key, false))) {
    std::remove(coordinator.c_str());
    return report_error(kExitBadInput, *problem);
  }
  std::printf(
      "%s: for every agent, world, driver, logger and monitor\n"
      "%s: for processes that start, pause and end missions: coordinator, ergocast run, stop, "
      "pause, "
      "resume\n"
      "Copy them over a channel you trust; each program takes its own as --key-file or in "
      "ERGOCAST_KEY_FILE.\n",
      team.c_str(), coordinator.c_str());
  return kExitDone;
}

}  // namespace

void add_keygen(CLI::App& app, Action& action) {
  const auto name = std::make_shared<std::string>("mission");
  auto* command = app.add_subcommand(
      "keygen", "Make a mission key; a team with a key ignores messages from strangers");
  command->add_option("NAME", *name, "Writes NAME.key and NAME.coordinator.key, never over others")
      ->capture_default_str();
  command->footer(
      "A holder of NAME.key can send messages of any agent. Only NAME.coordinator.key signs the\n"
      "messages that begin and end missions. Nothing is encrypted.\n"
      "Exit codes: 0 done; 2 a file is there already or cannot be written.");
  command->callback([name, &action] { action = [name] { return make_keys(*name); }; });
}

}  // namespace ergocast::cli
