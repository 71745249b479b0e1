#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# examples/law/spiral.cc, built with what libergocast-dev installs: it finds what the same law in Python
# finds, and the default finds what a study of it does.
#   law_test.sh BUILD_FOLDER
set -euo pipefail
build=$1
source=$(cd "$(dirname "$0")/../.." && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

fail() {
  echo "FAIL: $*" >&2
  exit 1
}

cmake --install "$build" --component dev --prefix "$work/installed" >/dev/null
cmake -S "$source/examples/law" -B "$work/law" -DCMAKE_PREFIX_PATH="$work/installed" >"$work/said" 2>&1 &&
  cmake --build "$work/law" >>"$work/said" 2>&1 || fail "$(cat "$work/said")"

scenario=$source/studies/law/random.textproto
sed 's/duration_s: 2000/duration_s: 60/' "$scenario" >"$work/random.textproto"
grep -q 'duration_s: 60' "$work/random.textproto" || fail 'the scenario has another duration'
"$work/law/spiral" "$work/random.textproto" 3 >"$work/found"
"$build/bin/ergocast" study "$work/random.textproto" --seeds 1:3 --out "$work/study" \
  --vary "law.kind=COVER,$source/examples/law/spiral.py:Spiral" >/dev/null
/usr/bin/python3 - "$work" <<'END'
import csv, sys
rows = list(csv.DictReader(open(sys.argv[1] + "/study/study.csv")))
found = [line.split() for line in open(sys.argv[1] + "/found")]
assert [seed for seed, _, _ in found] == ["1", "2", "3"], found
for i, (seed, default, spiral) in enumerate(found):
    for row, value in ((rows[i], default), (rows[i + 3], spiral)):
        assert row["seed"] == seed and abs(float(row["detection_probability"]) - float(value)) < 1e-6, (row, value)
    assert default != spiral
END
echo 'the law in C++ finds what the one in Python finds'
