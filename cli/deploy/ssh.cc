// SPDX-License-Identifier: BSD-3-Clause
// A fixed bash script starts, watches and ends processes over ssh; only its tables of hosts and
// commands vary.
#include "cli/deploy/deploy.h"
#include "cli/deploy/script.h"
#include "text/shell_word.h"

namespace ergocast {
namespace {

constexpr const char* kHead = R"sh(#!/usr/bin/env bash
# A mission on several hosts over ssh, written by "ergocast deploy".
#
#   %SCRIPT% start           copy scenario and keys and start every process, the coordinator last
#   %SCRIPT% status          what runs where
#   %SCRIPT% stop            end the mission in order, then the relays
#   %SCRIPT% collect [DIR]   fetch record and logs of the latest mission
#
# Needs ssh without a password to every host, and on each the same version of Ergocast and a route
# for multicast ("ip route get %GROUP%").
set -euo pipefail
)sh";

constexpr const char* kFolder = R"sh(# On every host, below its home folder.
folder=ergocast/$mission
)sh";

constexpr const char* kBody = R"sh(
prepare() {
  ssh -n "$1" "mkdir -p $folder/$now/log $folder/$now/record && ln -sfn $now $folder/latest"
}

# The key is never readable for others, and it is in a folder that "collect" does not copy.
copy_key() {
  ssh "$1" "umask 077 && cd $folder && cat >$2.new && mv -f $2.new $2" <"$keys${2#mission}"
}

# All hosts must take the modes of the free domain from one table.
copy_modes() {
  ssh "$1" "cat >$folder/$modes" <"$(dirname "${BASH_SOURCE[0]}")/$modes"
}

launch() {
  local host=$1 process=$2
  shift 2
  echo "$host: starting $process"
  ssh -n "$host" "cd $folder/latest && { nohup $(printf '%q ' "$@" --lcm-url "$url") \
    >log/$process.log 2>&1 </dev/null & echo \$! >$process.pid; }"
}

# Fails with 255 if the host does not answer.
runs() {
  ssh -n "$1" "pid=\$(cat $folder/latest/$2.pid 2>/dev/null) && grep -qs ergocast- /proc/\$pid/cmdline"
}

show() {
  local state=ended code=0
  runs "$1" "$2" || code=$?
  case $code in
    0) state=running ;;
    255) state='no answer' ;;
  esac
  printf '%-24s %-12s %-9s %s\n' "$1" "$2" "$state" \
    "$(ssh -n "$1" "tail -qn 1 $folder/latest/log/$2.log 2>/dev/null" || true)"
}

refuse_if_running() {
  if runs "$1" "$2"; then
    echo "$1: $2 is still running; end the mission first: $0 stop" >&2
    exit 1
  fi
}

# The process may end by itself meanwhile.
end() {
  if runs "$1" "$2"; then ssh -n "$1" "kill \$(cat $folder/latest/$2.pid)" || true; fi
}

# A process on a host that does not answer may be running.
note_if_running() {
  local code=0
  runs "$1" "$2" || code=$?
  if [ "$code" = 0 ] || [ "$code" = 255 ]; then left="$left $2"; fi
}

# Waits up to $1 seconds until none of $2, each_process or each_relay, runs.
wait_for() {
  local deadline=$((SECONDS + $1))
  while left='' && "$2" note_if_running && [ -n "$left" ]; do
    if [ "$SECONDS" -ge "$deadline" ]; then return 1; fi
    sleep 1
  done
}

# Ends all of $1, and fails if that is in vain.
end_all() {
  "$1" end
  wait_for 20 "$1" || { echo "still running, or on a host that does not answer:$left" >&2; exit 1; }
}

case ${1:-} in
  start)
    check_versions
    each_process refuse_if_running
    end_all each_relay   # of the last mission
    now=$(date -u +%Y%m%d-%H%M%S)
    for host in "${hosts[@]}"; do prepare "$host"; done
    tar -C "$scenario_folder" -cf - -- "${scenario_files[@]}" |
      ssh "$coordinator" "tar -C $folder/latest -xf -"
    if [ -n "$keys" ]; then
      for host in "${hosts[@]}"; do copy_key "$host" mission.key; done
      copy_key "$coordinator" mission.coordinator.key
    fi
    if [ -n "$modes" ]; then
      for host in "${hosts[@]}"; do copy_modes "$host"; done
    fi
    each_relay launch
    each_process launch
    ;;
  status)
    each_relay show
    each_process show
    ;;
  stop)
    # The coordinator ends the mission for all. Processes that do not receive this are ended next.
    end "$coordinator" coordinator
    wait_for 10 each_process || end_all each_process
    end_all each_relay
    ;;
  collect)
    to=${2:-$mission}
    for i in "${!hosts[@]}"; do
      mkdir -p "$to/${names[i]}"
      ssh -n "${hosts[i]}" "tar -C $folder/latest -cf - ." | tar -C "$to/${names[i]}" -xf -
      echo "$to/${names[i]}"
    done
    ;;
  *)
    echo "Usage: $0 start|status|stop|collect [DIR]" >&2
    exit 2
    ;;
esac
)sh";

/// @param key  the file on that host, one folder above the processes' folder
std::string process_line(const DeployHost& host, const DeployProcess& process,
                         const DeployMission& mission, const char* key = "mission.key") {
  std::string line = "  \"$1\" " + shell_word(host.address) + ' ' + process.name;
  for (const std::string& word : process.command) line += ' ' + shell_word(word);
  if (!mission.keys.empty()) line += std::string(" --key-file ../") + key;
  const bool computes = process.name != "sim" && process.name != kRelayProcess;
  if (!mission.modes.empty() && computes) line += " --modes ../" + shell_word(mission.modes);
  return line + '\n';
}

std::string names(const std::vector<DeployHost>& hosts) {
  std::string text = "names=(";
  for (const DeployHost& host : hosts) text += shell_word(host.name) + ' ';
  text.back() = ')';
  return text + '\n';
}

std::string process_table(const std::vector<DeployHost>& hosts, const DeployMission& mission) {
  std::string relays =
      "\n# Calls \"$1 HOST PROCESS COMMAND…\" for every relay.\neach_relay() {\n  :\n";
  std::string text =
      "\n# Calls \"$1 HOST PROCESS COMMAND…\" for every other process.\neach_process() {\n";
  std::string last;
  for (const DeployHost& host : hosts) {
    text += "  # " + host.name + ": " + roles_of(host) + '\n';
    for (const DeployProcess& process : processes_of(host)) {
      (process.name == kRelayProcess ? relays : text) += process_line(host, process, mission);
    }
    if (!host.coordinator) continue;
    DeployProcess coordinator{"coordinator",
                              {"ergocast-coordinator", "./" + mission.files.front()}};
    coordinator.command.insert(coordinator.command.end(), mission.overrides.begin(),
                               mission.overrides.end());
    last = process_line(host, coordinator, mission, "mission.coordinator.key");
  }
  return relays + "}\n" + text + "  # The coordinator starts the mission.\n" + last + "}\n";
}

}  // namespace

std::vector<TextFile> ssh_files(const std::vector<DeployHost>& hosts,
                                const DeployMission& mission) {
  const std::string name = mission.name + "-ssh.sh";
  return {{name,
           script_head(kHead, name, mission) + script_settings(hosts, mission) + names(hosts) +
               kFolder + process_table(hosts, mission) + kCheckVersion + kBody,
           true}};
}

}  // namespace ergocast
