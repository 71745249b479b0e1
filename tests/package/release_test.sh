#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Follows docs/installing.md on an empty Debian that has no compiler: its commands install the packages
# of packaging/release from a web server, and run a team.
#   release_test.sh BUILD_DIR
#   suite=bookworm|trixie   which Debian
#   ERGOCAST_RELEASE        the folder of a release; without: packaging/release makes one
# shellcheck disable=SC2034
more_tools='dpkg-scanpackages python3 git'
source=$(cd "$(dirname "$0")/../.." && pwd)

make_release() {
  [ -z "${ERGOCAST_RELEASE:-}" ] || return 0
  ERGOCAST_RELEASE=$cache/release
  local debian=12
  [ "$suite" = bookworm ] || debian=13
  ERGOCAST_DEBIAN_CACHE=$cache "$source/packaging/release" --debian "$debian" --out "$ERGOCAST_RELEASE"
}
before_all() { make_release; export ERGOCAST_RELEASE; }

# shellcheck source=tests/package/debian.sh
. "$(dirname "$0")/debian.sh"

# The commands of a section of the page.
commands_of() {
  awk -v section="## $1" '/^## / { on = $0 == section } /^```/ { code = on && /^```sh/; next } code' \
    "$source/docs/installing.md"
}

serve() {
  python3 -u -m http.server --bind 127.0.0.1 --directory "$ERGOCAST_RELEASE/apt" 0 >"$work/server" 2>&1 &
  server=$!
  until port=$(sed -n 's/.* port \([0-9]*\) .*/\1/p' "$work/server") && [ -n "$port" ]; do
    kill -0 "$server" || fail "no server: $(cat "$work/server")"
    sleep 0.1
  done
}

make_bare_system
serve
commands_of Packages | sed "s/SERVER:8000/127.0.0.1:$port/" >"$work/install"
grep -q 'apt-get install -y ergocast' "$work/install" || fail 'the page has other commands'
in_root sh -e /tmp/test/install >"$work/said" 2>&1 || { tail -n 20 "$work/said"; fail 'the commands of the page'; }
keep_archives "$suite" "$root" "$cache"
kill "$server"
for compiler in cc c++ g++ clang; do
  ! in_root sh -c "command -v $compiler" >/dev/null || fail "$compiler was installed"
done
grep -q '^ergocast [0-9.]* (LCM ' "$work/said" && grep -q '^commit [0-9a-f]\{12\}$' "$work/said" ||
  fail "ergocast --version: $(tail -n 4 "$work/said")"

commands_of 'The first team' >"$work/fly"
offline sh -e /tmp/test/fly >"$work/said" 2>&1 || { cat "$work/said"; fail 'the first team'; }
grep -q '^done: mission complete' "$work/said" || { cat "$work/said"; fail 'the first team has not ended'; }

in_root apt-get -qq remove -y ergocast >"$work/said" 2>&1 || { cat "$work/said"; fail remove; }
expect_file etc/ergocast/ergocast.env
in_root apt-get -qq purge -y ergocast >"$work/said" 2>&1 || { cat "$work/said"; fail purge; }
[ ! -e "$root/etc/ergocast" ] || fail 'purged, and there still are settings'
echo "docs/installing.md leads to a team on $suite"
