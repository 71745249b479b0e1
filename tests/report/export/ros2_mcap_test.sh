#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# An MCAP file for ROS 2 has the contents of the record: ros2_mcap_test.sh ERGOCAST MCAP_READER ROS2_READER. The
# folders keep the readers, from npm's registry, between tests.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
ergocast=$1 mcap_reader=$2 ros2_reader=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

"$here/reader/fetch" "$mcap_reader"
"$here/../../bridges/ros2/reference/fetch" "$ros2_reader"
read_it() {
  node "$here/read_ros2_mcap.cjs" "$mcap_reader" "$ros2_reader" "$1" "$2"
}

# An oblong domain that begins elsewhere than at (0, 0), walls, objects, false alarms and a new target.
cat >"$work/floor.textproto" <<'END'
name: "floor"
domain { origin_x_m: -10 origin_y_m: 5 size_x_m: 100 size_y_m: 60 }
target { gaussians { mean_x_m: 60 mean_y_m: 25 sigma_m: 10 } uniform_weight: 1 }
basis { modes_x: 8 modes_y: 6 }
law { u_max_mps: 4 }
time { dt_s: 0.1 duration_s: 120 pace: LOCKSTEP }
agents { starts { x_m: 0 y_m: 10 } starts { x_m: 80 y_m: 60 } }
world {
  speed_limit_mps: 20 wall_clearance_m: 1
  walls { vertices { x_m: 40 y_m: 30 } vertices { x_m: 41 y_m: 30 } vertices { x_m: 41 y_m: 70 }
          vertices { x_m: 40 y_m: 70 } }
  objects { count: 3 }
}
sensor { radius_m: 6 detections_per_s: 0.5 false_alarms_per_s: 0.02 position_error_m: 1 }
END
cat >"$work/other.textproto" <<'END'
target { gaussians { mean_x_m: 10 mean_y_m: 50 sigma_m: 10 } uniform_weight: 1 }
END
"$ergocast" simulate "$work/floor.textproto" --amend "90:$work/other.textproto" --out "$work/run" >/dev/null
printf '%s\n' '2026-04-12T10:15:00.123 info agent-3: agent 3 of run 1: running' 'and a second line' \
  '2026-04-12T10:15:01.000 warning sim: late' >"$work/run/log/agent-3.log"
"$ergocast" export "$work/run" --to mcap --schema ros2
read_it "$work/run/export_ros2.mcap" "$work/run" | tee "$work/topics"

# The layout names topics of the file, and of each kind of them.
node "$here/check_layout.cjs" "$here/../../../report/export/foxglove_ros2_layout.json" "$work/topics"

# Only an MCAP file has such messages.
code=0
"$ergocast" export "$work/run" --to csv --schema ros2 2>"$work/said" || code=$?
if [ "$code" != 2 ] || ! grep -q -- '--schema is for --to mcap' "$work/said"; then
  cat "$work/said" >&2
  exit 1
fi

# The reader finds errors: the other schema, a wrong number, and a truncated file.
"$ergocast" export "$work/run" --to mcap >/dev/null
file=$work/run/export_ros2.mcap
place=$(grep -abo 'agent0' "$file" | sed -n '2s/:.*//p')  # the first message's frame, behind its channel's name
cp "$file" "$work/spoiled.mcap"
printf '\x7f' | dd of="$work/spoiled.mcap" bs=1 seek=$((place + 24)) conv=notrunc status=none
head -c -100 "$file" >"$work/cut.mcap"
for file in run/export spoiled cut; do
  if read_it "$work/$file.mcap" "$work/run" >/dev/null 2>"$work/said"; then
    echo "$file.mcap was read without an objection" >&2
    exit 1
  fi
  echo "$file: $(head -1 "$work/said")"
done
