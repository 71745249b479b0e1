# SPDX-License-Identifier: BSD-3-Clause
# Sourced by docker_test.sh after debian.sh (bash): a separate container engine for the test. It
# changes neither this machine's network nor a running engine. Engine and containers are in the
# test's process and mount namespaces, so they end with it.
# shellcheck shell=bash disable=SC2154  # work and root are debian.sh's

export DOCKER_HOST=unix://$work/engine.sock

# Waits until a command succeeds, or until the process $awaited has ended, or containers have
# (nothing_comes_of_containers). After the end the command is tried once more. The time that it
# takes decides no success.
awaited=
eventually() {
  local deadline=$((SECONDS + ${PATIENCE_S:-300})) in_vain=
  until "$@" >/dev/null 2>&1; do
    [ -z "$in_vain" ] && [ "$SECONDS" -lt "$deadline" ] || return 1
    sleep 0.2
    if ! kill -0 "$awaited" 2>/dev/null || nothing_comes_of_containers; then in_vain=yes; fi
  done
}
nothing_comes_of_containers() { false; }

# start_engine NETWORK_NAMESPACE [OPTION…]
start_engine() {
  local network=$1
  shift
  nsenter --net="$network" dockerd --host "$DOCKER_HOST" --data-root "$work/data" \
    --exec-root "$work/exec" --pidfile "$work/engine.pid" --cgroup-parent "$ERGOCAST_CGROUP" "$@" \
    >>"$work/engine.log" 2>&1 &
  engine=$! awaited=$!
  eventually docker info || { tail -n 5 "$work/engine.log" >&2; fail 'dockerd'; }
}

stop_engine() {
  kill "$engine"
  wait "$engine" || true
}

# There is no registry: the base image is the bare system, with the packages that were fetched
# before.
import_base() {
  tar -C "$root" --one-file-system --exclude=./tmp/test --exclude='./var/cache/apt/*.bin' \
    --exclude='./var/lib/apt/lists/*' -c . | docker import - debian-12 >/dev/null
}

# Builds in this machine's network, so that packages can be fetched, and without a bridge.
the_image_is_built_from_the_package() {
  start_engine /proc/self/ns/net --bridge=none --iptables=false --ip-forward=false
  import_base
  mkdir "$work/context"
  cp -r "$source/docker" "$deb" "$work/context"
  docker build --network=host --tag ergocast --file "$source/docker/Dockerfile" \
    --build-arg BASE=debian-12 --build-arg DEB="$(basename "$deb")" "$work/context" \
    >"$work/build.log" 2>&1 || { tail -n 20 "$work/build.log" >&2; fail 'docker build'; }
  stop_engine
}

# A machine with only the engine on it.
start_isolated_engine() {
  unshare --net sleep infinity &
  awaited=$!
  local network=/proc/$awaited/ns/net
  eventually test ! "$network" -ef /proc/self/ns/net || fail 'no network namespace'
  nsenter --net="$network" ip link set lo up
  nsenter --net="$network" ip route add 224.0.0.0/4 dev lo
  start_engine "$network"
}
