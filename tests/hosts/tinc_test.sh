#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# A lockstep mission at two sites that tinc joins to one network, by the commands of docs/relays.md. A
# router without multicast lies between them, and the record is the simulation's.
#   tinc_test.sh BIN_DIR SCENARIO
set -euo pipefail

[ "$(id -u)" = 0 ] || { echo 'skipped: networks of several hosts need root'; exit 77; }
command -v tincd >/dev/null || { echo 'skipped: needs the package tinc'; exit 77; }
[ -c /dev/net/tun ] || { echo 'skipped: no /dev/net/tun'; exit 77; }

if [ "${ERGOCAST_IN_NAMESPACE:-}" != yes ]; then
  work=$(mktemp -d)
  trap 'rm -rf "$work"' EXIT
  ERGOCAST_IN_NAMESPACE=yes work=$work unshare --net --mount --pid --fork --kill-child \
    --mount-proc --propagation private "$0" "$@"
  exit
fi

fail() {
  tail -n 4 "$work"/*.log >&2 || true
  echo "FAILED: $*" >&2
  exit 1
}

# This namespace is the router between the hosts. It passes on tinc's port only.
mkdir -p /run/netns "$work/etc"
mount -t tmpfs tmpfs /run/netns
sysctl -qw net.ipv4.ip_forward=1
nft 'table inet filter {
  chain forward {
    type filter hook forward priority 0; policy drop
    udp dport 655 accept
    tcp dport 655 accept
    tcp sport 655 accept
  }
}'
add_host() { # NAME SUBNET
  ip netns add "$1"
  ip link add "to-$1" type veth peer name eth0 netns "$1"
  ip address add "$2.1/24" dev "to-$1"
  ip link set "to-$1" up
  ip -n "$1" link set lo up
  ip -n "$1" link set eth0 up
  ip -n "$1" address add "$2.2/24" dev eth0
  ip -n "$1" route add default via "$2.1"
}
add_host ground 192.0.2
add_host field 198.51.100

bin=$(cd "$1" && pwd)
page=$(cd "$(dirname "$0")/../.." && pwd)/docs/relays.md
scenario=$(realpath "$2")
export PATH="$bin:$PATH"
cd "$work"

# Each host has an /etc/tinc and a /run of its own.
on() { # HOST COMMAND...
  local host=$1
  shift
  # shellcheck disable=SC2016  # for the shell inside
  ip netns exec "$host" unshare --mount sh -c '
    mount --bind "$0" /etc/tinc && mount -t tmpfs tmpfs /run && exec "$@"' "$work/etc/$host" "$@"
}

# The page's commands for each site, with its name and number.
awk '/^## / { on = $0 == "## Without a relay: tinc" } on && /^    / { print substr($0, 5) }' "$page" >commands
grep -q '^tincd -n team -K' commands || fail 'docs/relays.md has other commands'
for host in ground field; do
  number=1
  [ $host = ground ] || number=2
  mkdir "etc/$host"
  sed "/^apt-get/d; s/Name = ground/Name = $host/; s/10\.78\.0\.1/10.78.0.$number/" commands >"$host-commands"
  on $host sh -e "$work/$host-commands" >"$host-commands.log" 2>&1 || fail "the commands at $host"
done
echo 'ConnectTo = ground' >>etc/field/team/tinc.conf
echo 'Address = 192.0.2.2' >>etc/ground/team/hosts/ground
cp etc/ground/team/hosts/ground etc/field/team/hosts/
cp etc/field/team/hosts/field etc/ground/team/hosts/
tincs=
for host in ground field; do
  on $host tincd -n team -D >"$host-tinc.log" 2>&1 &
  tincs="$tincs $!"
done
# The programs choose the interface of the group when they start, so it must be there.
for host in ground field; do
  until grep -q '^Ready' $host-tinc.log; do
    # shellcheck disable=SC2086  # two numbers
    kill -0 $tincs || fail 'tincd has ended'
    sleep 0.1
  done
done

export LCM_DEFAULT_URL='udpm://239.255.76.67:24600?ttl=1'
sed 's/duration_s: 600/duration_s: 20/' "$scenario" >mission.textproto
for id in 0 1; do ip netns exec ground ergocast-agent --id $id >agent$id.log 2>&1 & done
for id in 2 3; do ip netns exec field ergocast-agent --id $id >agent$id.log 2>&1 & done
ip netns exec ground ergocast-sim >world.log 2>&1 &
mkdir record
ip netns exec ground ergocast-logger --out record >logger.log 2>&1 &
logger=$!
ip netns exec ground ergocast-coordinator mission.textproto >coordinator.log 2>&1 || fail 'the mission failed'
wait $logger
ergocast verify record || fail 'the record is not what the simulation gives'
echo 'a mission over tinc is what the simulation gives'
