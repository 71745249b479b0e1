#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# A lockstep mission at two sites whose relays join a hub inside WireGuard, by the commands of
# docs/relays.md. The network between them drops everything else, and the record is the simulation's.
#   relay_wireguard_test.sh BIN_DIR SCENARIO
set -euo pipefail

[ "$(id -u)" = 0 ] || { echo 'skipped: networks of several hosts need root'; exit 77; }
for program in wg wireguard-go; do
  command -v "$program" >/dev/null ||
    { echo 'skipped: needs the packages wireguard-tools and wireguard-go'; exit 77; }
done
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

# This namespace is the network between the hosts. It passes on WireGuard and ARP only.
mkdir -p /run/netns /run/wireguard
mount -t tmpfs tmpfs /run/netns
mount -t tmpfs tmpfs /run/wireguard # sockets of wireguard-go, by the name of the interface
ip link add switch type bridge
ip link set switch up
nft 'table bridge filter {
  counter others { }
  chain forward {
    type filter hook forward priority 0; policy drop
    ether type arp accept
    udp dport 51820 accept
    ether type ip counter name others
  }
}'
add_host() { # NAME ADDRESS
  ip netns add "$1"
  ip link add "to-$1" type veth peer name eth0 netns "$1"
  ip link set "to-$1" master switch up
  ip -n "$1" link set lo up
  ip -n "$1" link set eth0 up
  ip -n "$1" address add "$2/24" dev eth0
  ip -n "$1" route add 224.0.0.0/4 dev lo
}
on() { ip netns exec "$@"; }
add_host hub 192.0.2.1
add_host ground 192.0.2.2
add_host field 192.0.2.3

bin=$(cd "$1" && pwd)
scenario=$(realpath "$2")

# The commands of docs/relays.md, with an interface name for each host.
cd "$work"
for host in hub ground field; do
  (umask 077 && wg genkey >$host.private)
  wg pubkey <$host.private >$host.public
  on $host wireguard-go "wg-$host" >"$host-wg.log" 2>&1
  on $host wg set "wg-$host" private-key $host.private listen-port 51820
done
on hub wg set wg-hub peer "$(cat ground.public)" allowed-ips 10.77.0.2/32
on hub wg set wg-hub peer "$(cat field.public)" allowed-ips 10.77.0.3/32
for host in ground field; do
  on $host wg set wg-$host peer "$(cat hub.public)" endpoint 192.0.2.1:51820 allowed-ips 10.77.0.0/24 \
    persistent-keepalive 25
done
address=1
for host in hub ground field; do
  on $host ip address add 10.77.0.$address/24 dev wg-$host
  on $host ip link set wg-$host mtu 1420 up
  address=$((address + 1))
done

export PATH="$bin:$PATH"
sed 's/duration_s: 600/duration_s: 20/' "$scenario" >mission.textproto
ergocast keygen team >keygen.log
export ERGOCAST_KEY_FILE=$work/team.key LCM_DEFAULT_URL='udpm://239.255.76.67:24600?ttl=0'
ip netns exec hub ergocast-relay --hub --listen 10.77.0.1:7700 >hub.log 2>&1 &
hub=$!
for host in ground field; do
  on $host ergocast-relay --to 10.77.0.1:7700 >$host.log 2>&1 &
done
for id in 0 1; do on ground ergocast-agent --id $id >agent$id.log 2>&1 & done
for id in 2 3; do on field ergocast-agent --id $id >agent$id.log 2>&1 & done
on ground ergocast-sim >world.log 2>&1 &
mkdir record
ip netns exec ground ergocast-logger --out record >logger.log 2>&1 &
logger=$!
on ground ergocast-coordinator mission.textproto --key-file team.coordinator.key >coordinator.log 2>&1 ||
  fail 'the mission failed'
wait $logger
kill $hub
wait $hub || fail 'the hub failed'
grep -q 'carried [1-9]' hub.log || fail 'the hub has carried nothing'
ergocast verify record || fail 'the record is not what the simulation gives'

# Without WireGuard the hub cannot be reached, so the mission above was inside it.
on hub ergocast-relay --hub --listen 192.0.2.1:7700 >outside.log 2>&1 &
if on field ergocast doctor --relay 192.0.2.1:7700 >doctor.log 2>&1; then
  fail 'a hub outside of WireGuard answers'
fi
nft list counter bridge filter others | grep -q 'packets [1-9]' || fail 'the filter has seen no plain packet'
echo 'a mission inside WireGuard is what the simulation gives'
