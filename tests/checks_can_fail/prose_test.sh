#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# .ci/prose finds each planted sentence and no correct one; .ci/checks fails with it.
#   prose_test.sh SOURCE_DIR
set -euo pipefail
source=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

fail() { echo "FAILED: $*" >&2; cat "$work/output" >&2; exit 1; }
# run CODE COMMAND…  in the planted tree
run() {
  local code=0
  (cd "$work/tree" && "${@:2}") >"$work/output" 2>&1 || code=$?
  [ "$code" -eq "$1" ] || fail "${*:2} ended with $code, not $1"
}
finds() { grep -qF -- "$1" "$work/output" || fail "nothing found: $1"; }

# A tree whose set-up does nothing and whose formatter finds nothing.
mkdir -p "$work/tree/.ci" "$work/tree/packaging" "$work/tree/core" "$work/tree/docs" "$work/bin"
cp "$source/.ci/checks" "$source/.ci/prose" "$work/tree/.ci"
mkdir -p "$work/tree/tests/mutants"
cp "$source/tests/mutants/run" "$work/tree/tests/mutants"
echo "No mutants." >"$work/tree/tests/mutants/list.txt"
echo 'say() { echo "$*"; }' >"$work/tree/packaging/setup.sh"
printf '#!/bin/sh\n' >"$work/bin/clang-format"
chmod +x "$work/bin/clang-format"
export PATH=$work/bin:$PATH
git -C "$work/tree" init --quiet

cat >"$work/tree/core/good.cc" <<'GOOD'
// Of course an agent reports. A person who reads this asks: who sends? `who` is an argument.
// ---- a section ----
/// @param who  Philox(seed, who, step)
const char* kText = "the agent sends what it has received";
GOOD
git -C "$work/tree" add .
run 0 .ci/prose
finds 'prose: 0 of opening, 0 of who, 0 of verb, 0 of banner'
run 0 .ci/checks format

cat >"$work/tree/core/bad.cc" <<'BAD'
// The world moves. Of it nothing is known.
// ---- half a section
// -------------------------------------------------------
int a;  // an agent stops,
        // and who is late stands
// Who joins late
// waits for the rest, and the coordinator never
// says why.
const char* kText = "the logger has not heard "
                    "a world";
BAD
cat >"$work/tree/docs/bad.md" <<'BAD'
# A page

An agent moves on. Nobody
waits for it.

| name | meaning |
|---|---|
| tick | Of the world |

- So many agents join that the team tells their names.

    who = "code"
BAD
echo '# the mission that an agent flies' >"$work/tree/core/CMakeLists.txt"
printf '"""So much for a process, which dies."""\n' >"$work/tree/core/bad.py"
git -C "$work/tree" add .
run 1 .ci/prose
finds 'core/bad.cc:1: opening: Of it nothing'
finds 'core/bad.cc:2: banner: // ---- half a section'
finds 'core/bad.cc:3: banner: // ----'
finds 'core/bad.cc:5: who: an agent stops, and who is late stands'
finds 'core/bad.cc:6: opening: Who joins late'
finds 'core/bad.cc:8: verb: coordinator never says'
finds 'core/bad.cc:9: verb: logger has not heard'
finds 'docs/bad.md:3: opening: Nobody waits'
finds 'docs/bad.md:8: opening: Of the world'
finds 'docs/bad.md:10: opening: So many agents'
finds 'docs/bad.md:10: verb: team tells'
finds 'core/CMakeLists.txt:1: verb: agent flies'
finds 'core/bad.py:1: opening: So much'
finds 'prose: 6 of opening, 1 of who, 4 of verb, 2 of banner'
run 1 .ci/checks format

# Allowed findings are not printed, an additional one is, and the counts only shrink.
cat >"$work/tree/.ci/prose_allowed" <<'ALLOWED'
9 opening core
1 who core
3 verb core
2 banner core
3 opening docs
1 verb docs
ALLOWED
run 0 .ci/prose
echo '// Nobody waits.' >>"$work/tree/core/good.cc"
run 0 .ci/prose --lower
grep -qx '4 opening core' "$work/tree/.ci/prose_allowed" || fail 'the count is not lowered'
echo '// So few wait.' >>"$work/tree/core/good.cc"
run 1 .ci/prose --lower
finds 'core: 5 of opening, 4 allowed'
grep -qx '4 opening core' "$work/tree/.ci/prose_allowed" || fail 'the count is raised'
echo 'each sentence that is planted is found'
