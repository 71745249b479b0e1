#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# The installed services under a separate systemd (systemd-nspawn): they run a mission, restart
# after crashes, exit normally, take a mission key, and are sandboxed.
# shellcheck disable=SC2034
more_tools='systemd-nspawn nsenter pgrep'

# nspawn makes control groups below its own; none may remain.
hierarchies='/sys/fs/cgroup /sys/fs/cgroup/systemd /sys/fs/cgroup/unified'
before_all() {
  local hierarchy
  for hierarchy in $hierarchies; do
    [ -f "$hierarchy/cgroup.procs" ] || continue
    mkdir "$hierarchy/ergocast-services-$$"
    echo $$ >"$hierarchy/ergocast-services-$$/cgroup.procs"
  done
}
after_all() {
  local hierarchy
  for hierarchy in $hierarchies; do
    [ -d "$hierarchy/ergocast-services-$$" ] || continue
    echo $$ >"$hierarchy/cgroup.procs"
    find "$hierarchy/ergocast-services-$$" -depth -type d -exec rmdir {} + || true
  done
}

# shellcheck source=tests/package/debian.sh
. "$(dirname "$0")/debian.sh"

# Prints the services' journal, if the system runs.
fail() {
  [ -z "${init:-}" ] || journal >&2
  echo "FAILED: $*" >&2
  exit 1
}

# Waits until a command succeeds, or until the system has ended or one of the services has failed.
# Then the command is tried once more.
patience_s=300
eventually() {
  local deadline=$((SECONDS + patience_s)) in_vain=
  until "$@"; do
    [ -z "$in_vain" ] && [ "$SECONDS" -lt "$deadline" ] || fail "never: $*"
    sleep 0.05
    if ! kill -0 "$nspawn" 2>/dev/null || [ -n "$(failed_services)" ]; then in_vain=yes; fi
  done
}
failed_services() {
  [ -z "${init:-}" ] || there systemctl list-units --failed --plain --no-legend 'ergocast-*' 2>/dev/null || true
}

boot() {
  # systemd does not start if it exists; and nspawn leaves folders in /run.
  umount "$root/proc"
  mount -t tmpfs tmpfs /run
  systemd-nspawn --register=no --keep-unit --private-network --resolv-conf=off --timezone=off \
    --link-journal=no --console=pipe --directory="$root" --boot </dev/null >"$work/boot.log" 2>&1 &
  nspawn=$!
  up() { kill -0 "$nspawn" 2>/dev/null || { cat "$work/boot.log"; fail 'systemd-nspawn'; }
         init=$(pgrep -x -o systemd) && there systemctl is-system-running 2>/dev/null | grep -qE 'running|degraded'; }
  eventually up
  there_ip link set lo up
  there_ip route add 224.0.0.0/4 dev lo
}

there() { nsenter -t "$init" --mount --uts --ipc --net --pid --root --wd -- "$@" </dev/null; }
there_ip() { nsenter -t "$init" --net -- ip "$@"; }
journal() { there journalctl --no-pager -o cat -u 'ergocast-*' | tail -n 60; }

agents='ergocast-agent@0 ergocast-agent@1 ergocast-agent@2 ergocast-agent@3'
all="$agents ergocast-sim ergocast-logger ergocast-coordinator"
records=/var/lib/ergocast

property() { there systemctl show --value --property="$2" "$1"; }
is() { [ "$(property "$1" ActiveState)" = "$2" ]; }
all_are() { local unit; for unit in $2; do is "$unit" "$1" || return 1; done; }
restarted() { [ "$(property "$1" NRestarts)" -ge "$2" ] && is "$1" active; }
count_records() { there sh -c "ls $records | grep -c '^2'"; }
# Rows of the record that is being written, all its segments.
rows() { there sh -c "cat $records/current/trajectory*.csv 2>/dev/null | wc -l"; }
took_over() { there journalctl -o cat -u ergocast-coordinator | grep -q ', taken over'; }
recorded() { [ "$(rows)" -ge "$1" ]; }
kill_one() { there systemctl kill --kill-whom=main --signal=KILL "$1"; }

