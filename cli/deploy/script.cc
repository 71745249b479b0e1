// SPDX-License-Identifier: BSD-3-Clause
// Replaces marks in script texts with values that are quoted for the shell.
#include "cli/deploy/script.h"

#include "runtime/process/program_options.h"
#include "text/shell_word.h"

namespace ergocast {
namespace {

std::string with(std::string text, const std::string& mark, const std::string& value) {
  for (auto at = text.find(mark); at != text.npos; at = text.find(mark, at + value.size())) {
    text.replace(at, mark.size(), value);
  }
  return text;
}

std::string array(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "(" : " ") + shell_word(word);
  return text + ')';
}

}  // namespace

const char* const kCheckVersion = R"sh(
check_version() {
  local found
  found=$(ssh -n "$1" 'ergocast --version' | sed -n '1s/^ergocast \([^ ]*\) .*/\1/p') || true
  if [ "$found" = "$version" ]; then return; fi
  if [ -z "$found" ]; then
    echo "$1 does not answer, or has no ergocast: install ergocast $version on $1" >&2
  elif [ "$(printf '%s\n' "$found" "$version" | sort -V | head -n 1)" = "$found" ]; then
    echo "$1 has ergocast $found, and $version wrote this script: update $1 to $version" >&2
  else
    echo "$1 has ergocast $found, and $version wrote this script: update the other hosts to $found," \
      "and write the script again" >&2
  fi
  other_version=yes
}

check_versions() {
  local host other_version=no
  for host in "${hosts[@]}"; do check_version "$host"; done
  if [ "$other_version" = yes ]; then exit 1; fi
}
)sh";

std::string script_head(std::string head, const std::string& name, const DeployMission& mission) {
  return with(with(std::move(head), "%SCRIPT%", "./" + name), "%GROUP%", mission.url.group);
}

std::string script_settings(const std::vector<DeployHost>& hosts, const DeployMission& mission) {
  std::vector<std::string> addresses;
  std::string coordinator;
  for (const DeployHost& host : hosts) {
    addresses.push_back(host.address);
    if (host.coordinator) coordinator = host.address;
  }
  return "\nversion=" + version() + "\nmission=" + shell_word(mission.name) +
         "\nurl=" + shell_word(mission.url.base()) +
         "\nscenario_folder=" + shell_word(mission.folder.string()) +
         "\nscenario_files=" + array(mission.files) +
         "\nkeys=" + shell_word(mission.keys.string()) + "\nmodes=" + shell_word(mission.modes) +
         "\ncoordinator=" + shell_word(coordinator) + "\nhosts=" + array(addresses) + '\n';
}

}  // namespace ergocast
