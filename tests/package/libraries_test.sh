#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# libergocast-dev, python3-ergocast and ergocast-ros2 on a bare Debian 12: each header compiles alone, the example
# runs in a team of the packaged processes, Python reads the record, and nothing is left.
# shellcheck source=tests/package/debian.sh
. "$(dirname "$0")/debian.sh"

source=$(cd "$(dirname "$0")/../.." && pwd)

check_headers() {
  (cd "$root/usr/include" && find ergocast -name '*.h' | sort) >"$work/headers"
  grep -q ergocast/core/law/control.h "$work/headers" || fail 'no headers'
  cat >"$work/alone" <<'END'
echo "#include <$1>" | g++ -std=c++20 -Wall -Wextra -Werror -fsyntax-only -isystem /usr/include/eigen3 -x c++ -
END
  in_root xargs -P2 -n1 sh /tmp/test/alone <"$work/headers" || fail 'a header does not compile alone'
}

check_versions() {
  mkdir "$work/other"
  printf 'cmake_minimum_required(VERSION 3.25)\nproject(x LANGUAGES CXX)\nfind_package(Ergocast 9.9 REQUIRED)\n' \
    >"$work/other/CMakeLists.txt"
  ! in_root cmake -S /tmp/test/other -B /tmp/test/other/build >"$work/said" 2>&1 || fail 'any version will do'
  grep -q 'version: 0' "$work/said" || { cat "$work/said"; fail 'the version is not named'; }
}

# Runs in a team of the packaged processes; its trajectory equals that of the simulation.
check_example() {
  cp -r "$source/examples/embed" "$work/embed"
  in_root cmake -S /tmp/test/embed -B /tmp/test/embed/build >"$work/said" 2>&1 &&
    in_root cmake --build /tmp/test/embed/build >>"$work/said" 2>&1 || { cat "$work/said"; fail 'the example'; }
  cat >"$work/team" <<'END'
cd /tmp/test
ergocast-sim & ergocast-logger --out flown & ergocast-agent & ergocast-agent & ergocast-agent &
embed/build/embed >embedded &
ergocast-coordinator --duration 20 quadrimodal_corners || { kill $(jobs -p); exit 1; }
wait
END
  mkdir "$work/flown"
  offline bash /tmp/test/team >"$work/said" 2>&1 || { cat "$work/said"; fail 'the team'; }
  grep -q 'mission complete' "$work/embedded" || { cat "$work/said" "$work/embedded"; fail 'embedded'; }
  offline ergocast simulate quadrimodal_corners --duration 20 --out /tmp/test/simulated >/dev/null || fail simulate
  cmp "$work/simulated/trajectory.csv" "$work/flown/trajectory.csv" || fail 'the embedded agent runs another law'
}

# The driver of vehicles with MAVLink needs the installed libraries alone.
check_bridge() {
  apt_install libcli11-dev
  mkdir -p "$work/tree/bridges"
  cp -r "$source/bridges/mavlink" "$work/tree/bridges/"
  in_root cmake -S /tmp/test/tree/bridges/mavlink -B /tmp/test/bridge >"$work/said" 2>&1 &&
    in_root cmake --build /tmp/test/bridge >>"$work/said" 2>&1 || { cat "$work/said"; fail 'the bridge'; }
  in_root /tmp/test/bridge/ergocast-driver-mavlink --version || fail 'the bridge does not run'
}

check_python() {
  cat >"$work/program.py" <<'END'
import ergocast

run = ergocast.load("/tmp/test/flown")
same = ergocast.simulate("quadrimodal_corners", set={"time.duration_s": 20})
assert run.trajectory.equals(same.trajectory)
assert run.ergodic_metric() == run.summary["ergodic_metric"]["last"] == same.ergodic_metric()
print("python", ergocast.__version__)
END
  in_root python3 -I /tmp/test/program.py || fail 'python3-ergocast'
  in_root ergocast bench --only one_peak --agents 1 --seeds 1:1 --published --out /tmp/test/bench >"$work/said" 2>&1 &&
    grep -q '^one_peak,1,D2OC,1,' "$root/tmp/test/bench/rows.csv" || { cat "$work/said"; fail 'ergocast bench'; }
  expect_file usr/share/doc/python3-ergocast/examples/run_and_sweep.ipynb
}

# What is recommended was not installed, and is installed then.
check_figures() {
  local status=0
  case $(dpkg-deb -f "$root/tmp/python3-ergocast.deb" Recommends) in
    *python3-matplotlib*) ;;
    *) fail 'python3-ergocast does not recommend python3-matplotlib' ;;
  esac
  in_root ergocast report --figures /tmp/test/simulated >/dev/null 2>"$work/said" || status=$?
  [ "$status" -eq 3 ] && grep -qx 'no figures: .* apt-get install python3-matplotlib' "$work/said" ||
    fail "figures without matplotlib, code $status: $(cat "$work/said")"
  apt_install python3-matplotlib
  in_root ergocast report --figures /tmp/test/simulated >/dev/null || fail 'report --figures'
  [ -s "$work/simulated/figures/map.svg" ] || fail 'there is no map'
}

# The bridge to ROS 2 runs with the libraries that its package names. A map that nobody publishes is an error.
check_ros2() {
  apt_install /tmp/ergocast-ros2.deb
  in_root ergocast-ros2 --version || fail 'ergocast-ros2 does not run'
  local status=0
  offline ergocast-ros2 map --wait 1 --save /tmp/test/map.yaml 2>"$work/said" || status=$?
  [ "$status" -eq 3 ] && grep -q 'no map came: nobody publishes map' "$work/said" ||
    fail "a map of nobody, code $status: $(cat "$work/said")"
  expect_file usr/share/man/man1/ergocast-ros2.1.gz
}

make_bare_system
pack
for name in ergocast ergocast-ros2 libergocast-dev python3-ergocast; do
  cp "$work"/${name}_*.deb "$root/tmp/$name.deb"
done
apt_install g++ cmake make /tmp/ergocast.deb /tmp/libergocast-dev.deb /tmp/python3-ergocast.deb
check_headers
check_versions
check_example
check_bridge
check_python
check_figures
check_ros2
in_root dpkg --purge ergocast ergocast-ros2 libergocast-dev python3-ergocast >/dev/null
left=$(files_of_system | grep -i ergocast || true)
[ -z "$left" ] || fail "purged, and there still is: $left"
echo 'an agent is embedded, and Python reads its run'
