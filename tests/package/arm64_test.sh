#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Compiles the agent and the tests of functions for arm64 and runs them under emulation. Teams of
# which one agent is emulated record what this processor simulates, byte for byte.
#   arm64_test.sh BIN_DIR SOURCE_DIR
#   ERGOCAST_ARM64_SYSROOT   what packaging/arm64-sysroot makes (default: SOURCE_DIR/build/arm64-sysroot)
set -euo pipefail

skip() { echo "skipped: $*"; exit 77; }
fail() { echo "FAILED: $*" >&2; exit 1; }

[ "$(id -u)" = 0 ] || skip 'making a Debian system needs root'
[ "$(uname -m)" = x86_64 ] || skip 'this test is for x86_64'
for tool in debootstrap aarch64-linux-gnu-g++ qemu-aarch64-static; do
  command -v "$tool" >/dev/null || skip "$tool is missing: packaging/packages-nightly.txt"
done

bin=$(cd "$1" && pwd)
source=$(cd "$2" && pwd)
sysroot=${ERGOCAST_ARM64_SYSROOT:-$source/build/arm64-sysroot}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
quiet() { "$@" >"$work/log" 2>&1 || { tail -n 30 "$work/log" >&2; fail "$*"; }; }
if [ ! -e "$sysroot/usr/lib/aarch64-linux-gnu/liblcm.so" ]; then
  [ -z "${ERGOCAST_ARM64_SYSROOT:-}" ] || skip "no system for arm64 in $sysroot: packaging/arm64-sysroot"
  quiet "$source/packaging/arm64-sysroot" "$sysroot"
fi

cd "$source"
quiet cmake --preset arm64 -DERGOCAST_SYSROOT="$sysroot"
quiet cmake --build build/arm64 --target ergocast-agent portable_tests
emulated=(qemu-aarch64-static -L "$sysroot")
# The stated errors are tested where a long double has hardware.
quiet "${emulated[@]}" build/arm64/bin/portable_tests --gtest_filter='-PortableMath.HasTheStated*'

# `ergocast run` starts the agents that lie beside it.
cp "$bin"/ergocast{,-sim,-coordinator,-logger} "$work/"
cat >"$work/ergocast-agent" <<AGENT
#!/bin/sh
case " \$* " in
  *' --id 1 '* | *' --id=1 '*)
    touch $work/emulated
    exec ${emulated[*]} $source/build/arm64/bin/ergocast-agent "\$@"
    ;;
esac
exec $bin/ergocast-agent "\$@"
AGENT
chmod +x "$work/ergocast-agent"
run() { # RECORD SCENARIO OPTION...
  rm -f "$work/emulated"
  quiet unshare --net sh -c 'ip link set lo up; ip route add 224.0.0.0/4 dev lo; exec "$@"' _ \
    "$work/ergocast" run --out "$work/$1" "$source/scenarios/$2.textproto" "${@:3}"
  [ -e "$work/emulated" ] || fail "no agent of $2 was emulated"
}

# Cosines, a search, walls with ways around them, a box, a charge, kinds of agents, lanes.
for name in quadrimodal_corners lost_hiker office water_column recharge mixed_team mine_line; do
  run $name $name --lockstep --duration 40
  quiet "$bin/ergocast" verify "$work/$name"
  echo "$name: the emulated agent has the same bits"
done

run real_time quadrimodal_corners --realtime --duration 20
grep -E 'ticks  |deadlines' "$work/log"
echo 'an emulated agent in real time: done'
