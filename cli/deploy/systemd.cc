// SPDX-License-Identifier: BSD-3-Clause
// A fixed bash script writes settings and drives the installed services over ssh; only its table
// of hosts varies.
#include "cli/deploy/deploy.h"
#include "cli/deploy/script.h"
#include "text/shell_word.h"

namespace ergocast {
namespace {

constexpr const char* kUnitHead = R"sh(#!/usr/bin/env bash
# A mission with the systemd services of the Debian package, written by "ergocast deploy".
#
#   %SCRIPT% setup     write /etc/ergocast/ergocast.env on every host, copy scenario and keys
#   %SCRIPT% start     start every service, the coordinator last: the mission begins
#   %SCRIPT% status    show all services
#   %SCRIPT% stop      end the mission in order
#   %SCRIPT% enable    start all but the coordinator at every boot, too
#   %SCRIPT% disable   no longer
#
# Needs ssh without a password to every host, sudo without a password on it, the package ergocast,
# and a route for multicast ("ip route get %GROUP%").
set -euo pipefail
)sh";

constexpr const char* kUnitBody = R"sh(
failed=no

write_settings() {
  local table=${modes:+$'\n'ERGOCAST_MODES=/etc/ergocast/mission/$modes}
  local options=${overrides:+$'\n'ERGOCAST_OVERRIDES=$overrides}
  local relay=${2:+$'\n'ERGOCAST_RELAY=$2}
  ssh "$1" 'sudo tee /etc/ergocast/ergocast.env >/dev/null' <<END
LCM_DEFAULT_URL=$url
ERGOCAST_SCENARIO=/etc/ergocast/mission/${scenario_files[0]}$options$table$relay
END
}

# All hosts must take the modes of the free domain from one table.
install_modes() {
  ssh "$1" "sudo mkdir -p /etc/ergocast/mission &&
    sudo sh -c 'umask 022 && cat >/etc/ergocast/mission/$modes'" \
    <"$(dirname "${BASH_SOURCE[0]}")/$modes"
}

# install_key HOST FILE DROP-IN UNITS: FILE, only for root, and the DROP-IN that hands it to UNITS.
install_key() {
  local folder=/etc/systemd/system/$4.service.d shipped=/usr/share/ergocast/systemd/$3
  ssh "$1" "ls $shipped >/dev/null && cd /etc/ergocast &&
    sudo sh -c 'umask 077 && cat >$2.new && mv -f $2.new $2' &&
    sudo mkdir -p $folder && sudo ln -sf $shipped $folder/ && sudo systemctl daemon-reload" \
    <"$keys${2#mission}"
}

on_services() {
  local host=$1
  shift
  # shellcheck disable=SC2029
  ssh -n "$host" "sudo systemctl $verb $*" || failed=yes
}

case ${1:-} in
  setup)
    check_versions
    for i in "${!hosts[@]}"; do write_settings "${hosts[i]}" "${relays[i]}"; done
    # The services run under a user without rights, so the scenario must be readable for all users.
    tar -C "$scenario_folder" --mode=a+rX -cf - -- "${scenario_files[@]}" |
      ssh "$coordinator" 'sudo mkdir -p /etc/ergocast/mission &&
        sudo tar -C /etc/ergocast/mission --no-same-owner -xf -'
    if [ -n "$keys" ]; then
      for host in "${hosts[@]}"; do install_key "$host" mission.key mission-key.conf ergocast-; done
      install_key "$coordinator" mission.coordinator.key signing-key.conf ergocast-coordinator
    fi
    if [ -n "$modes" ]; then
      for host in "${hosts[@]}"; do install_modes "$host"; done
    fi
    ;;
  start | enable | disable)
    verb=$1
    if [ "$verb" = start ]; then check_versions; fi
    each_host on_services
    if [ "$verb" = start ]; then on_services "$coordinator" ergocast-coordinator; fi
    ;;
  status)
    verb='--no-pager --lines=1 status'
    each_host on_services || true
    on_services "$coordinator" ergocast-coordinator || true
    failed=no
    ;;
  stop)
    # The coordinator ends the mission for all.
    verb=stop
    on_services "$coordinator" ergocast-coordinator
    each_host on_services
    ;;
  *)
    echo "Usage: $0 setup|start|status|stop|enable|disable" >&2
    exit 2
    ;;
esac
[ "$failed" = no ]
)sh";

/// The options of a host's relay, which its service splits at spaces; empty: it has none.
std::string relay_setting(const DeployHost& host) {
  std::string text;
  for (const DeployProcess& process : processes_of(host)) {
    if (process.name != kRelayProcess) continue;
    for (auto word = process.command.begin() + 1; word != process.command.end(); ++word)
      text += (text.empty() ? "" : " ") + *word;
  }
  return text;
}

std::string relay_settings(const std::vector<DeployHost>& hosts) {
  std::string text = "relays=(";
  for (const DeployHost& host : hosts) text += shell_word(relay_setting(host)) + ' ';
  text.back() = ')';
  return text + '\n';
}

/// The services of a host, except the coordinator's.
std::string services_of(const DeployHost& host) {
  std::string services;
  if (!relay_setting(host).empty()) services += " ergocast-relay";
  if (host.logger) services += " ergocast-logger";
  if (host.sim) services += " ergocast-sim";
  for (const int id : host.agents) services += " ergocast-agent@" + std::to_string(id);
  return services;
}

std::string service_table(const std::vector<DeployHost>& hosts) {
  std::string text = "\n# Calls \"$1 HOST SERVICE…\" for every host.\neach_host() {\n";
  for (const DeployHost& host : hosts) {
    text += "  # " + host.name + ": " + roles_of(host) + '\n';
    const std::string services = services_of(host);
    if (!services.empty()) text += "  \"$1\" " + shell_word(host.address) + services + '\n';
  }
  return text + "}\n";
}

/// The options of the coordinator's service, which splits them at spaces.
std::string overrides_setting(const DeployMission& mission) {
  std::string text;
  for (const std::string& word : mission.overrides) text += (text.empty() ? "" : " ") + word;
  return "overrides=" + shell_word(text) + '\n';
}

}  // namespace

std::vector<TextFile> systemd_files(const std::vector<DeployHost>& hosts,
                                    const DeployMission& mission) {
  const std::string name = mission.name + "-systemd.sh";
  return {{name,
           script_head(kUnitHead, name, mission) + script_settings(hosts, mission) +
               overrides_setting(mission) + relay_settings(hosts) + service_table(hosts) +
               kCheckVersion + kUnitBody,
           true}};
}

}  // namespace ergocast
