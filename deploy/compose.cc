#include <cstdio>

#include "deploy/deploy.h"

namespace ergocast {
namespace {

/// A string as YAML and Compose read it back, whatever it holds; $ begins a variable there.
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

std::string scenario_mount(const DeployMission& mission) {
  return "      - type: bind\n        source: " + yaml(mission.folder.string()) +
         "\n        target: /mission\n        read_only: true\n";
}

std::string service(const DeployProcess& process, const char* restart, const std::string& volumes) {
  return "  " + process.name + ":\n    <<: *ergocast\n    restart: " + restart +
         "\n    entrypoint: " + list(process.command) + "\n    command: []\n" +
         (volumes.empty() ? "" : "    volumes:\n" + volumes);
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
  if (host.logger) text += "# The record goes into ./record, for every mission an empty folder.\n";
  return text;
}

/// @param alone  there is no other host: the containers have a bridge of their own
std::string compose_text(const DeployHost& host, const DeployMission& mission, bool alone) {
  std::string text =
      "version: \"3.8\"\n\nx-ergocast: &ergocast\n  image: ergocast\n  environment:\n    "
      "LCM_DEFAULT_URL: " +
      yaml(mission.url.base()) + "\n  stop_grace_period: 20s\n";
  if (!alone) text += "  network_mode: host\n";
  text += "\nservices:\n";
  for (DeployProcess process : processes_of(host)) {
    const bool logger = process.name == "logger";
    if (logger) process.command = {"ergocast-logger", "--resume", "--out", "/record"};
    text += service(process, "\"on-failure:5\"", logger ? "      - ./record:/record\n" : "");
  }
  if (host.coordinator) {
    // One that is started again would begin a second mission.
    text += service({"coordinator", {"ergocast-coordinator", "/mission/" + mission.files.front()}},
                    "\"no\"", scenario_mount(mission));
  }
  return text;
}

}  // namespace

std::vector<TextFile> compose_files(const std::vector<DeployHost>& hosts,
                                    const DeployMission& mission) {
  std::vector<TextFile> files;
  for (const DeployHost& host : hosts) {
    if (processes_of(host).empty() && !host.coordinator) continue;
    const bool alone = hosts.size() == 1;
    const std::string name = (alone ? "" : host.name + '.') + "compose.yaml";
    files.push_back({name, head(host, mission, name) + compose_text(host, mission, alone)});
  }
  return files;
}

}  // namespace ergocast
