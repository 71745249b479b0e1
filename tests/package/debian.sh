# SPDX-License-Identifier: BSD-3-Clause
# Sourced by the tests of the Debian package (bash): a separate bare Debian for the test, 12 or $suite,
# for amd64 or $arch. Programs for arm64 are emulated.
#   SCRIPT BUILD_DIR
# It is in memory, and its mounts and processes are in namespaces that end with the test. So nothing
# remains in any case.
#   ERGOCAST_DEBIAN_CACHE   where bare systems and fetched packages are kept (default: BUILD_DIR/debian)
# shellcheck shell=bash
set -euo pipefail

build=$(cd "$1" && pwd)
cache=${ERGOCAST_DEBIAN_CACHE:-$build/debian}
root=$cache/root
suite=${suite:-bookworm}
arch=${arch:-amd64}
system=$suite emulated=()
if [ "$arch" = arm64 ]; then
  system=$suite-arm64 emulated=("$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)/with_arm64")
  more_tools="${more_tools:-} qemu-aarch64-static"
fi
# shellcheck source=packaging/bare_debian.sh
. "$(dirname "${BASH_SOURCE[0]}")/../../packaging/bare_debian.sh"

skip() { echo "skipped: $*"; exit 77; }
fail() { echo "FAILED: $*" >&2; exit 1; }

if [ "${ERGOCAST_IN_NAMESPACE:-}" != yes ]; then
  [ "$(id -u)" = 0 ] || skip 'making a Debian system needs root'
  for tool in debootstrap dpkg-shlibdeps file ${more_tools:-}; do
    command -v "$tool" >/dev/null || skip "$tool is missing: packaging/packages-test.txt"
  done
  unshare --mount true 2>/dev/null || skip 'this system allows no mount namespaces'
  mkdir -p "$root"
  # Tests use the cache in turn; within one ctest, their RESOURCE_LOCK ensures it.
  exec 9>"$cache/lock"
  flock 9
  status=0
  ! declare -F before_all >/dev/null || before_all
  ERGOCAST_IN_NAMESPACE=yes "${emulated[@]}" unshare --mount --pid --fork --kill-child --propagation private \
    "$0" "$build" || status=$?
  ! declare -F after_all >/dev/null || after_all
  exit "$status"
fi

in_root() { chroot "$root" env DEBIAN_FRONTEND=noninteractive LC_ALL=C.UTF-8 "$@"; }

expect_file() { [ -s "$root/$1" ] || fail "$1 is not installed"; }

# All files of the system, without temporary files and those of the package manager.
files_of_system() {
  (cd "$root" && find . -xdev \( -path ./tmp -o -path ./proc -o -path ./var/cache -o -path ./var/log \
    -o -path ./var/lib/apt -o -path ./var/lib/dpkg \) -prune -o -print | sort)
}

# Runs a command in a separate network; the array is for commands that are killed later.
offline=(unshare --net sh -c 'ip link set lo up; ip route add 224.0.0.0/4 dev lo; exec "$@"' _
  chroot "$root" env LC_ALL=C.UTF-8)
offline() { "${offline[@]}" "$@"; }

# Fetched packages are kept for the next time.
apt_install() {
  local status=0
  in_root apt-get -qq install -y --no-install-recommends "$@" >"$work/apt.log" 2>&1 || status=$?
  keep_archives "$system" "$root" "$cache"
  [ "$status" = 0 ] || { cat "$work/apt.log" >&2; fail "apt install $*"; }
}

# Packs all packages into $work. Sets $deb: that of the programs.
# shellcheck disable=SC2034  # the tests that source this file read it
pack() {
  (cd "$work" && cpack --config "$build/CPackConfig.cmake" -G DEB -B "$work" >"$work/cpack.log" 2>&1) ||
    { cat "$work/cpack.log" >&2; fail cpack; }
  deb=$(ls "$work"/ergocast_*.deb)
}

# make_old_package DEB FILE: FILE is DEB as version 0.2.0, with another default in its settings.
make_old_package() {
  dpkg-deb -R "$1" "$work/old"
  sed -i 's/^Version: .*/Version: 0.2.0/' "$work/old/DEBIAN/control"
  echo '# an older default' >>"$work/old/etc/ergocast/ergocast.env"
  dpkg-deb --root-owner-group -Zgzip -z1 -b "$work/old" "$2" >/dev/null
  rm -r "$work/old"
}

# The operator's files; all but the settings are below what a purge removes.
kept='etc/ergocast/mission.key var/lib/ergocast/20260101-000000/summary.json'
settings='ERGOCAST_SCENARIO=/etc/ergocast/mine.textproto'
use_package() {
  local file
  for file in $kept; do
    mkdir -p "$root/$(dirname "$file")"
    echo kept >"$root/$file"
  done
  echo "$settings" >"$root/etc/ergocast/ergocast.env"
}
expect_kept() {
  local file
  for file in $kept; do [ "$(cat "$root/$file")" = kept ] || fail "$1: $file is gone"; done
  [ "$(cat "$root/etc/ergocast/ergocast.env")" = "$settings" ] || fail "$1: the settings are others"
}
expect_version() {
  # shellcheck disable=SC2016  # a field of dpkg's
  [ "$(in_root dpkg-query -W -f '${Version}' ergocast)" = "$1" ] || fail "$1 is not the version"
}

make_bare_system() {
  bare_debian "$system" "$root" "$cache" || fail debootstrap
  # dpkg starts no service here, because systemd does not run.
  mount -t proc proc "$root/proc"
}

mount -t proc proc /proc
mount -t tmpfs -o mode=755,size=3g tmpfs "$root"
work=$root/tmp/test
mkdir -m 1777 "$root/tmp"
mkdir "$work"
