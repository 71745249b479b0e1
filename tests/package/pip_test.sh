#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# `pip install ./python` in a virtual environment, as docs/installing.md has it; what it installs
# simulates a mission and equals the program's trajectory.
#   pip_test.sh BIN_DIR      python=PROGRAM: another Python than Debian's
set -euo pipefail
bin=$(cd "$1" && pwd)
source=$(cd "$(dirname "$0")/../.." && pwd)
python=${python:-/usr/bin/python3}
fail() { echo "FAILED: $*" >&2; exit 1; }
"$python" -c 'import ensurepip, numpy, pandas' 2>/dev/null && [ -d /usr/include/pybind11 ] ||
  { echo 'skipped: needs python3-venv, python3-numpy, python3-pandas, pybind11-dev'; exit 77; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# numpy and pandas are Debian's, so nothing comes from the network.
pip_install() {
  (cd "$source" && "$work/env/bin/pip" install --no-index "$@" ./python) >"$work/said" 2>&1 ||
    { tail -n 30 "$work/said"; fail 'pip install'; }
}
"$python" -m venv --system-site-packages "$work/env"
pip_install
# In a checkout that was moved; nothing is compiled again.
sed -i 's|^CMAKE_HOME_DIRECTORY:INTERNAL=.*|CMAKE_HOME_DIRECTORY:INTERNAL=/elsewhere|' \
  "$source/build/wheel-$("$python" -c 'import sys; print("cp{0}{1}".format(*sys.version_info))')"-*/CMakeCache.txt
pip_install --force-reinstall --no-deps
cd "$work"
env/bin/python -c '
import ergocast, sys
assert ergocast.__file__.startswith(sys.prefix), ergocast.__file__
run = ergocast.simulate("quadrimodal_corners", set={"time.duration_s": 20})
print(ergocast.__version__, len(run.trajectory), repr(float(run.trajectory.x_m.sum())))' >python
"$bin/ergocast" simulate quadrimodal_corners --duration 20 --out run >/dev/null
env/bin/python -c '
import ergocast
run = ergocast.load("run")
print(ergocast.__version__, len(run.trajectory), repr(float(run.trajectory.x_m.sum())))' >program
cmp python program || fail "$(cat python) from Python, $(cat program) from the program"
# The program `ergocast bench` calls this module of Debian's Python.
env/bin/python -c 'import sys; from ergocast.bench.command import main; sys.exit(main(sys.argv[1:]))' \
  --program "$bin/ergocast" --targets one_peak --agents 1 --seeds 1:1 --jobs 1 \
  --published --out bench >said 2>&1 &&
  grep -q '^one_peak,1,D2OC,1,' bench/rows.csv || { cat said; fail 'ergocast bench'; }
env/bin/pip uninstall -y ergocast >/dev/null 2>&1 || fail 'pip uninstall'
! env/bin/python -c 'import ergocast' 2>/dev/null || fail 'uninstalled, and it is still there'
echo "pip installs a package that simulates: $("$python" --version), $(cat python)"
