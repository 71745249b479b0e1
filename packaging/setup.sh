# SPDX-License-Identifier: BSD-3-Clause
# Sourced by ./run, ./test and others (bash): installs the missing packages of the lists $packages
# in this folder (default packages.txt). Builds $target, if it is set, in build/release. Afterwards
# `build_preset PRESET TARGET…` builds other presets.
#   ERGOCAST_NO_INSTALL=1   never install anything
#   ERGOCAST_CMAKE_ARGS     more arguments for the configuration, separated by spaces
# All messages go to stderr. Exit code 3: the machine lacks something that only its owner can add.
# shellcheck shell=bash
: "${target?what to build, or nothing}"
[ -n "${packages+set}" ] || packages=(packages.txt)

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
# shellcheck disable=SC2034  # the scripts that source this use it
build=$root/build/release

say() { printf '%s\n' "$*" >&2; }

# Runs a command silently, and shows its output only if it fails.
quietly() {
  local output status=0
  output=$("$@" 2>&1) || status=$?
  [ "$status" -eq 0 ] || say "$output"
  return "$status"
}

missing_packages() {
  local package
  cat "${packages[@]/#/$root/packaging/}" | sed 's/#.*//' | while read -r package; do
    [ -n "$package" ] || continue
    # A command of that name counts as its package; for example, other nodejs packages contain npm.
    [ "$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null)" = installed ] ||
      command -v "$package" >/dev/null || printf '%s\n' "$package"
  done
}

missing_tools() {
  local tool
  for tool in cmake ninja c++ esbuild protoc lcm-gen; do
    command -v "$tool" >/dev/null || printf '%s\n' "$tool"
  done
}

install_packages() {
  local missing tools as_root=() install
  mapfile -t missing < <(missing_packages)
  [ "${#missing[@]}" -gt 0 ] || return 0

  install=(env DEBIAN_FRONTEND=noninteractive apt-get -qq install -y --no-install-recommends
    "${missing[@]}")
  local by_hand="  apt-get update && apt-get install -y --no-install-recommends ${missing[*]}"
  [ "$(id -u)" -eq 0 ] || as_root=(sudo)

  if [ "${ERGOCAST_NO_INSTALL:-0}" = 1 ] || ! command -v apt-get >/dev/null; then
    say "Missing Debian packages, not installed here: ${missing[*]}"
    say "As root:"
    say "$by_hand"
    mapfile -t tools < <(missing_tools)
    [ "${#tools[@]}" -eq 0 ] || { say "Cannot build without: ${tools[*]}"; exit 3; }
    return 0
  fi
  if [ "${#as_root[@]}" -gt 0 ] && ! command -v sudo >/dev/null; then
    say "Missing Debian packages, and neither root nor sudo to install them. As root:"
    say "$by_hand"
    exit 3
  fi
  say "Installing ${#missing[@]} Debian packages (and what they need): ${missing[*]}"
  if ! quietly "${as_root[@]}" apt-get -qq update || ! quietly "${as_root[@]}" "${install[@]}"; then
    say "The installation failed. By hand, as root:"
    say "$by_hand"
    exit 3
  fi
}

# The optional packages that were present at configuration time, as one word.
optional_packages() {
  dpkg-query -W -f '${Package} ${db:Status-Status}\n' 2>/dev/null |
    grep -xF -f <(sed 's/#.*//; /^$/d; s/$/ installed/' "$root/packaging/packages-test.txt") | cksum
}

# Prints why a build folder with the settings $1 starts anew with $2: the first line that differs.
why_anew() {
  local was is
  while IFS= read -r is <&3; IFS= read -r was <&4; do
    [ "$was" != "$is" ] || continue
    case $was in
      "checkout "*) echo "this checkout was moved here from ${was#checkout }, so all is compiled again" ;;
      "arguments "*) echo "it was configured with ERGOCAST_CMAKE_ARGS=\"${was#arguments }\"" ;;
      "packages "*) echo 'Debian packages that the build uses were added or removed' ;;
      "presets "*) echo 'CMakePresets.json has changed' ;;
      *) echo 'another version of Ergocast configured it' ;;
    esac
    return
  done 3<<<"$2" 4<<<"$1"
}

# build_preset PRESET TARGET…
build_preset() {
  local folder=$root/build/$1 arguments stamp=$root/build/$1/configured-with wanted had
  read -r -a arguments <<<"${ERGOCAST_CMAKE_ARGS:-}"
  wanted="checkout $root
arguments ${arguments[*]}
packages $(optional_packages)
presets $(cksum <"$root/CMakePresets.json")"
  had=$(cat "$stamp" 2>/dev/null) || true

  # After a change of arguments, presets, packages or the checkout's path, start from an empty
  # cache: no old setting remains.
  if [ ! -f "$folder/build.ninja" ] || [ "$had" != "$wanted" ]; then
    if [ -f "$folder/build.ninja" ] && [ -n "$had" ]; then
      say "Configuring $folder anew: $(why_anew "$had" "$wanted")"
    else
      say "Configuring $folder"
    fi
    rm -f "$stamp"
    quietly cmake --fresh -S "$root" --preset "$1" "${arguments[@]}"
    printf '%s\n' "$wanted" >"$stamp"
  fi
  if ! ninja -C "$folder" -n "${@:2}" 2>/dev/null | grep -q '^ninja: no work to do'; then
    say "Building $folder"
    cmake --build "$folder" --target "${@:2}" >&2
  fi
}

install_packages
[ -z "$target" ] || build_preset release "$target"
