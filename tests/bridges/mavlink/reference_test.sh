#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Our codec reads what node-mavlink writes, and the other way round: reference_test.sh PROGRAM FOLDER.
# FOLDER keeps node-mavlink, from npm's registry, between tests. Nothing of it is shipped.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
"$here/reference/fetch" "$2"
node "$here/reference/codec.cjs" "$2" "$1"
