#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# lintian finds no error in the packages, and packing twice gives the same bytes.
#   lintian_test.sh BUILD_DIR
set -euo pipefail
build=$(cd "$1" && pwd)
fail() { echo "FAILED: $*" >&2; exit 1; }
command -v lintian >/dev/null || { echo 'skipped: lintian is missing: packaging/packages-test.txt'; exit 77; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export SOURCE_DATE_EPOCH=1700000000

# With other times of access and change, and another order of the files.
for time in first second; do
  mkdir "$work/$time"
  (cd "$work/$time" && umask 0022 && cpack --config "$build/CPackConfig.cmake" -G DEB -B "$work/$time" >log 2>&1) ||
    { cat "$work/$time/log"; fail cpack; }
  rm -rf "$work/$time/_CPack_Packages"
  sleep 1.1  # file times have seconds
done
for deb in "$work"/first/*.deb; do
  cmp "$deb" "$work/second/$(basename "$deb")" || fail "$(basename "$deb") differs when it is packed again"
  lintian --fail-on error --tag-display-limit 0 "$deb" >"$work/said" 2>&1 ||
    { grep '^E:' "$work/said"; fail "lintian finds errors in $(basename "$deb")"; }
done
echo 'lintian finds no error, and equal files give equal packages'
