#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# The package of the programs goes through a repository of packaging/apt-index, a web server and apt, and
# its programs run the first team of docs/installing.md. The small form of release_test.sh: it needs
# neither root nor an empty Debian, and installs nothing.
#   repository_test.sh BUILD_DIR
set -euo pipefail
build=$(cd "$1" && pwd)
source=$(cd "$(dirname "$0")/../.." && pwd)
fail() { echo "FAILED: $*" >&2; exit 1; }
for tool in apt-get dpkg-scanpackages dpkg-shlibdeps file python3; do
  command -v "$tool" >/dev/null || { echo "skipped: $tool is missing: packaging/packages-test.txt"; exit 77; }
done
work=$(mktemp -d)
server=
trap '[ -z "$server" ] || kill "$server"; rm -rf "$work"' EXIT

suite=$(. /etc/os-release && echo "${VERSION_CODENAME:-stable}")
repository=$work/release/apt/$suite
mkdir -p "$repository" "$work"/{etc/apt/sources.list.d,etc/apt/apt.conf.d,etc/apt/preferences.d,lists/partial,archives/partial}
(cd "$repository" && cpack --config "$build/CPackConfig.cmake" -G DEB -B "$repository" \
  -D CPACK_COMPONENTS_ALL=programs -D CPACK_DEBIAN_COMPRESSION_TYPE=gzip >"$work/cpack.log" 2>&1) || { cat "$work/cpack.log"; fail cpack; }
rm -rf "$repository/_CPack_Packages"
"$source/packaging/apt-index" "$repository"

python3 -u -m http.server --bind 127.0.0.1 --directory "$work/release/apt" 0 >"$work/server" 2>&1 &
server=$!
until port=$(sed -n 's/.* port \([0-9]*\) .*/\1/p' "$work/server") && [ -n "$port" ]; do
  kill -0 "$server" || fail "no server: $(cat "$work/server")"
  sleep 0.1
done

# The commands of a section of the page.
commands_of() {
  awk -v section="## $1" '/^## / { on = $0 == section } /^```/ { code = on && /^```sh/; next } code' \
    "$source/docs/installing.md"
}
# With folders of the test's own for apt's settings and lists.
: >"$work/status"
cat >"$work/apt.conf" <<END
Dir::Etc "$work/etc/apt"; Dir::State "$work"; Dir::State::lists "$work/lists"; Dir::State::status "$work/status";
Dir::Cache "$work"; Dir::Cache::archives "$work/archives"; APT::Sandbox::User "root"; Acquire::Languages "none";
END
commands_of Packages >"$work/page"
grep -q '^apt-get install -y ergocast$' "$work/page" || fail 'the page has other commands'
sed "s/SERVER:8000/127.0.0.1:$port/; s| >/etc/| >$work/etc/|; /--version/d
  s/^apt-get install -y/apt-get download/; s|^apt-get|apt-get -c $work/apt.conf|" "$work/page" >"$work/commands"
(cd "$work" && sh -e commands) >"$work/said" 2>&1 || { cat "$work/said"; fail 'the commands of the page'; }
dpkg-deb -x "$work"/ergocast_*.deb "$work/root" || fail 'no package was fetched'

commands_of 'The first team' >"$work/team"
grep -q '^ergocast run ' "$work/team" || fail 'the page runs no team'
mkdir "$work/record"
mkdir -m 700 "$work/live" # of the test alone: the user's other runs are not counted
export XDG_RUNTIME_DIR=$work/live
export LCM_DEFAULT_URL='udpm://239.255.76.67:24630?ttl=0'
(cd "$work/record" && PATH=$work/root/usr/bin:$PATH sh -e "$work/team") >"$work/said" 2>&1 ||
  { cat "$work/said"; fail 'the first team'; }
grep -q '^done: mission complete' "$work/said" || { cat "$work/said"; fail 'the first team has not ended'; }
echo 'a package from the repository runs the first team'
