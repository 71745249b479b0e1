// SPDX-License-Identifier: BSD-3-Clause
// `ergocast deploy`: reads the scenario and the list of hosts, and prints or writes the files
// that cli/deploy makes.
#include <algorithm>
#include <cctype>
#include <cstdio>
#include <fstream>
#include <memory>

#include "cli/command_text.h"
#include "cli/commands.h"
#include "cli/deploy/deploy.h"
#include "cli/launch/key_pair.h"
#include "cli/record/run_directory.h"
#include "cli/report_error.h"
#include "core/mission/sites.h"
#include "core/motion/filter_rules.h"
#include "logger/run_record.h"
#include "modes/table_file.h"
#include "runtime/process/program_options.h"
#include "runtime/process/shipped_scenarios.h"
#include "scenario/parse/override_options.h"
#include "text/input_file.h"

namespace ergocast::cli {
namespace {

namespace fs = std::filesystem;

/// A line for one host has about twenty bytes.
/// Limit (Commands): length of a file of hosts [bytes]. Beyond it: `deploy` refuses it.
constexpr std::size_t kMaxHostsBytes = std::size_t{1} << 18;

struct DeployOptions {
  fs::path scenario, hosts, out;
  std::string to, keys;
  Overrides overrides;
  std::optional<LcmUrl> url;
};

/// Whether a relative path is plain enough for shells, settings files and remote folders.
bool is_plain(const std::string& path) {
  constexpr std::string_view kOthers = "/._-+";
  return !path.starts_with('-') && !path.starts_with("../") &&
         std::all_of(path.begin(), path.end(), [&](unsigned char c) {
           return (c < 128 && std::isalnum(c) != 0) ||
                  kOthers.find(static_cast<char>(c)) != kOthers.npos;
         });
}

/// The options with which the coordinator makes the same changes to the scenario. A service splits
/// them at spaces.
std::vector<std::string> overrides_of(const DeployOptions& options,
                                      std::vector<Problem>& problems) {
  std::vector<std::string> words = words_of(options.overrides);
  if (options.overrides.seed) {
    words.insert(words.end(), {"--seed", std::to_string(*options.overrides.seed)});
  }
  for (const std::string& word : words) {
    const bool splits = word.find_first_of(" \t\n'\"\\$`") != word.npos;
    if (!splits || options.to != "systemd") continue;
    problems.push_back({word, "has a character that a service's settings cannot hold",
                        "write the value into the scenario file"});
  }
  return words;
}

DeployMission mission_of(const Scenario& scenario, const DeployOptions& options,
                         std::vector<Problem>& problems) {
  const fs::path& file = options.scenario;
  DeployMission mission;
  mission.name = scenario.name();
  mission.quorum = scenario.mission().quorum;
  mission.lockstep = scenario.mission().timing.pace == Pace::kLockstep;
  mission.overrides = overrides_of(options, problems);
  const fs::path whole = fs::absolute(file).lexically_normal();
  mission.folder = whole.parent_path();
  mission.files.push_back(whole.filename());
  for (const fs::path& map : scenario.map_files()) {
    mission.files.push_back(map.lexically_relative(mission.folder).string());
  }
  for (const fs::path& named : scenario.files_by_whole_path()) {
    std::erase(mission.files, named.lexically_normal().lexically_relative(mission.folder).string());
    problems.push_back({file.string(),
                        "\"" + named.string() +
                            "\" is a whole path, so it cannot be copied to "
                            "another host",
                        "keep the file in the scenario's folder or below, and name it relative to "
                        "that folder"});
  }
  for (const std::string& name : mission.files) {
    if (is_plain(name)) continue;
    problems.push_back({file.string(), "\"" + name + "\" cannot be copied to another host",
                        "keep it in the scenario's folder or below, and give it a name of letters, "
                        "digits, dots, hyphens and underscores"});
  }
  return mission;
}

Result<std::vector<DeployHost>, std::vector<Problem>> read_hosts(const fs::path& file) {
  const auto read = read_whole(file, kMaxHostsBytes);
  if (!read)
    return failure(std::vector<Problem>{{file.string(), read.error().what, read.error().remedy}});
  return parse_hosts(*read, file.string());
}

int print(const std::vector<TextFile>& files) {
  for (const TextFile& file : files) {
    if (files.size() > 1) std::printf("# ---- %s\n", file.name.c_str());
    std::fputs(file.text.c_str(), stdout);
  }
  return kExitDone;
}

/// Writes all files, or none if one of them exists already.
int write_files(const std::vector<TextFile>& files, const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  for (const TextFile& file : files) {
    if (!fs::exists(fs::symlink_status(folder / file.name, error))) continue;
    return report_error(kExitBadInput, to_string(Problem{"--out " + folder.string(),
                                                         file.name + " is there already",
                                                         "give a new folder, or remove the file"}));
  }
  for (const TextFile& file : files) {
    const fs::path path = folder / file.name;
    if (const auto problem = write_file(path, file.text))
      return report_error(kExitBadInput, *problem);
    const auto mode = fs::perms::owner_exec | fs::perms::group_exec | fs::perms::others_exec;
    if (file.executable) fs::permissions(path, mode, fs::perm_options::add, error);
    std::printf("%s\n", path.c_str());
  }
  return kExitDone;
}

/// Copies the table of modes that `mission` names to the folder of the written files.
int write_modes(const DeployMission& mission, const Basis& basis, const fs::path& folder) {
  if (mission.modes.empty()) return kExitDone;
  if (const auto problem = save_table(*basis.table, folder))
    return report_error(kExitBadInput, *problem);
  std::printf("%s\n", (folder / mission.modes).c_str());
  return kExitDone;
}

/// The user starts the drivers if each robot has its own.
void note_drivers(const Mission& mission, const std::vector<DeployHost>& hosts, const LcmUrl& url) {
  const bool driven = std::ranges::any_of(hosts, &DeployHost::driver);
  if (!driven || !uses_beacons(mission)) return;
  std::fprintf(stderr,
               "note: each robot needs a driver of your own, and these files start none. Start one "
               "beside agent N, such as ergocast-example-driver --id N --lcm-url '%s'\n",
               url.base().c_str());
}

/// Scripts read the table from their own folder.
void note_modes(const DeployOptions& options, const Basis& basis) {
  if (!basis.free_domain || !options.out.empty()) return;
  std::fprintf(stderr,
               "note: the table of the free domain's modes is written only with --out DIR; without "
               "it each host computes the table when the mission begins\n");
}

int deploy(const DeployOptions& options) {
  const auto scenario = load_or_complain(options.scenario, options.overrides);
  if (!scenario) return kExitBadInput;
  if (scenario->mission().sites.any()) return report_error(kExitBadInput, kSitesAreSimulated);
  const auto read = read_hosts(options.hosts);
  if (!read) return report_error(kExitBadInput, read.error());
  const auto& hosts = *read;

  std::vector<Problem> problems;
  DeployMission mission = mission_of(*scenario, options, problems);
  const bool apart = hosts.size() > 1 || options.to == "compose";
  if (apart) mission.url.ttl = 1;
  mission.url = options.url.value_or(mission.url);
  if (!options.keys.empty()) mission.keys = fs::absolute(options.keys).lexically_normal();
  for (Problem& problem : problems_of(hosts, mission, options.hosts.string(), apart)) {
    problems.push_back(std::move(problem));
  }
  if (!problems.empty()) return report_error(kExitBadInput, problems);
  if (!options.keys.empty()) {
    if (const auto problem = problem_of_key_pair(options.keys))
      return report_error(kExitBadInput, *problem);
  }
  const Basis& basis = scenario->mission().basis;
  if (basis.free_domain && !options.out.empty()) mission.modes = table_file_name(basis.table_hash);
  const auto render = options.to == "ssh"       ? ssh_files
                      : options.to == "systemd" ? systemd_files
                                                : compose_files;
  const std::vector<TextFile> files = render(hosts, mission);
  note_modes(options, basis);
  note_drivers(scenario->mission(), hosts, mission.url);
  if (options.out.empty()) return print(files);
  const int written = write_files(files, options.out);
  return written == kExitDone ? write_modes(mission, basis, options.out) : written;
}

}  // namespace

void add_deploy(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand(
      "deploy", "Write the files that start a mission on several hosts; starts nothing");
  const auto options = std::make_shared<DeployOptions>();
  command->add_option("SCENARIO", options->scenario, "Scenario file, or the name of a shipped one")
      ->required()
      ->transform(shipped_scenario())
      ->type_name("FILE");
  command
      ->add_option("--hosts", options->hosts,
                   "One host a line: name [user@computer] roles, which are coordinator, logger, "
                   "sim, driver (your program that moves vehicles), agent N…, agents=COUNT, "
                   "hub=HOST:PORT where relays join, and relay or relay=KBIT/S, one for each site")
      ->required()
      ->type_name("FILE");
  command
      ->add_option("--to", options->to,
                   "A script over ssh, one that uses the installed services, or Compose files")
      ->required()
      ->check(CLI::IsMember({"ssh", "systemd", "compose"}).description(""))
      ->type_name("ssh|systemd|compose");
  command
      ->add_option_function<std::string>(
          "--lcm-url",
          [options](const std::string& text) {
            auto parsed = LcmUrl::parse(text);
            if (!parsed) throw CLI::ValidationError("--lcm-url", parsed.error());
            options->url = *parsed;
          },
          "Base URL of the three buses (default: LCM's own group, with ttl=1 if it takes one)")
      ->type_name("URL");
  command
      ->add_option("--keys", options->keys,
                   "The team's mission key, as given to `ergocast keygen`: NAME.key goes to every "
                   "host, NAME.coordinator.key to the coordinator's (default: no key)")
      ->type_name("NAME");
  add_override_options(*command, options->overrides);
  command
      ->add_option("--out", options->out,
                   "Write into this folder (default: to the standard output)")
      ->type_name("DIR");
  command->callback([options, &action] { action = [options] { return deploy(*options); }; });
}

}  // namespace ergocast::cli
