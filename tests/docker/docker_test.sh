#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# The image and the compose files: a team of containers runs a mission, survives faults of
# containers, and leaves a record that belongs to the user.
#   docker_test.sh BUILD_DIR
# shellcheck disable=SC2034,SC2154
more_tools='dockerd docker docker-compose iptables ip nsenter'

export ERGOCAST_CGROUP=${ERGOCAST_CGROUP:-/ergocast-test-$$}
after_all() {
  find /sys/fs/cgroup -depth -type d -path "*$ERGOCAST_CGROUP*" -exec rmdir {} + 2>/dev/null || true
}

# shellcheck source=tests/package/debian.sh
. "$(dirname "$0")/../package/debian.sh"
source=$(cd "$(dirname "$0")/../.." && pwd)
# shellcheck source=tests/docker/engine.sh
. "$(dirname "$0")/engine.sh"
# shellcheck source=tests/docker/team.sh
. "$(dirname "$0")/team.sh"

the_image_runs_every_program_and_nothing_as_root() {
  local program size
  for program in ergocast ergocast-agent ergocast-coordinator ergocast-logger ergocast-relay ergocast-sim; do
    expect docker run --rm ergocast $program --version
  done
  [ "$(docker run --rm --entrypoint id ergocast -u)" = 1000 ] || fail 'the image is root'
  mkdir -m 777 "$work/simulated"
  expect docker run --rm --network none --volume "$work/simulated:/runs" ergocast \
    simulate quadrimodal_corners --duration 20
  expect test -s "$work"/simulated/*/report.html
  size=$(state ergocast .Size)
  echo "  the image takes $((size / 1000000)) MB, $(($(state debian-12 .Size) / 1000000)) MB of them Debian"
}

a_scaled_team_flies_to_the_end_and_the_record_is_the_persons() {
  start_team scaled 8 --duration 60
  expect_complete
  stop_team
  [ -z "$(find "$ERGOCAST_RUNS" ! -user "$person")" ] || fail 'parts of the record are not the person'\''s'
  expect test -s "$ERGOCAST_RUNS"/*/report.html
}

a_team_of_more_than_planned_flies_too() {
  plan more 4 --duration 60
  expect compose up --detach --scale agent=6
  expect_complete
  stop_team
}

too_few_agents_end_with_a_sentence() {
  ERGOCAST_SCENARIO=impatient
  plan too_few 3
  # The agents first: a slow machine may take longer to start them than the coordinator waits.
  expect compose up --detach --scale agent=2 agent
  expect compose up --detach --scale agent=2
  becomes all_ended
  is "$(one coordinator)" .State.ExitCode 4 || complain 'a mission without its quorum is no failure'
  expect says coordinator 'only 2 of the quorum of 3 agents were admitted'
  stop_team
  ERGOCAST_SCENARIO=patient
}

# Faults of members happen during the mission, so these missions last until the test ends them.
endless=(--duration 10000000)
a_killed_agent_comes_back_under_its_number() {
  start_team killed 4 "${endless[@]}"
  becomes recorded 10000
  local agent
  agent=$(one agent)
  kill -KILL "$(state "$agent" .State.Pid)"
  becomes is "$agent" .RestartCount 1
  becomes says coordinator 'agent [0-3] .* is gone at tick'
  expect_end_when_told
  ! says coordinator 'agent 4 ' || complain 'it came back under another number'
  stop_team
}

an_agent_container_that_is_removed_is_replaced() {
  start_team removed 4 "${endless[@]}"
  becomes recorded 10000
  docker rm --force "$(one agent)" >/dev/null
  compose up --detach --scale agent=4 agent
  becomes says coordinator 'agent [0-3] .* is gone at tick'
  expect_end_when_told
  stop_team
}

