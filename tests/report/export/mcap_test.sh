#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# An exported MCAP file has the contents of the record: mcap_test.sh ERGOCAST FOLDER. FOLDER keeps
# the reference reader, from npm's registry, between tests.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
ergocast=$1 reader=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

"$here/reader/fetch" "$reader"
{ echo 'origin { latitude_deg: 47.5 longitude_deg: 9.2 }'
  cat "$here/../../../scenarios/harbour_patrol.textproto"; } >"$work/there.textproto"
"$ergocast" simulate "$work/there.textproto" --duration 60 --out "$work/run" >/dev/null
# Lines as a run's processes write them.
printf '%s\n' '2026-04-12T10:15:00.123 info agent-3: agent 3 of run 1: running' 'and a second line' \
  '2026-04-12T10:15:01.000 warning sim: late' >"$work/run/log/agent-3.log"
"$ergocast" export "$work/run" --to mcap --out "$work/run.mcap"
node "$here/read_mcap.cjs" "$reader" "$work/run.mcap" "$work/run"

# If the modes are not cosines, φ² names them.
cat >"$work/rooms.textproto" <<'END'
origin { latitude_deg: 47.5 longitude_deg: 9.2 }
domain { size_x_m: 100 size_y_m: 50 }
target { gaussians { mean_x_m: 80 mean_y_m: 20 sigma_m: 5 } }
basis { modes_x: 5 modes_y: 4 free_domain: true }
law { u_max_mps: 5 }
time { dt_s: 0.1 duration_s: 10 pace: LOCKSTEP }
agents { starts { x_m: 10 y_m: 20 } starts { x_m: 90 y_m: 30 } }
world {
  speed_limit_mps: 20 wall_clearance_m: 1
  walls { vertices { x_m: 49.8 y_m: 10 } vertices { x_m: 50.2 y_m: 10 }
          vertices { x_m: 50.2 y_m: 60 } vertices { x_m: 49.8 y_m: 60 } }
}
END
"$ergocast" simulate "$work/rooms.textproto" --out "$work/rooms" >/dev/null
"$ergocast" export "$work/rooms" --to mcap --out "$work/rooms.mcap"
node "$here/read_mcap.cjs" "$reader" "$work/rooms.mcap" "$work/rooms"

# The reader finds errors: a wrong digit of a pose, and a truncated file.
place=$(grep -abo '"position":{"x":' "$work/run.mcap" | sed -n '1s/:.*//p')
cp "$work/run.mcap" "$work/spoiled.mcap"
printf '9' | dd of="$work/spoiled.mcap" bs=1 seek=$((place + 17)) conv=notrunc status=none
head -c -100 "$work/run.mcap" >"$work/cut.mcap"
for file in spoiled cut; do
  if node "$here/read_mcap.cjs" "$reader" "$work/$file.mcap" "$work/run" 2>"$work/said"; then
    echo "$file.mcap was read without an objection" >&2
    exit 1
  fi
  echo "$file: $(head -1 "$work/said")"
done
