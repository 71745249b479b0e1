#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# The package installs on a bare Debian 12, runs a mission there, keeps settings in an upgrade and
# records and keys when it is removed, and leaves nothing when it is purged.
# shellcheck source=tests/package/debian.sh
. "$(dirname "$0")/debian.sh"

check_contents() {
  local strange
  strange=$(dpkg-deb --fsys-tarfile "$deb" | tar -t | grep -vE '^\./((usr|etc/ergocast)(/.*)?|etc/)?$' || true)
  [ -z "$strange" ] || fail "the package has files outside /usr and /etc/ergocast: $strange"
  strange=$(dpkg-deb --fsys-tarfile "$deb" | tar -tv | awk '$1 !~ /^l/ && ($1 ~ /^.....w|^........w/ || $2 != "root/root")')
  [ -z "$strange" ] || fail "others may write: $strange"
  [ "$(dpkg-deb --ctrl-tarfile "$deb" | tar -xO ./conffiles)" = /etc/ergocast/ergocast.env ] ||
    fail 'the settings are no conffile'
  for field in Package Version Architecture Maintainer Description Section Depends; do
    [ -n "$(dpkg-deb -f "$deb" $field)" ] || fail "the package has no $field"
  done
  case $(dpkg-deb -f "$deb" Depends) in
    *libcpp-httplib*) ;;
    *) fail 'the library of the page is not among Depends' ;;
  esac
  case $(basename "$deb") in
    "ergocast_$(dpkg-deb -f "$deb" Version)_$(dpkg --print-architecture).deb") ;;
    *) fail "the package is called $(basename "$deb")" ;;
  esac
}

check_files() {
  local program name
  for program in ergocast ergocast-agent ergocast-coordinator ergocast-driver-mavlink ergocast-logger ergocast-relay \
    ergocast-sim; do
    expect_file "usr/bin/$program"
    expect_file "usr/share/man/man1/$program.1.gz"
  done
  # The manual describes every command.
  for name in $(in_root ergocast --help | sed -n '/^Subcommands:/,/^$/s/^  \([a-z]*\) .*/\1/p'); do
    gzip -dc "$root/usr/share/man/man1/ergocast.1.gz" | grep -q "^.SS $name$" ||
      fail "ergocast(1) does not speak of $name"
  done
  expect_file usr/share/bash-completion/completions/ergocast
  expect_file usr/share/doc/ergocast/examples/slurm/study.sbatch
  expect_file usr/share/doc/ergocast/README.md
  expect_file usr/share/doc/ergocast/copyright
  expect_file etc/ergocast/ergocast.env
  for name in agent@ coordinator logger sim; do
    expect_file "usr/lib/systemd/system/ergocast-$name.service"
  done
}

check_missions() {
  offline ergocast simulate quadrimodal_corners --duration 20 --out /tmp/test/simulated ||
    fail 'ergocast simulate'
  offline ergocast run --duration 20 --out /tmp/test/run quadrimodal_corners || fail 'ergocast run'
  cmp "$work/simulated/trajectory.csv" "$work/run/trajectory.csv" || fail 'run and simulate differ'
  # With the map in the same folder.
  offline ergocast check lake_search || fail 'ergocast check lake_search'
  ! offline ergocast check no_such_scenario 2>"$work/said" || fail 'a scenario that is not there'
  grep -q harbour_patrol "$work/said" || fail 'the shipped scenarios are not named'
}

# Figures are Python's, which this package does not need.
check_figures() {
  local status=0
  in_root ergocast report --figures /tmp/test/simulated >/dev/null 2>"$work/said" || status=$?
  [ "$status" -eq 3 ] && grep -q '^no figures: .* apt-get install python3-' "$work/said" ||
    fail "figures without Python, code $status: $(cat "$work/said")"
}

# The page is served from the programs alone.
check_page() {
  "${offline[@]}" ergocast watch --port 8765 /tmp/test/simulated >"$work/watch" 2>&1 &
  local watch=$!
  until grep -q Ctrl-C "$work/watch"; do
    kill -0 "$watch" || fail "ergocast watch: $(cat "$work/watch")"
    sleep 0.1
  done
  # shellcheck disable=SC2016  # for the shell inside
  nsenter --target "$watch" --net bash -c '
    exec 3<>/dev/tcp/127.0.0.1/8765
    printf "GET / HTTP/1.1\r\nHost: 127.0.0.1:8765\r\nConnection: close\r\n\r\n" >&3
    cat <&3' >"$work/page" || fail 'nothing answers'
  grep -q quadrimodal_corners "$work/page" || fail "the page is not served: $(head -c 300 "$work/page")"
  kill -INT "$watch"
  wait "$watch" || fail 'ergocast watch does not end in order'
}

check_upgrade() {
  make_old_package "$deb" "$root/tmp/old.deb"
  apt_install /tmp/old.deb
  expect_version 0.2.0
  use_package
  apt_install -o Dpkg::Options::=--force-confold "/tmp/$(basename "$deb")"
  expect_version "$(dpkg-deb -f "$deb" Version)"
  expect_kept 'upgraded'
}

make_bare_system
pack
check_contents
cp "$deb" "$root/tmp/"
# The libraries that the package depends on stay, so that every remaining file is the package's.
check_upgrade
check_files
check_missions
check_figures
check_page
in_root ergocast --version

in_root dpkg --remove ergocast >/dev/null
expect_kept 'removed'
in_root dpkg --purge ergocast >/dev/null
left=$(files_of_system | grep -i ergocast || true)
[ -z "$left" ] || fail "purged, and there still is: $left"
echo 'the package installs, runs and goes'