# A mission that waits for every process: its ticks wait while one is restarted. A mission that a test
# disturbs is endless. Its record is in memory, so it must not grow fast.
endless=10000000
use_scenario() {
  sed "s/duration_s: 600/duration_s: $1  lockstep_timeout_s: 600  admission_timeout_s: 600  broadcast_period_ticks: 20/" \
    "$root/usr/share/ergocast/scenarios/quadrimodal_corners.textproto" >"$root/etc/ergocast/test.textproto"
  grep -q lockstep_timeout_s "$root/etc/ergocast/test.textproto" || fail 'the scenario is another'
  sed -i 's,^ERGOCAST_SCENARIO=.*,ERGOCAST_SCENARIO=/etc/ergocast/test.textproto,' "$root/etc/ergocast/ergocast.env"
}

check_units() {
  local unit
  for unit in ergocast-agent@0 ergocast-sim ergocast-logger ergocast-coordinator; do
    there systemd-analyze verify --man=no "$unit.service" >"$work/said" 2>&1 && [ ! -s "$work/said" ] ||
      { cat "$work/said"; fail "systemd-analyze verify $unit"; }
    there systemd-analyze security --no-pager --threshold=15 "$unit.service" >"$work/said" 2>&1 ||
      { cat "$work/said"; fail "$unit is not shut in"; }
    tail -n 1 "$work/said"
  done
  [ "$(there sh -c 'ls /etc/systemd/system/multi-user.target.wants/ | grep -c ergocast || true')" = 0 ] ||
    fail 'the package enabled a service'
}

check_mission_with_crashes() {
  use_scenario $endless
  there systemctl start $all
  eventually recorded 2000
  # The mission stands still now, so that all that follows happens during it.
  there systemctl kill --signal=STOP ergocast-sim
  for unit in ergocast-agent@2 ergocast-logger ergocast-coordinator; do
    kill_one $unit
    eventually restarted $unit 1
  done
  local before
  before=$(rows)
  there systemctl kill --signal=CONT ergocast-sim
  eventually recorded $((before + 2000))
  # A coordinator that still looks for the mission could not end it.
  eventually took_over
  there systemctl stop ergocast-coordinator
  eventually all_are inactive "$all"
  [ "$(count_records)" = 1 ] || fail 'the logger did not go on in its record'
  there grep -q '"result": "stopped"' $records/latest/summary.json ||
    { there cat $records/latest/summary.json; fail 'the mission did not end in order'; }
  there test -s $records/latest/report.html || fail 'no report'
  there sh -c "[ ! -e $records/current ]" || fail 'the record is still open'
}

check_complete_mission() {
  use_scenario 30
  there systemctl start $all
  eventually all_are inactive "$all"
  [ "$(count_records)" = 2 ] || fail 'the second mission has no record of its own'
  there grep -q '"result": "done"' $records/latest/summary.json ||
    { there cat $records/latest/summary.json; fail 'the mission is not complete'; }
  sleep 3
  all_are inactive "$all" || fail 'a complete mission was begun again'
}

# A restarted coordinator without a running mission starts none.
check_crash_on_the_ground() {
  there systemctl start ergocast-coordinator
  kill_one ergocast-coordinator
  eventually is ergocast-coordinator failed
  there journalctl -o cat -u ergocast-coordinator >"$work/said"
  tail -n 5 "$work/said" | grep -q 'knows a mission' || { tail -n 20 "$work/said"; fail 'it waits for a team'; }
  there systemctl reset-failed
}

check_bad_input() {
  sed -i 's,^ERGOCAST_SCENARIO=.*,ERGOCAST_SCENARIO=nonsense,' "$root/etc/ergocast/ergocast.env"
  there systemctl start ergocast-coordinator
  eventually is ergocast-coordinator failed
  [ "$(property ergocast-coordinator NRestarts)" = 0 ] || fail 'bad input was tried again'
  [ "$(property ergocast-coordinator ExecMainStatus)" = 2 ] || fail 'another exit code'
  there systemctl reset-failed
}

