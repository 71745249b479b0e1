// SPDX-License-Identifier: BSD-3-Clause
// The assignment of processes to computers, and the files that start a mission on them. This code
// opens no file and starts no process. It does not trust names and paths.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "runtime/bus/lcm_url.h"
#include "scenario/scenario.h"

namespace ergocast {

struct DeployHost {
  std::string name;     ///< from the hosts file; a safe file name
  std::string address;  ///< "user@computer" for ssh; the name, if the file gives none
  bool coordinator = false, logger = false, sim = false;
  bool driver = false;            ///< a program of the user replaces the world
  std::string hub;                ///< "HOST:PORT" where relays join it; empty: it is no hub
  bool relay = false;             ///< it carries the messages of its site
  int relay_kbit_per_s = 0;       ///< --max-rate of that relay; 0: no limit
  std::vector<std::string> hubs;  ///< of all hosts, in the order of the file
  std::vector<int> agents;        ///< ascending
};

/// "coordinator, logger, agents 0 1", for people.
std::string roles_of(const DeployHost& host);

/// Reads a hosts file, one computer in each line: `name [user@computer] role…` with the roles
/// `coordinator`, `logger`, `sim`, `driver`, `agent N…`, `agents=COUNT` (which takes free numbers),
/// `hub=HOST:PORT`, `relay` and `relay=KBIT/S`. `#` begins a comment. Returns all problems at once;
/// they name the file as `file`.
Result<std::vector<DeployHost>, std::vector<Problem>> parse_hosts(std::string_view text,
                                                                  const std::string& file);

/// The mission to deploy.
struct DeployMission {
  std::string name;
  std::filesystem::path folder;  ///< whole path of the scenario's folder
  std::vector<std::string>
      files;  ///< the scenario's file in `folder`, then its maps, relative to it
  int quorum = 1;
  bool lockstep = false;
  /// Options of the coordinator that change the scenario, as the words of a command.
  std::vector<std::string> overrides;
  LcmUrl url;
  /// Whole path of the mission key, as in `ergocast keygen`; empty: none.
  std::filesystem::path keys;
  /// Name of the file with the mission's table of modes, which is beside the written files. Empty:
  /// none, and each host computes the table if the mission needs one.
  std::string modes;
};

/// Problems of a valid hosts file with this mission. The problems name the file as `file`.
/// @param apart  the processes use separate networks: hosts or containers
std::vector<Problem> problems_of(const std::vector<DeployHost>& hosts, const DeployMission& mission,
                                 const std::string& file, bool apart);

struct DeployProcess {
  std::string name;                  ///< "agent-3", "logger", "sim"
  std::vector<std::string> command;  ///< program and arguments, without the URL
};

/// The name of the process that is a host's relay, hub or both. It does not end with the mission.
inline constexpr const char* kRelayProcess = "relay";

/// All processes but the coordinator, in the order of their start. Records go into "record".
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
