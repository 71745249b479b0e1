#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# node-cot reads our events as we mean them: reference_test.sh COT_LINES FOLDER. FOLDER keeps node-cot (MIT,
# for tests only), from npm's registry, between tests. Later versions need a newer Node than Debian has.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)/reference
folder=$2
mkdir -p "$folder"
# The lock file has the SHA-512 of each package, so no other file is accepted.
if ! cmp -s "$here/package-lock.json" "$folder/fetched"; then
  cp "$here"/package*.json "$folder"
  npm ci --ignore-scripts --no-audit --no-fund --prefix "$folder" >&2
  cp "$here/package-lock.json" "$folder/fetched"
fi
"$1" | node "$here/read_events.mjs" "$folder"