check_late_network() {
  there_ip route del 224.0.0.0/4 dev lo
  there systemctl start ergocast-agent@auto
  tried_again() { [ "$(property ergocast-agent@auto NRestarts)" -ge 1 ]; }
  eventually tried_again
  there_ip route add 224.0.0.0/4 dev lo
  eventually is ergocast-agent@auto active
  there systemctl stop ergocast-agent@auto
  is ergocast-agent@auto inactive || fail 'systemctl stop'
}

check_next_mission() {
  local unit i
  for unit in ergocast-agent@ ergocast-sim ergocast-logger; do
    there mkdir -p /etc/systemd/system/$unit.service.d
    there ln -s /usr/share/ergocast/systemd/next-mission.conf /etc/systemd/system/$unit.service.d/
  done
  there systemctl daemon-reload
  use_scenario 30
  there systemctl start $agents ergocast-sim ergocast-logger
  for i in 3 4; do
    there systemctl start ergocast-coordinator
    eventually is ergocast-coordinator inactive
    again() { all_are active "$agents ergocast-sim ergocast-logger" && [ "$(count_records)" -gt $i ]; }
    eventually again
    there grep -q '"result": "done"' $records/latest/summary.json || fail "mission $i is not complete"
  done
}

# Runs the script of "ergocast deploy --keys", with an ssh into this system and a sudo for root.
use_keys() {
  mkdir "$work/bin"
  cat >"$work/bin/ssh" <<END
#!/bin/sh
exec nsenter -t $init --mount --uts --ipc --net --pid --root --wd -- sh -c "\$2"
END
  printf '#!/bin/sh\nexec "$@"\n' >"$root/usr/local/bin/sudo"
  chmod +x "$work/bin/ssh" "$root/usr/local/bin/sudo"
  "$build/bin/ergocast" keygen "$work/team" >/dev/null
  echo 'box coordinator logger sim agents=4' >"$work/hosts"
  "$build/bin/ergocast" deploy "$root/etc/ergocast/test.textproto" --hosts "$work/hosts" --to systemd \
    --keys "$work/team" --out "$work" >/dev/null
  PATH=$work/bin:$PATH "$work/quadrimodal_corners-systemd.sh" setup
}

check_mission_with_keys() {
  local url='udpm://239.255.76.67:7667?ttl=0'
  there systemctl stop $all
  use_scenario $endless
  use_keys
  [ "$(there stat -c '%a %U' /etc/ergocast/mission.key /etc/ergocast/mission.coordinator.key | uniq)" = '600 root' ] ||
    fail 'others may read the keys'
  # An agent without the key reports that the team has one.
  there systemd-run --quiet --unit=outsider ergocast-agent --lcm-url "$url"
  there systemctl start $all
  eventually recorded 500
  outsider_says() { there journalctl -o cat -u outsider | grep -q 'a team with a --key-file is on this URL'; }
  eventually outsider_says
  there systemctl stop outsider
  ! there ergocast status --lcm-url "$url" >"$work/said" 2>&1 || fail 'the team runs without its key'
  grep -q 'has a mission key' "$work/said" || fail "status: $(cat "$work/said")"
  there ergocast status --lcm-url "$url" --key-file /etc/ergocast/mission.key >"$work/said" 2>&1 ||
    fail "status: $(cat "$work/said")"
  there systemctl stop ergocast-coordinator
  ended() { there grep -q '"result": "stopped"' $records/latest/summary.json; }
  eventually ended
}

check_removal() {
  there systemctl enable ergocast-sim 2>/dev/null
  rm -r "$root/etc/ergocast/test.textproto" "$root/etc/ergocast/mission"
  there dpkg --purge ergocast >/dev/null
  [ -z "$(there pgrep -f ergocast || true)" ] || fail 'services run on'
  [ -z "$(there find /etc /var/lib /usr -iname '*ergocast*' ! -path '*/dpkg/*' ! -path '*.service.d' | head)" ] ||
    fail "purged, and there still is: $(there find /etc /var/lib /usr -iname '*ergocast*' | head)"
}

make_bare_system
pack
cp "$deb" "$root/tmp/"
apt_install "/tmp/$(basename "$deb")" systemd procps
boot
check_units
check_mission_with_crashes
check_complete_mission
check_crash_on_the_ground
check_bad_input
check_late_network
check_next_mission
check_mission_with_keys
check_removal
echo 'the services fly, come back and end'
