// SPDX-License-Identifier: BSD-3-Clause
// Writes one Compose file for each host, with every string quoted for YAML and for Compose.
#include <cstdio>

#include "cli/deploy/deploy.h"

namespace ergocast {
namespace {

/// Quotes a string so that YAML and Compose read it back unchanged; Compose replaces $ by
/// variables.
std::string yaml(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '$') quoted += '$';
    if (c == '"' || c == '\\') quoted += '\\';
    if (static_cast<unsigned char>(c) >= 0x20) {
      quoted += c;
    } else {
      char escape[8];
      std::snprintf(escape, sizeof escape, "\\x%02x", static_cast<unsigned>(c));
      quoted += escape;
    }
  }
  return quoted + '"';
}

std::string list(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "[" : ", ") + yaml(word);
  return text + ']';
}

constexpr const char* kTeamKey = "./mission.key";
constexpr const char* kCoordinatorKey = "./mission.coordinator.key";

/// Unlike Compose's short form, this form does not create a folder for a missing file.
std::string mount(const std::string& source, const std::string& target) {
  return "      - type: bind\n        source: " + yaml(source) + "\n        target: " + target +
         "\n        read_only: true\n";
}

std::string service(const std::string& name, const char* restart,
                    const std::vector<std::string>& command, const std::string& volumes,
                    const std::string& more = "") {
  return "  " + name + ":\n    <<: *ergocast\n    restart: " + restart +
         "\n    entrypoint: " + list(command) + "\n    command: []\n" + more +
         (volumes.empty() ? "" : "    volumes:\n" + volumes);
}

/// Exit codes 2 (bad input) and 4 (the mission failed) become 0, because a restart repairs neither.
std::vector<std::string> unless_in_vain(std::vector<std::string> command) {
  command.insert(command.begin(), {"tini", "-e", "2", "-e", "4", "--"});
  return command;
}

/// Comments that name the files needed beside the Compose file, and their owner.
std::string key_head(const DeployHost& host, const DeployMission& mission) {
  if (mission.keys.empty()) return "";
  const std::string name = mission.keys.string();
  const bool team = !processes_of(host).empty();
  std::string text =
      "# Beside this file have to lie, owned by the image's user 1000 and with mode 600,\n";
  const auto copy = [&text](const std::string& file, const std::string& of) {
    text += "#   " + file + ", a copy of " + yaml(of) + '\n';
  };
  if (team) copy(kTeamKey, name + ".key");
  if (host.coordinator) copy(kCoordinatorKey, name + ".coordinator.key");
  return text;
}

std::string head(const DeployHost& host, const DeployMission& mission, const std::string& name) {
  std::string text = "# " + mission.name + " on " + host.name + ": " + roles_of(host) +
                     ". Written by \"ergocast deploy\".\n#   docker-compose -f " + name +
                     " up\n# Ctrl-C ends it in order.\n";
  if (host.coordinator) {
    text += "# The scenario is read from " + yaml(mission.folder.string()) +
            " of that host. Start it last: it waits\n# for the team for as long as the scenario "
            "says.\n";
  }
  if (host.logger)
    text += "# The record goes into a folder below ./runs, a new one for every mission.\n";
  if (!mission.modes.empty())
    text += "# Beside this file has to lie " + mission.modes + ", the modes of the free domain.\n";
  return text + key_head(host, mission);
}

/// @param alone  there is no other host: the containers use a bridge network
std::string compose_text(const DeployHost& host, const DeployMission& mission, bool alone) {
  std::string text =
      "version: \"3.8\"\n\nx-ergocast: &ergocast\n  image: ergocast\n  environment:\n    "
      "LCM_DEFAULT_URL: " +
      yaml(mission.url.base()) + '\n';
  const bool keyed = !mission.keys.empty();
  if (keyed) text += "    ERGOCAST_KEY_FILE: /mission.key\n";
  if (!mission.modes.empty()) text += "    ERGOCAST_MODES: /modes.bin\n";
  const std::string modes = mission.modes.empty() ? "" : mount("./" + mission.modes, "/modes.bin");
  const std::string mounts = modes + (keyed ? mount(kTeamKey, "/mission.key") : "");
  text += "  stop_grace_period: 30s\n";
  if (!alone) text += "  network_mode: host\n";
  text += "\nservices:\n";
  for (const DeployProcess& process : processes_of(host)) {
    // The image's script writes each mission into a new folder that belongs to the owner of ./runs.
    text +=
        process.name == "logger"
            ? service("logger", "\"on-failure:5\"", {"record"}, "      - ./runs:/runs\n" + mounts,
                      "    user: root\n")
            : service(process.name, "\"on-failure:5\"", unless_in_vain(process.command), mounts);
  }
  if (host.coordinator) {
    // A restarted coordinator would begin a second mission.
    std::vector<std::string> command{"ergocast-coordinator", "/mission/" + mission.files.front()};
    command.insert(command.end(), mission.overrides.begin(), mission.overrides.end());
    text += service("coordinator", "\"no\"", command,
                    mount(mission.folder.string(), "/mission") + modes +
                        (keyed ? mount(kCoordinatorKey, "/mission.key") : ""));
  }
  return text;
}

}  // namespace

std::vector<TextFile> compose_files(const std::vector<DeployHost>& hosts,
                                    const DeployMission& mission) {
  std::vector<TextFile> files;
  for (const DeployHost& host : hosts) {
    if (processes_of(host).empty() && !host.coordinator) continue;
    // The sites join a hub through the host's network.
    const bool relays = host.relay || !host.hub.empty();
    const bool alone = hosts.size() == 1 && !relays;
    const std::string name = (hosts.size() == 1 ? "" : host.name + '.') + "compose.yaml";
    files.push_back({name, head(host, mission, name) + compose_text(host, mission, alone)});
  }
  return files;
}

}  // namespace ergocast
