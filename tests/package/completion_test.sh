#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Bash completes commands, options, scenarios and fields of `ergocast`.
#   completion_test.sh BIN_DIR
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
PATH=$1:$PATH
set +u  # the library reads unset variables
# shellcheck source=/dev/null
. /usr/share/bash-completion/bash_completion
# shellcheck source=packaging/completion/ergocast
. "$root/packaging/completion/ergocast"
compopt() { :; }  # only a shell at a terminal has it

# The completions at the end of a line.
offers() {
  COMP_LINE=$1 COMP_POINT=${#1}
  read -ra COMP_WORDS <<<"$1"
  [[ $1 != *' ' ]] || COMP_WORDS+=("")
  COMP_CWORD=$((${#COMP_WORDS[@]} - 1)) COMPREPLY=()
  _ergocast
  printf '%s\n' "${COMPREPLY[@]}"
}
failed=0
expect() {  # LINE WORD...: every word is offered
  local typed=$1 word found
  found=$(offers "$typed")
  for word in "${@:2}"; do
    grep -qxF -- "$word" <<<"$found" || { echo "\"$typed\" does not offer $word, but: ${found//$'\n'/ }"; failed=1; }
  done
}
refuse() {
  ! offers "$1" | grep -qxF -- "$2" || { echo "\"$1\" offers $2"; failed=1; }
}

expect "ergocast " run simulate study check status list stop watch spy doctor
expect "ergocast st" status stop study
refuse "ergocast st" run
expect "ergocast run --" --set --out --seed --lockstep --key-file --watch
refuse "ergocast run --" --vary
expect "ergocast deploy --s" --set --seed
expect "ergocast list --p" --pid
expect "ergocast study --v" --vary --version
expect "ergocast study me" merge
expect "ergocast study merge --o" --out
refuse "ergocast study merge --o" --jobs
expect "ergocast simulate quadri" quadrimodal_corners
expect "ergocast run quadrimodal_corners --set law.e" law.epsilon= law.ends_with_plan=
expect "ergocast study quadrimodal_corners --vary law.epsilon=1 --vary time." time.duration_s=
expect "ergocast check quadrimodal_corners --set " seed= agents.quorum=
refuse "ergocast check quadrimodal_corners --set " name=
refuse "ergocast run --set " seed=
exit "$failed"
