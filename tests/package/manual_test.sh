#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# A program's manual page has a section for each of its commands, with its options: manual_test.sh FOLDER. FOLDER has
# the programs.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# has PROGRAM COMMAND OPTION
has() {
  local page=$work/$1.1
  # From the section's head to the next one.
  if ! sed -n "/^\.SS $2\$/,/^\.S[SH] /p" "$page" | sed 1d | grep -qF -- "${3//-/\\-}"; then
    echo "the manual page of $1 has no section '$2' with $3:" >&2
    grep -n '^\.S[SH]' "$page" >&2
    exit 1
  fi
}

for program in ergocast ergocast-ros2; do
  [ -x "$1/$program" ] || continue # without CycloneDDS there is no ergocast-ros2
  "$here/../../packaging/man/make-page" "$1/$program" "$work/$program.1"
done
has ergocast export --to
has ergocast 'study merge' --out
[ ! -e "$work/ergocast-ros2.1" ] || has ergocast-ros2 map --save
