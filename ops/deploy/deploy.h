// SPDX-License-Identifier: BSD-3-Clause
// Which computer does what in a mission on several of them, and the texts that make them do it.
// Nothing here opens a file or starts a process; names and paths are not trusted.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "runtime/lcm_url.h"
#include "scenario/scenario.h"

namespace ergocast {

struct DeployHost {
  std::string name;     ///< as the hosts file calls it; a safe file name
  std::string address;  ///< "user@computer" for ssh; the name, if the file gives none
  bool coordinator = false, logger = false, sim = false;
  bool driver = false;      ///< something that is not ours takes the world's place
  std::vector<int> agents;  ///< ascending
};

/// "coordinator, logger, agents 0 1", for people.
std::string roles_of(const DeployHost& host);

/// Reads a hosts file, one computer a line: `name [user@computer] role…` with the roles
/// `coordinator`, `logger`, `sim`, `driver`, `agent N…` and `agents=COUNT` (whichever numbers are
/// free). `#` begins a comment. All problems at once; `file` is what they call it.
std::variant<std::vector<DeployHost>, std::vector<Problem>> parse_hosts(std::string_view text,
                                                                        const std::string& file);

/// What is to be flown.
struct DeployMission {
  std::string name;
  std::filesystem::path folder;  ///< whole path of the scenario's folder
  std::vector<std::string>
      files;  ///< the scenario's file in `folder`, then its maps, relative to it
  int quorum = 1;
  LcmUrl url;
  /// Whole path of the mission key, as `ergocast keygen` was given it; empty: none.
  std::filesystem::path keys;
};

/// What a sound hosts file lacks for this mission. `file` is what the problems call it.
/// @param apart  the processes have several networks: hosts or containers
std::vector<Problem> problems_of(const std::vector<DeployHost>& hosts, const DeployMission& mission,
                                 const std::string& file, bool apart);

struct DeployProcess {
  std::string name;                  ///< "agent-3", "logger", "sim"
  std::vector<std::string> command;  ///< program and arguments, without the URL
};

/// All but the coordinator, in the order in which they are started. Records go into "record".
std::vector<DeployProcess> processes_of(const DeployHost& host);

struct TextFile {
  std::string name;
  std::string text;
  bool executable = false;
};

/// One script that starts, shows, stops and collects the mission over ssh.
std::vector<TextFile> ssh_files(const std::vector<DeployHost>& hosts, const DeployMission& mission);
/// One script that sets up the installed systemd services of every host over ssh.
std::vector<TextFile> systemd_files(const std::vector<DeployHost>& hosts,
                                    const DeployMission& mission);
/// A Compose file for every host; a single host's containers have a bridge of their own.
std::vector<TextFile> compose_files(const std::vector<DeployHost>& hosts,
                                    const DeployMission& mission);

}  // namespace ergocast