an_agent_cut_off_from_the_network_is_unhealthy_and_agrees_again() {
  start_team cut_off 4 "${endless[@]}"
  becomes recorded 10000
  local agent
  agent=$(one agent)
  docker network disconnect team_default "$agent"
  becomes says coordinator 'agent [0-3] .* is silent'
  becomes is "$agent" .State.Health.Status unhealthy
  docker network connect team_default "$agent"
  becomes says agent 'listening on another network interface'
  becomes says coordinator 'agent [0-3] .* is alive at tick [1-9]'
  expect_end_when_told
  stop_team
}

a_logger_that_dies_goes_on_with_its_record() {
  start_team logger 4 "${endless[@]}"
  becomes recorded 10000
  kill -KILL "$(pgrep -x ergocast-logger)"
  becomes is "$(one logger)" .RestartCount 1
  expect_end_when_told
  expect test -d "$ERGOCAST_RUNS"/*  # one folder
  stop_team
}

in_real_time_all_are_healthy_and_nobody_is_root_and_stop_ends_it_in_order() {
  start_team real_time 4 --realtime "${endless[@]}"
  becomes recorded 1000
  becomes all_healthy
  local process
  for process in $(pids_of_programs); do
    [ "$(stat -c %u "/proc/$process")" != 0 ] || fail "$(cat "/proc/$process/comm") runs as root"
  done
  docker network disconnect team_default "$(one agent)"
  becomes says coordinator 'agent [0-3] .* is silent'
  docker network connect team_default "$(one agent)"
  becomes says coordinator 'agent [0-3] .* is alive at tick [1-9]'
  compose stop
  says coordinator 'mission ended .*: a signal stopped the coordinator' || complain 'not ended in order'
  expect test -s "$ERGOCAST_RUNS"/*/report.html
  stop_team
}

hosts_without_bridges_fly_too() {
  over='-f compose.hosts.yaml'
  start_team hosts 4 --duration 60
  expect_complete
  stop_team
  over=
}

a_team_with_keys_flies_and_who_has_none_is_told() {
  make_keys "$ERGOCAST_KEYS"
  over='-f compose.keys.yaml'
  start_team keyed 4 "${endless[@]}"
  becomes recorded 10000
  expect docker exec "$(one coordinator)" ergocast status
  ! docker run --rm --network team_default ergocast status >"$work/keyless" 2>&1 ||
    complain 'it runs without its key'
  expect grep 'has a mission key' "$work/keyless"
  compose stop
  expect grep -q '"result": "stopped"' "$ERGOCAST_RUNS"/*/summary.json
  stop_team
  over=
}

what_deploy_writes_flies() {
  printf 'box coordinator logger sim agent 0 1 agents=2\n' >"$work/hosts"
  ERGOCAST_RUNS=$work/deployed/runs
  mkdir "$work/deployed"
  make_keys "$work/deployed/mission"
  expect "$build/bin/ergocast" deploy "$ERGOCAST_SCENARIOS/patient.textproto" --hosts "$work/hosts" \
    --to compose --keys "$work/deployed/mission" --out "$work/deployed"
  expect docker-compose -f "$work/deployed/compose.yaml" up --detach
  expect_complete
  expect docker-compose -f "$work/deployed/compose.yaml" down
}

claim() {
  local begun=$SECONDS
  echo "- ${1//_/ }"
  "$1"
  echo "  ($((SECONDS - begun)) s)"
}

make_bare_system
pack
claim the_image_is_built_from_the_package
start_isolated_engine
make_person
for name in the_image_runs_every_program_and_nothing_as_root \
  a_scaled_team_flies_to_the_end_and_the_record_is_the_persons \
  a_team_of_more_than_planned_flies_too \
  too_few_agents_end_with_a_sentence \
  a_killed_agent_comes_back_under_its_number \
  an_agent_container_that_is_removed_is_replaced \
  an_agent_cut_off_from_the_network_is_unhealthy_and_agrees_again \
  a_logger_that_dies_goes_on_with_its_record \
  in_real_time_all_are_healthy_and_nobody_is_root_and_stop_ends_it_in_order \
  hosts_without_bridges_fly_too \
  a_team_with_keys_flies_and_who_has_none_is_told \
  what_deploy_writes_flies; do
  claim $name
done
stop_engine
