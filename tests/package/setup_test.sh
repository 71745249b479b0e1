#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# packaging/setup.sh configures a build folder anew after a change, and says which; else it is silent.
set -euo pipefail
source=$(cd "$(dirname "$0")/../.." && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { echo "FAILED: $*" >&2; exit 1; }

mkdir -p "$work/tree/packaging"
tree=$work/tree
cp "$source/packaging/setup.sh" "$tree/packaging/"
cp "$source/CMakePresets.json" "$tree/"
touch "$tree"/packaging/packages{,-test}.txt
cat >"$tree/CMakeLists.txt" <<'END'
cmake_minimum_required(VERSION 3.25)
project(small LANGUAGES NONE)
add_custom_command(OUTPUT programs.txt COMMAND ${CMAKE_COMMAND} -E touch programs.txt)
add_custom_target(programs DEPENDS programs.txt)
END

# expect WORDS [SETTING]: a build's messages contain WORDS; without, there are none.
expect() {
  local said
  # shellcheck disable=SC2016  # for the shell inside
  said=$(env "ERGOCAST_CMAKE_ARGS=${2:-}" bash -euc 'target=programs packages=(packages.txt); . "$1/packaging/setup.sh"' _ "$tree" 2>&1 |
    grep -v '^\[\|^ninja') || true
  case $said in
    "") [ -z "$1" ] || fail "silent, and not: $1" ;;
    *"$1"*) [ -n "$1" ] || fail "not silent: $said" ;;
    *) fail "\"$said\", and not: $1" ;;
  esac
}

expect "Configuring $tree/build/release"
expect ''
expect 'it was configured with ERGOCAST_CMAKE_ARGS=""' -DSOMETHING=1
expect 'it was configured with ERGOCAST_CMAKE_ARGS="-DSOMETHING=1"'
expect ''
mv "$tree" "$work/moved"
old=$tree tree=$work/moved
expect "Configuring $tree/build/release anew: this checkout was moved here from $old"
expect ''
echo >>"$tree/CMakePresets.json"
expect 'CMakePresets.json has changed'
expect ''
# The settings of a build folder of an earlier version were one line.
echo "$tree ; 1 2; presets 3 4" >"$tree/build/release/configured-with"
expect 'another version of Ergocast configured it'
expect ''
echo 'a build folder that starts anew says why'
