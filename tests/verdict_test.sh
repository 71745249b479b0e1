#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# ./test with other tests ends with their result, and fails if a test is skipped that should run.
#   verdict_test.sh SOURCE_DIR
set -euo pipefail
source=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

fail() { echo "FAILED: $*" >&2; cat "$work/said" >&2; exit 1; }

# A tree whose set-up does nothing.
mkdir -p "$work/packaging" "$work/tests" "$work/build/release" "$work/build/asan"
cp "$source/test" "$work"
cp "$source/tests/verdict" "$work/tests"
cat >"$work/packaging/setup.sh" <<'SETUP'
root=$here
build_preset() { :; }
SETUP
# shellcheck disable=SC2016  # ctest expands them
cat >"$work/build/release/CTestTestfile.cmake" <<'TESTS'
function(says name label text)
  add_test(${name} /bin/sh -c "printf '%b' '${text}'; exit $ENV{CODE_OF_${name}}")
  set_tests_properties(${name} PROPERTIES LABELS ${label}
    SKIP_REGULAR_EXPRESSION "\\[  SKIPPED \\]" SKIP_RETURN_CODE 77)
endfunction()
says(Good.One good "fine\\n")
says(Good.Two good "<fine> & well\\n")
says(Lacks.Netem lacks "[ RUN      ] Lacks.Netem\\n/a/b_test.cc:7: Skipped\\nthis kernel has no netem\\n\\n[  SKIPPED ] Lacks.Netem (0 ms)\\n")
says(lacks_root lacks "skipped: networks of several hosts need root\\n")
says(Planted.Skip planted "[ RUN      ] Planted.Skip\\n/a/b_test.cc:7: Skipped\\nnot installed: xvfb\\n\\n[  SKIPPED ] Planted.Skip (0 ms)\\n")
says(planted_skip planted_script "skipped: dockerd is missing: packaging/packages-test.txt, which needs root\\n")
says(bad_one bad "")
says(switched_off off "")
set_tests_properties(switched_off PROPERTIES DISABLED TRUE)
TESTS
cat >"$work/build/asan/CTestTestfile.cmake" <<'TESTS'
add_test(Good.Part /bin/true)
set_tests_properties(Good.Part PROPERTIES LABELS part)
add_test(not_there /nonexistent/program)
set_tests_properties(not_there PROPERTIES LABELS missing)
TESTS
export CODE_OF_lacks_root=77 CODE_OF_planted_skip=77 CODE_OF_bad_one=1

# expect CODE LAST_LINE [ARGUMENT…]
expect() {
  local code=0 last
  "$work/test" "${@:3}" >"$work/said" 2>&1 || code=$?
  last=$(tail -n 1 "$work/said")
  [ "$code" -eq "$1" ] || fail "./test ${*:3} ended with $code, not $1"
  [ "$last" = "$2" ] || fail "./test ${*:3} ended with '$last', not '$2'"
}
says() { grep -qF -- "$1" "$work/said" || fail "no word of: $1"; }

expect 0 '2 passed, 0 failed, 0 skipped' -L good
expect 0 '1 passed, 0 failed, 0 skipped' -R Two
expect 0 '3 passed, 0 failed, 0 skipped' -L '^good$|^part$'  # from both folders
expect 0 '0 passed, 0 failed, 2 skipped' -L lacks
says 'skipped: Lacks.Netem: this kernel has no netem'
says 'skipped: lacks_root: skipped: networks of several hosts need root'
expect 1 '2 passed, 0 failed, 1 skipped' -L '^good$|^planted$'
says 'skipped: Planted.Skip: not installed: xvfb'
says '1 of them '
expect 1 '0 passed, 0 failed, 1 skipped' -L planted_script
expect 1 '2 passed, 0 failed, 1 skipped' -L '^good$|^off$'
expect 8 '0 passed, 1 failed, 0 skipped' -L missing
expect 8 '2 passed, 1 failed, 1 skipped' -L '^(good|bad|planted)$'
expect 0 'Total Tests: 10' -N
expect 8 'Errors while running CTest' -R no_such_test
echo 'each ends as it should'
