# SPDX-License-Identifier: BSD-3-Clause
"""A host of the test's own: its teams and those of other tests do not receive each other."""

import os
import subprocess
import sys
import tempfile

# Its processes end with the first one.
HOST = ["unshare", "--net", "--pid", "--fork", "--kill-child", "--mount-proc"]
NETWORK = 'ip link set lo up; ip route add 224.0.0.0/4 dev lo; exec "$@"'


def enter():
    """Call it first. Runs the program again on a host of its own, and ends with its exit code."""
    if os.environ.get("ERGOCAST_OWN_HOST"):
        return
    user = [] if os.geteuid() == 0 else ["--map-root-user"]
    with tempfile.TemporaryDirectory() as registry:
        os.chmod(registry, 0o700)
        environment = {**os.environ, "ERGOCAST_OWN_HOST": "1", "XDG_RUNTIME_DIR": registry}
        environment.pop("LCM_DEFAULT_URL", None)
        command = [*HOST, *user, "sh", "-c", NETWORK, "_", sys.executable, *sys.argv]
        sys.exit(subprocess.run(command, env=environment).returncode)
