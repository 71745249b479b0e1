# SPDX-License-Identifier: BSD-3-Clause
# Sourced (bash): unpacks a bare Debian into a folder, and keeps it for the next time.
# shellcheck shell=bash

# bare_debian SYSTEM FOLDER CACHE: FOLDER becomes a bare system with an updated list of packages. SYSTEM
# is a suite, or SUITE-arm64 below tests/package/with_arm64. CACHE has SYSTEM.tar, at most three days
# old, and archives/SYSTEM, the packages that were fetched before. Needs root.
bare_debian() {
  local suite=${1%-arm64} folder=$2 bare=$3/$1.tar archives=$3/archives/$1 log made=(debootstrap --variant=minbase)
  mkdir -p "$folder/dev" "$archives"
  [ "$suite" = "$1" ] || made+=(--arch=arm64 --cache-dir="$archives")
  # Its list of packages becomes outdated.
  if [ ! -f "$bare" ] || [ -n "$(find "$bare" -mtime +3)" ]; then
    log=$(mktemp)
    if ! { "${made[@]}" "$suite" "$folder" && share_devices "$1" "$folder" && chroot "$folder" apt-get -qq update; } >"$log" 2>&1; then
      tail -n 5 "$log" >&2
      rm -f "$log"
      echo "debootstrap $suite failed (is there a network?)" >&2
      return 1
    fi
    rm -f "$folder"/var/cache/apt/archives/*.deb "$log"
    tar -C "$folder" --one-file-system --exclude=./tmp/test -cf "$bare.part" . && mv "$bare.part" "$bare"
  else
    tar -C "$folder" -xf "$bare"
    share_devices "$1" "$folder"
  fi
  cp "$archives"/*.deb "$folder/var/cache/apt/archives/" 2>/dev/null || true
  cp /etc/resolv.conf "$folder/etc/resolv.conf"
}

# In a user namespace a system can make no devices of its own.
share_devices() { [ "${1%-arm64}" = "$1" ] || mount --rbind /dev "$2/dev"; }

# keep_archives SYSTEM FOLDER CACHE: what FOLDER's apt has fetched is there the next time.
keep_archives() { cp -n "$2"/var/cache/apt/archives/*.deb "$3/archives/$1/" 2>/dev/null || true; }
