# Sourced by docker_test (bash): a container engine of the test's own. Nothing of the host's is touched, neither its network nor
# an engine that it may run, and nothing is left: the engine is in the script's own pid and mount
# namespace.
# shellcheck shell=bash

export DOCKER_HOST=unix://$work/engine.sock

# The image that the tests build on, made once: no registry is asked.
make_base() {
  local tar=$cache/debian-12.tar
  [ -e "$tar" ] || {
    debootstrap --variant=minbase bookworm "$work/debian" >"$work/debootstrap.log" 2>&1 ||
      { tail -5 "$work/debootstrap.log" >&2; return 1; }
    tar -C "$work/debian" --exclude='./var/cache/apt/archives/*.deb' -cf "$tar.$$" .
    mv "$tar.$$" "$tar"
    rm -rf "$work/debian"
  }
  docker import "$tar" ergocast-base >/dev/null
}

# start_engine [OPTION…]  in the network namespace of the process $network
start_engine() {
  nsenter --net="/proc/$network/ns/net" dockerd --host "$DOCKER_HOST" --data-root "$work/data" \
    --exec-root "$work/exec" --pidfile "$work/engine.pid" --cgroup-parent "/$cgroup" "$@" \
    >>"$work/engine.log" 2>&1 &
  engine=$!
  eventually docker info || { tail -5 "$work/engine.log" >&2; return 1; }
}

stop_engine() {
  kill "$engine" && wait "$engine"
}

# Waits until a command succeeds; how long it may take decides no success.
eventually() {
  local deadline=$((SECONDS + 120))
  until "$@" >/dev/null 2>&1; do
    [ "$SECONDS" -lt "$deadline" ] || return 1
    sleep 0.2
  done
}
