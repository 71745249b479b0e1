#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Follows docs/installing.md on an empty Debian that has no compiler: its commands install the packages
# of packaging/release from a web server, and run a team.
#   release_test.sh BUILD_DIR
#   suite=bookworm|trixie   which Debian
#   arch=arm64              under emulation; then one of its agents runs in a team with those of BUILD_DIR
#   ERGOCAST_RELEASE        the folder of a release; without: packaging/release makes one
# shellcheck disable=SC2034
more_tools='dpkg-scanpackages python3 git'
source=$(cd "$(dirname "$0")/../.." && pwd)

make_release() {
  [ -z "${ERGOCAST_RELEASE:-}" ] || return 0
  ERGOCAST_RELEASE=$cache/release
  local debian=12
  [ "$suite" = bookworm ] || debian=13
  ERGOCAST_DEBIAN_CACHE=$cache "$source/packaging/release" --debian "$debian" --arch "$arch" --out "$ERGOCAST_RELEASE"
}
before_all() { make_release; export ERGOCAST_RELEASE; }

# shellcheck source=tests/package/debian.sh
. "$(dirname "$0")/debian.sh"

# The commands of a section of the page.
commands_of() {
  awk -v section="## $1" '/^## / { on = $0 == section } /^```/ { code = on && /^```sh/; next } code' \
    "$source/docs/installing.md"
}

# What the web server has: first an older version with another default in its settings, then the release.
serve() {
  mkdir -p "$work/web"
  python3 -u -m http.server --bind 127.0.0.1 --directory "$work/web" 0 >"$work/server" 2>&1 &
  server=$!
  until port=$(sed -n 's/.* port \([0-9]*\) .*/\1/p' "$work/server") && [ -n "$port" ]; do
    kill -0 "$server" || fail "no server: $(cat "$work/server")"
    sleep 0.1
  done
}
publish_old() {
  mkdir "$work/web/$suite"
  make_old_package "$ERGOCAST_RELEASE/apt/$suite"/ergocast_*_"$arch".deb "$work/web/$suite/ergocast_0.2.0_all.deb"
  # Older than the release, because apt ignores lists that are older than those it has.
  SOURCE_DATE_EPOCH=1700000000 "$source/packaging/apt-index" "$work/web/$suite"
}
publish_release() {
  rm -r "${work:?}/web/$suite"
  cp -r "$ERGOCAST_RELEASE/apt/$suite" "$work/web/"
}

# Runs the commands of a section.
follow() {
  commands_of "$1" | sed "s/SERVER:8000/127.0.0.1:$port/" >"$work/commands"
  grep -q ergocast "$work/commands" || fail "the page has no commands: $1"
  in_root sh -e /tmp/test/commands >"$work/said" 2>&1 || { tail -n 20 "$work/said"; fail "the page's $1"; }
  keep_archives "$system" "$root" "$cache"
}

make_bare_system
serve
publish_old
follow Packages
expect_version 0.2.0
use_package
publish_release
follow 'Upgrade and removal'
expect_version "$(dpkg-deb -f "$ERGOCAST_RELEASE/apt/$suite"/ergocast_*_"$arch".deb Version)"
expect_kept upgraded
for compiler in cc c++ g++ clang; do
  ! in_root sh -c "command -v $compiler" >/dev/null || fail "$compiler was installed"
done
in_root ergocast --version >"$work/said"
[ "$(grep -cE '^(ergocast [0-9.]+ \(LCM |commit [0-9a-f]{12})' "$work/said")" = 2 ] ||
  fail "ergocast --version: $(cat "$work/said")"

commands_of 'The first team' >"$work/team"
offline sh -e /tmp/test/team >"$work/said" 2>&1 || { cat "$work/said"; fail 'the first team'; }
grep -q '^done: mission complete' "$work/said" || { cat "$work/said"; fail 'the first team has not ended'; }

if [ "$arch" = arm64 ]; then
  bin=$build/bin root=$root work=$work unshare --net --mount --propagation private \
    "$source/tests/package/mixed_team" || fail 'a team of both processors'
fi

kill "$server"
in_root apt-get -qq remove -y ergocast >"$work/said" 2>&1 || { cat "$work/said"; fail remove; }
expect_kept removed
in_root apt-get -qq purge -y ergocast >"$work/said" 2>&1 || { cat "$work/said"; fail purge; }
for file in etc/ergocast var/lib/ergocast; do
  [ ! -e "$root/$file" ] || fail "purged, and there still is $file: $(ls "$root/$file")"
done
echo "docs/installing.md leads to a team on $suite for $arch"
