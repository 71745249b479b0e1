#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# The output of "ergocast deploy --to ssh" runs a mission, with keys and without. The test has three
# hosts on a bridge, and an ssh that enters the network namespace of the given host.
#   deploy_ssh_test.sh BIN_DIR SCENARIO
set -euo pipefail

fail() {
  tail -n 5 "$work"/home/*/ergocast/*/latest/log/*.log >&2 || true
  echo "FAILED: $*" >&2
  exit 1
}

if [ "${ERGOCAST_IN_NAMESPACE:-}" != yes ]; then
  [ "$(id -u)" = 0 ] || { echo 'skipped: networks of several hosts need root'; exit 77; }
  work=$(mktemp -d)
  trap 'rm -rf "$work"' EXIT
  ERGOCAST_IN_NAMESPACE=yes work=$work unshare --net --mount --pid --fork --kill-child \
    --mount-proc --propagation private "$0" "$@"
  exit
fi

# This namespace is the switch. The names of the hosts' namespaces are in a private mount.
mkdir -p /run/netns
mount -t tmpfs tmpfs /run/netns
ip link add switch type bridge
ip link set switch up
add_host() {
  ip netns add "$1"
  ip link add "to-$1" type veth peer name eth0 netns "$1"
  ip link set "to-$1" master switch up
  ip -n "$1" link set lo up
  ip -n "$1" link set eth0 up
  ip -n "$1" address add "$1/24" dev eth0
  ip -n "$1" route add 224.0.0.0/4 dev eth0
  mkdir -p "$work/home/$1"
}
for address in 10.0.0.1 10.0.0.11 10.0.0.12; do add_host $address; done

bin=$(cd "$1" && pwd)
mkdir "$work/bin" "$work/home with space's"
cat >"$work/bin/ssh" <<END
#!/bin/sh
# ssh [-n] USER@ADDRESS COMMAND
if [ "\$1" = -n ]; then shift; exec </dev/null; fi
host=\${1#*@}
cd "$work/home/\$host"
export HOME=\$PWD PATH="$bin:\$PATH"
exec ip netns exec "\$host" sh -c "\$2"
END
chmod +x "$work/bin/ssh"
export PATH="$work/bin:$PATH"

# Waits until a command succeeds, or until all processes of the mission have ended. Then the command
# is tried once more.
patience_s=300
eventually() {
  local deadline=$((SECONDS + patience_s)) in_vain=
  until "$@"; do
    [ -z "$in_vain" ] && [ "$SECONDS" -lt "$deadline" ] || { "$script" status; fail "never: $*"; }
    sleep 0.2
    if all_ended; then in_vain=yes; fi
  done
}
# Only its own host knows the place of the scenario.
scenario="$work/home with space's/mission.textproto"
# use_scenario SECONDS FILE [OPTION…]
use_scenario() {
  local folder
  folder=$work/$1
  sed "s/duration_s: 600/duration_s: $1/" "$2" >"$scenario"
  shift 2
  cat >"$work/hosts.txt" <<END
ground  ops@10.0.0.1   coordinator logger sim ${at_ground:-}
rover1  pi@10.0.0.11   agent 0 2 ${at_rovers:-}
rover2  pi@10.0.0.12   agents=2 ${at_rovers:-}   # 1 and 3
END
  "$bin/ergocast" deploy "$scenario" --hosts "$work/hosts.txt" --to ssh --out "$folder" "$@" >/dev/null
  script=$folder/quadrimodal_corners-ssh.sh
}
all_ended() { [ "$("$script" status | grep -c ' running ' || true)" = 0 ]; }
all_running() { [ "$("$script" status | grep -c ' running ')" = 7 ]; }
recorded() { [ "$(cat "$work"/home/10.0.0.1/ergocast/quadrimodal_corners/latest/record/trajectory*.csv | wc -l)" -ge "$1" ]; }

use_scenario 30 "$2"
"$script" start
eventually all_ended
"$script" collect "$work/collected"
record=$work/collected/ground/record
grep -q '"result": "done"' "$record/summary.json" || fail "not complete: $(cat "$record/summary.json")"
[ "$(wc -l <"$record/trajectory.csv")" = 1201 ] || fail 'rows are missing'
for log in ground/log/coordinator ground/log/logger ground/log/sim rover1/log/agent-0 rover1/log/agent-2 \
  rover2/log/agent-1 rover2/log/agent-3; do
  [ -s "$work/collected/$log.log" ] || fail "$log has not run"
done
"$bin/ergocast" verify "$record" || fail 'the record is not what the simulation gives'

# With keys.
(cd "$work" && "$bin/ergocast" keygen "our team's" >/dev/null)
use_scenario 10000000 "$2" --keys "$work/our team's"
"$script" start
eventually recorded 1000
eventually all_running
ask() { ip netns exec 10.0.0.11 "$bin/ergocast" status --lcm-url 'udpm://239.255.76.67:7667?ttl=1' "$@" >"$work/said" 2>&1; }
if ask; then fail 'the team runs without its key'; fi
grep -q 'has a mission key' "$work/said" || fail "said: $(cat "$work/said")"
ask --key-file "$work/our team's.key" || fail "status: $(cat "$work/said")"
[ "$(cd "$work/home" && find . -name '*.key*' -printf '%p %m\n' | sort)" = "\
./10.0.0.1/ergocast/quadrimodal_corners/mission.coordinator.key 600
./10.0.0.1/ergocast/quadrimodal_corners/mission.key 600
./10.0.0.11/ergocast/quadrimodal_corners/mission.key 600
./10.0.0.12/ergocast/quadrimodal_corners/mission.key 600" ] || fail "keys lie elsewhere: $(find "$work/home" -name '*.key*')"
if "$script" start 2>"$work/said"; then fail 'a second mission begins over the first'; fi
grep -q 'still running' "$work/said" || fail "said: $(cat "$work/said")"
"$script" stop
all_ended || fail 'stop leaves processes'
grep -q '"result": "stopped"' "$work/home/10.0.0.1/ergocast/quadrimodal_corners/latest/record/summary.json" ||
  fail "not stopped in order: $(head -c 600 "$work/home/10.0.0.1/ergocast/quadrimodal_corners/latest/record/summary.json")"
[ "$(find "$work/home/10.0.0.1/ergocast/quadrimodal_corners" -mindepth 1 -maxdepth 1 -type d | wc -l)" = 2 ] ||
  fail 'the missions share a folder'
"$script" collect "$work/collected"
[ -z "$(find "$work/collected" -name '*.key*')" ] || fail 'keys were collected'

# Over relays: no multicast passes from one host to another.
nft 'table bridge sites { chain forward { type filter hook forward priority 0; ether type ip meta pkttype multicast drop; }; }'
at_ground='hub=10.0.0.1:7700 relay' at_rovers='relay=5000'
use_scenario 20 "$2" --keys "$work/our team's"
"$script" start
mission_ended() { [ "$("$script" status | grep ' running ' | grep -cv ' relay ' || true)" = 0 ]; }
eventually mission_ended
[ "$("$script" status | grep -c ' relay .* running ')" = 3 ] || fail 'relays do not wait for the next mission'
"$script" start
eventually mission_ended
"$script" stop
all_ended || fail 'stop leaves relays'
"$script" collect "$work/relayed"
grep -q 'joined the hub 10.0.0.1:7700' "$work/relayed/rover1/log/relay.log" || fail 'the relay has not joined'
"$bin/ergocast" verify "$work/relayed/ground/record" || fail 'the record over relays is not what the simulation gives'
echo 'the printed script runs, shows, stops and collects'
