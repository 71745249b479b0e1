# SPDX-License-Identifier: BSD-3-Clause
# Sourced by docker_test.sh (bash): the steps of a person with the compose files, and their expected results.
# shellcheck shell=bash disable=SC2154  # work and source are set before

person=4321
over=
export COMPOSE_PROJECT_NAME=team ERGOCAST_SCENARIOS=$work/scenarios ERGOCAST_SCENARIO=patient
export ERGOCAST_AGENTS ERGOCAST_OPTIONS ERGOCAST_RUNS ERGOCAST_KEYS=$work/team

# The owner of the scenarios must also own the records.
make_person() {
  mkdir "$ERGOCAST_SCENARIOS"
  local file=$source/scenarios/quadrimodal_corners.textproto
  sed 's/pace: .*/& lockstep_timeout_s: 600 admission_timeout_s: 600 broadcast_period_ticks: 20/' "$file" \
    >"$ERGOCAST_SCENARIOS/patient.textproto"
  sed 's/pace: .*/& admission_timeout_s: 20/' "$file" >"$ERGOCAST_SCENARIOS/impatient.textproto"
  chown -R $person "$ERGOCAST_SCENARIOS"
}

# make_keys NAME  as the compose files want them
make_keys() {
  expect "$build/bin/ergocast" keygen "$1"
  chown 1000 "$1.key" "$1.coordinator.key"
}

complain() {
  docker ps --all >&2
  compose logs --no-color --tail 20 2>/dev/null | cut -c 1-300 >&2
  tail -n 5 "$work/compose.log" >&2
  fail "$*"
}
expect() { "$@" >"$work/output" 2>&1 || { cat "$work/output" >&2; complain "not so: $*"; }; }
# A wait for containers ends when none runs any more, or when one has failed by itself. Code 4 is
# different: the mission has failed, and the others end, too.
becomes() {
  nothing_comes_of_containers() { all_ended || [ -n "$(failed_containers)" ]; }
  eventually "$@" || complain "never: $*"
  nothing_comes_of_containers() { false; }
}
failed_containers() {
  docker ps --all --filter status=exited --format '{{.Names}} {{.Status}}' | grep -vE ' Exited \((0|4|137)\)' || true
}

compose() {
  # shellcheck disable=SC2086  # two words, or none
  (cd "$source/docker" && docker-compose -f compose.yaml $over "$@" 2>>"$work/compose.log")
}
containers() { docker ps --all --quiet --filter label=com.docker.compose.service="$1"; }
says() {
  local container
  for container in $(containers "$1"); do
    docker logs "$container" 2>&1 | grep -E "$2" >/dev/null && return
  done
  return 1
}

# plan RECORD AGENTS [OPTION…]  a mission whose record will be below runs/RECORD
plan() { ERGOCAST_RUNS=$work/runs/$1 ERGOCAST_AGENTS=$2 ERGOCAST_OPTIONS=${*:3}; }
start_team() {
  plan "$@"
  expect compose up --detach
}
stop_team() {
  expect compose down
  [ -z "$(docker ps -aq)" ] || fail "docker-compose down leaves $(docker ps -a)"
  rm -f "$ERGOCAST_RUNS"/*/events-*.lcm  # the test's disk is in memory
}

one() { containers "$1" | head -n 1; }
state() { docker inspect --format "{{$2}}" "$1"; }
is() { [ "$(state "$1" "$2")" = "$3" ]; }
all_ended() { [ -z "$(docker ps -q)" ]; }
all_healthy() {
  local container
  for container in $(docker ps -q); do is "$container" .State.Health.Status healthy || return 1; done
}

# The test's process namespace contains those of the containers.
pids_of_programs() { grep -ls '^ergocast-' /proc/[0-9]*/comm | cut -d/ -f3; }

bytes_recorded() { cat "$ERGOCAST_RUNS"/*/trajectory*.csv | wc -c; }
recorded() { [ "$(bytes_recorded)" -gt "$1" ]; }
expect_end() {
  becomes all_ended
  local container
  for container in $(docker ps -aq); do expect is "$container" .State.ExitCode 0; done
  expect grep -q "\"result\": \"$1\"" "$ERGOCAST_RUNS"/*/summary.json
}
expect_complete() { expect_end 'done'; }
# A mission without end: it continues, and all processes exit normally when the coordinator gets a
# signal.
expect_end_when_told() {
  becomes recorded $(($(bytes_recorded) + 30000))
  expect compose stop coordinator
  expect_end stopped
}
